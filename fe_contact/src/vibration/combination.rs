//! The step of a set while certain contact maps hold: an affine problem that is solved once and kept.
//!
//! With x the displacements of the races at the end of the step, b the approaches of the pairs with the races at their
//! origin and without pair forces, and L the load on the races,
//!
//! ```text
//! δ = R x + b − E P,   P = S δ + P₀,   A x = L − Rᵀ P
//! ```
//!
//! where E is the compliance between pairs within the step beyond that of the cells. Hence
//!
//! ```text
//! P = S' (R x + b) + P₀',   S' = (I + S E)⁻¹ S,   P₀' = (I + S E)⁻¹ P₀
//! (A + Rᵀ S' R) x = L − Rᵀ (S' b + P₀')
//! ```
//!
//! E couples the pairs of a mesh or, on bodies with elastic states, all pairs. The matrix of the races is of the order
//! of their coordinates; its symmetric part is positive definite.

use dynamics::{Computation, Simd, wide};

use super::frame::Frame;
use super::packed::Packed;

/// The solved step for one combination of contact maps of all meshes.
#[derive(Debug, Clone)]
pub(super) struct Combination {
    /// Ids of the maps, one per mesh.
    pub(super) maps: Vec<u64>,
    /// Pairs that touch: those with a force that changes with the approaches, in the order of the groups that E
    /// couples. Then how many of them each group has.
    pub(super) places: Vec<usize>,
    /// How many pairs touch.
    pub(super) count: usize,
    /// S' of each group by rows, N/m. Then P₀' of the touching pairs, N.
    pub(super) numbers: Vec<f64>,
    /// (A + Rᵀ S' R)⁻¹, m/N.
    pub(super) inverse: Packed,
    /// Changes of single meshes by which the inverse was made from one that was eliminated.
    pub(super) changes: usize,
}

/// Vectors of a step: what it starts from, and what it ends with.
pub(super) struct StepVectors<'v> {
    /// Load L on the races, n, N.
    pub(super) load: &'v [f64],
    /// b, m.
    pub(super) b: &'v [f64],
    /// Load on the races less S' b + P₀', n, N.
    pub(super) left: &'v mut [f64],
    /// x, n, m.
    pub(super) x: &'v mut [f64],
    /// δ, m.
    pub(super) approaches: &'v mut [f64],
    /// P, N.
    pub(super) forces: &'v mut [f64],
}

impl Combination {
    /// Solves a step.
    pub(super) fn solve(&self, frame: &Frame, vectors: StepVectors<'_>) {
        wide(Solving { combination: self, frame, vectors });
    }

    /// Pairs that touch, in the order of the groups that E couples.
    #[inline]
    pub(super) fn touching(&self) -> &[usize] {
        &self.places[..self.count]
    }

    /// How many of them each group has.
    #[inline]
    pub(super) fn groups(&self) -> &[usize] {
        &self.places[self.count..]
    }

    /// S' of each group by rows, N/m.
    #[inline]
    pub(super) fn stiffness(&self) -> &[f64] {
        &self.numbers[..self.numbers.len() - self.count]
    }

    /// Touching pairs, and S' and P₀' of each group.
    #[inline(always)]
    pub(super) fn of_groups(&self) -> impl Iterator<Item = (&[usize], &[f64], &[f64])> {
        let (stiffness, preload) = self.numbers.split_at(self.numbers.len() - self.count);
        let mut rest = (self.touching(), stiffness, preload);
        self.groups().iter().map(move |count| {
            let (touching, stiffness, preload);
            (touching, rest.0) = rest.0.split_at(*count);
            (stiffness, rest.1) = rest.1.split_at(count * count);
            (preload, rest.2) = rest.2.split_at(*count);
            (touching, stiffness, preload)
        })
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        self.inverse.bytes() + 8 * (self.maps.len() + self.places.len() + self.numbers.len())
    }
}

struct Solving<'c, 'v> {
    combination: &'c Combination,
    frame: &'c Frame,
    vectors: StepVectors<'v>,
}

impl Computation for Solving<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let Self { combination, frame, vectors } = self;
        let StepVectors { load, b, left, x, approaches, forces } = vectors;
        let rows = frame.rows();
        // P = P₀' + S' b on races at their origin
        let press = |forces: &mut [f64], approaches: &[f64]| {
            for (touching, stiffness, preload) in combination.of_groups() {
                let own = stiffness.chunks_exact(touching.len().max(1));
                for ((pair, row), preload) in touching.iter().zip(own).zip(preload) {
                    let along = row.iter().zip(touching).map(|(s, j)| s * approaches[*j]);
                    forces[*pair] = preload + along.sum::<f64>();
                }
            }
        };
        forces.fill(0.0);
        press(forces, b);
        left.copy_from_slice(load);
        for pair in combination.touching() {
            rows[*pair].add_to(-forces[*pair], left);
        }
        // (A + Rᵀ S' R) x = L − Rᵀ P
        x.fill(0.0);
        combination.inverse.add_product(left, x);
        for ((own, b), row) in approaches.iter_mut().zip(b).zip(rows) {
            *own = b + row.dot(x);
        }
        press(forces, approaches);
        // δ = R x + b − E P
        let (factor, mut columns) = frame.excess();
        for (group, (touching, _, _)) in frame.groups().zip(combination.of_groups()) {
            let own;
            (own, columns) = columns.split_at(group.len() * group.len());
            for pair in touching {
                let column = &own[(pair - group.start) * group.len()..][..group.len()];
                let yielded = factor * forces[*pair];
                let of_group = approaches[group.clone()].iter_mut().zip(column);
                of_group.for_each(|(delta, e)| *delta -= e * yielded);
            }
        }
    }
}
