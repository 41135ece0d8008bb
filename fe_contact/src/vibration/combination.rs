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
//! E couples the pairs of a mesh or, on bodies with elastic states, all pairs. The matrix of the races is of the order of
//! their coordinates; its symmetric part is positive definite.

use dynamics::{Computation, Simd, wide};
use nalgebra::{DMatrixView, DMatrixViewMut};

use super::frame::Frame;
use super::packed::{LANES, Packed};
use crate::contact::ContactMaps;
use crate::error::FeError;

/// The solved step for one combination of contact maps of all meshes.
#[derive(Debug, Clone)]
pub(super) struct Combination {
    /// Ids of the maps, one per mesh.
    pub(super) maps: Vec<u64>,
    /// Pairs that touch: those with a force that changes with the approaches, in the order of the groups that E couples.
    pub(super) touching: Vec<usize>,
    /// How many of them each group has.
    pub(super) groups: Vec<usize>,
    /// S' of each group by rows, N/m.
    pub(super) stiffness: Vec<f64>,
    /// P₀' of the touching pairs, N.
    preload: Vec<f64>,
    /// Columns of E of the touching pairs, each with the rows of the pairs of its group, m/N.
    excess: Vec<f64>,
    /// (A + Rᵀ S' R)⁻¹, m/N.
    pub(super) inverse: Packed,
}

/// Numbers of a combination that is being made, kept so that many of them allocate little memory.
#[derive(Debug, Clone, Default)]
pub(super) struct CombiningWork {
    /// By columns, for the touching pairs of a group: S, then P₀.
    right: Vec<f64>,
    /// I + S E of a group.
    matrix: Vec<f64>,
    /// S' and P₀' of a group.
    solved: Vec<f64>,
    /// Rᵀ S' of one pair.
    pressed: Vec<f64>,
    /// A + Rᵀ S' R.
    races: Packed,
    elimination: Vec<[f64; LANES]>,
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
    /// Solves the step of a frame whose present maps have the ids `ids`; `None` if a mesh has no map. `races`: A, n×n, N/m.
    pub(super) fn new(
        frame: &Frame,
        maps: &[ContactMaps],
        ids: &[u64],
        races: &Packed,
        work: &mut CombiningWork,
    ) -> Result<Option<Self>, FeError> {
        wide(Combining { frame, maps, ids, races, work })
    }

    /// Solves a step.
    pub(super) fn solve(&self, frame: &Frame, vectors: StepVectors<'_>) {
        wide(Solving { combination: self, frame, vectors });
    }

    /// Touching pairs, and S' and P₀' of each group.
    #[inline(always)]
    fn groups(&self) -> impl Iterator<Item = (&[usize], &[f64], &[f64])> {
        let mut rest =
            (self.touching.as_slice(), self.stiffness.as_slice(), self.preload.as_slice());
        self.groups.iter().map(move |count| {
            let (touching, stiffness, preload);
            (touching, rest.0) = rest.0.split_at(*count);
            (stiffness, rest.1) = rest.1.split_at(count * count);
            (preload, rest.2) = rest.2.split_at(*count);
            (touching, stiffness, preload)
        })
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        let lists = [self.maps.len(), self.touching.len(), self.groups.len()];
        let numbers = self.stiffness.len()
            + self.preload.len()
            + self.excess.len()
            + lists.iter().sum::<usize>();
        self.inverse.bytes() + 8 * numbers
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
            for (touching, stiffness, preload) in combination.groups() {
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
        for pair in &combination.touching {
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
        let (mut touching, mut columns) =
            (combination.touching.as_slice(), combination.excess.as_slice());
        for (group, count) in frame.groups().zip(&combination.groups) {
            let (pairs, own);
            (pairs, touching) = touching.split_at(*count);
            (own, columns) = columns.split_at(count * group.len());
            for (pair, column) in pairs.iter().zip(own.chunks_exact(group.len().max(1))) {
                let of_group = approaches[group.clone()].iter_mut().zip(column);
                of_group.for_each(|(delta, e)| *delta -= e * forces[*pair]);
            }
        }
    }
}

struct Combining<'c> {
    frame: &'c Frame,
    maps: &'c [ContactMaps],
    ids: &'c [u64],
    races: &'c Packed,
    work: &'c mut CombiningWork,
}

impl Computation for Combining<'_> {
    type Output = Result<Option<Combination>, FeError>;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> Self::Output {
        let Self { frame, maps, ids, races, work } = self;
        let CombiningWork { right, matrix, solved, pressed, races: summed, elimination } = work;
        let count = frame.offsets.len();
        let singular = || FeError::NoEquilibrium("the step's contact problem is singular".into());
        if frame.meshes.iter().any(|mesh| mesh.map(maps).is_none()) {
            return Ok(None);
        }
        let mut made = Combination {
            maps: ids.to_vec(),
            touching: Vec::with_capacity(count),
            groups: Vec::with_capacity(frame.meshes.len()),
            stiffness: Vec::with_capacity(3 * count),
            preload: Vec::with_capacity(count),
            excess: Vec::with_capacity(4 * count),
            inverse: Packed::default(),
        };
        // A + Rᵀ S' R
        summed.copy(races);
        let rows = frame.rows();
        pressed.resize(summed.column_len(), 0.0);
        let mut meshes = frame.meshes.as_slice();
        for group in frame.groups() {
            let first = made.touching.len();
            let of_group = meshes.iter().take_while(|of| of.first + of.count <= group.end).count();
            let own;
            (own, meshes) = meshes.split_at(of_group);
            for (of, map) in own.iter().filter_map(|of| Some((of, of.map(maps)?))) {
                for (i, row) in map.stiffness.chunks_exact(of.count.max(1)).enumerate() {
                    if row.iter().any(|s| *s != 0.0) {
                        made.touching.push(of.first + i);
                    }
                }
            }
            let touching = &made.touching[first..];
            let size = touching.len();
            made.groups.push(size);
            if size == 0 {
                continue;
            }
            // By columns: S, then P₀; I + S E.
            right.clear();
            right.resize(size * (size + 1), 0.0);
            for (of, map) in own.iter().filter_map(|of| Some((of, of.map(maps)?))) {
                let pairs = of.first..of.first + of.count;
                for (i, pair) in touching.iter().enumerate() {
                    if !pairs.contains(pair) {
                        continue;
                    }
                    right[size * size + i] = map.forces[pair - of.first];
                    let row = &map.stiffness[(pair - of.first) * of.count..][..of.count];
                    for (j, other) in touching.iter().enumerate() {
                        if pairs.contains(other) {
                            right[j * size + i] = row[other - of.first];
                        }
                    }
                }
            }
            matrix.clear();
            matrix.resize(size * size, 0.0);
            for (j, pair) in touching.iter().enumerate() {
                let column = made.excess.len();
                for i in group.clone() {
                    made.excess.push(frame.excess(i, *pair));
                }
                let own = &mut matrix[j * size..(j + 1) * size];
                own[j] = 1.0;
                for (other, s) in touching.iter().zip(right.chunks_exact(size)) {
                    let e = made.excess[column + other - group.start];
                    for (own, s) in own.iter_mut().zip(s) {
                        *own += e * s;
                    }
                }
            }
            let mut matrix = DMatrixViewMut::from_slice(matrix, size, size);
            if !matrix.try_inverse_mut() {
                return Err(singular());
            }
            solved.clear();
            solved.resize(size * (size + 1), 0.0);
            let right = DMatrixView::from_slice(right, size, size + 1);
            DMatrixViewMut::from_slice(solved, size, size + 1).gemm(1.0, &matrix, &right, 0.0);
            made.preload.extend_from_slice(&solved[size * size..]);
            for i in 0..size {
                for j in 0..size {
                    made.stiffness.push(solved[j * size + i]);
                }
            }
            for (on, of) in touching.iter().zip(solved.chunks_exact(size)) {
                pressed.fill(0.0);
                for (of, s) in touching.iter().zip(of) {
                    rows[*of].add_to(*s, pressed);
                }
                summed.add_outer(pressed, &rows[*on]);
            }
        }
        made.inverse = summed.inverse(elimination).ok_or_else(singular)?;
        if !made.stiffness.iter().all(|s| s.is_finite()) {
            return Err(singular());
        }
        Ok(Some(made))
    }
}
