//! How the step for one combination of contact maps is made: from the matrix of the races, or from another combination
//! of the same frame from which it differs in few meshes.
//!
//! With S' of one mesh changed by ΔS', between all pairs that touch before or after, (A + Rᵀ S' R)⁻¹ changes by
//! (Woodbury)
//!
//! ```text
//! −X Z Y,   X = (A + Rᵀ S' R)⁻¹ Rᵀ,   Y = R (A + Rᵀ S' R)⁻¹,   Z = (I + ΔS' R X)⁻¹ ΔS'
//! ```
//!
//! which for the two or three pairs of a mesh is a fraction of an elimination.

use std::ops::Range;

use dynamics::{Computation, Simd, wide};
use nalgebra::DMatrixViewMut;

use super::combination::Combination;
use super::frame::{Frame, FrameMesh};
use super::packed::{LANES, Packed};
use crate::contact::ContactMaps;
use crate::error::FeError;
use crate::short_row::ShortRow;

/// Most meshes in which a combination may differ from the one that it is made from.
const MOST_MESHES: usize = 3;

/// Most changes of single meshes between two eliminations: each leaves its rounding in the inverse.
const MOST_CHANGES: usize = 8;

/// Numbers of combinations that are being made, kept so that many of them allocate little memory.
#[derive(Debug, Clone, Default)]
pub(super) struct CombiningWork {
    pressing: Pressing,
    change: Change,
    /// Rᵀ S' of one pair.
    pressed: Vec<f64>,
    /// A + Rᵀ S' R.
    races: Packed,
    elimination: Vec<[f64; LANES]>,
}

impl Combination {
    /// Solves the step of a frame whose present maps have the ids `ids`; `None` if a mesh has no map. `races`: A, n×n,
    /// N/m.
    ///
    /// # Errors
    /// If the contact problem of the step is singular.
    pub(super) fn new(
        frame: &Frame,
        maps: &[ContactMaps],
        ids: &[u64],
        races: &Packed,
        work: &mut CombiningWork,
    ) -> Result<Option<Self>, FeError> {
        if frame.meshes.iter().any(|mesh| mesh.map(maps).is_none()) {
            return Ok(None);
        }
        wide(Combining { frame, maps, ids, races, work }).map(Some)
    }
}

fn singular() -> FeError {
    FeError::NoEquilibrium("the step's contact problem is singular".into())
}

struct Combining<'c> {
    frame: &'c Frame,
    maps: &'c [ContactMaps],
    ids: &'c [u64],
    races: &'c Packed,
    work: &'c mut CombiningWork,
}

impl Computation for Combining<'_> {
    type Output = Result<Combination, FeError>;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> Self::Output {
        let Self { frame, maps, ids, races, work } = self;
        let changed = match base(frame, ids) {
            Some((base, changes)) => {
                let inverse = work.changed(frame, maps, ids, base)?;
                inverse.map(|inverse| (inverse, base.changes + changes))
            }
            None => None,
        };
        let (inverse, changes) = match changed {
            Some(changed) => changed,
            None => (work.eliminated(frame, maps, races)?, 0),
        };
        let Pressing { touching, groups, stiffness, preload, .. } = &work.pressing;
        if !stiffness.iter().all(|s| s.is_finite()) {
            return Err(singular());
        }
        Ok(Combination {
            maps: ids.to_vec(),
            places: [touching.as_slice(), groups].concat(),
            count: touching.len(),
            numbers: [stiffness.as_slice(), preload].concat(),
            inverse,
            changes,
        })
    }
}

/// The solved combination of the frame that differs from that of the maps `ids` in the fewest meshes, and in how many,
/// if few enough and if no body has an elastic state: the pairs of all meshes would change.
#[inline(always)]
fn base<'f>(frame: &'f Frame, ids: &[u64]) -> Option<(&'f Combination, usize)> {
    let differing = |own: &Combination| own.maps.iter().zip(ids).filter(|(a, b)| a != b).count();
    let all = frame.combinations.iter().map(|own| (own, differing(own)));
    let (own, count) = all.min_by_key(|(own, count)| (*count, own.changes))?;
    let is_near = count <= MOST_MESHES && own.changes + count <= MOST_CHANGES;
    (is_near && own.groups().len() == ids.len()).then_some((own, count))
}

impl CombiningWork {
    /// (A + Rᵀ S' R)⁻¹ by elimination.
    #[inline(always)]
    fn eliminated(
        &mut self,
        frame: &Frame,
        maps: &[ContactMaps],
        races: &Packed,
    ) -> Result<Packed, FeError> {
        let Self { pressing, pressed, races: summed, elimination, .. } = self;
        pressing.clear();
        summed.copy(races);
        pressed.resize(summed.column_len(), 0.0);
        let rows = frame.rows();
        for group in groups(frame) {
            pressing.press(&group, maps)?;
            let (touching, stiffness) = pressing.last();
            for (j, on) in touching.iter().enumerate() {
                pressed.fill(0.0);
                let column = stiffness[j..].iter().step_by(touching.len());
                for (of, s) in touching.iter().zip(column) {
                    rows[*of].add_to(*s, pressed);
                }
                summed.add_outer(pressed, &rows[*on]);
            }
        }
        summed.inverse(elimination).ok_or_else(singular)
    }

    /// The same from another combination with the same meshes; `None` if that leads to numbers that are not finite.
    #[inline(always)]
    fn changed(
        &mut self,
        frame: &Frame,
        maps: &[ContactMaps],
        ids: &[u64],
        base: &Combination,
    ) -> Result<Option<Packed>, FeError> {
        let Self { pressing, change, .. } = self;
        pressing.clear();
        let mut inverse = base.inverse.clone();
        let same = base.maps.iter().zip(ids).map(|(a, b)| a == b);
        for ((group, own), is_same) in groups(frame).zip(base.of_groups()).zip(same) {
            if is_same {
                pressing.take(own);
                continue;
            }
            pressing.press(&group, maps)?;
            let (touching, stiffness, _) = own;
            let is_finite =
                change.apply(frame.rows(), (touching, stiffness), pressing.last(), &mut inverse);
            if !is_finite {
                return Ok(None);
            }
        }
        Ok(Some(inverse))
    }
}

/// Pairs whose approaches depend on each other's forces within a step beside those of the races' motion.
struct Group<'f> {
    pairs: Range<usize>,
    /// The meshes that they belong to.
    meshes: &'f [FrameMesh],
    /// E of the group: a factor on all of it, and its columns.
    factor: f64,
    excess: &'f [f64],
}

#[inline(always)]
fn groups(frame: &Frame) -> impl Iterator<Item = Group<'_>> {
    let mut meshes = frame.meshes.as_slice();
    let (factor, mut columns) = frame.excess();
    frame.groups().map(move |pairs| {
        let count = meshes.iter().take_while(|of| of.first + of.count <= pairs.end).count();
        let (own, excess);
        (own, meshes) = meshes.split_at(count);
        (excess, columns) = columns.split_at(pairs.len() * pairs.len());
        Group { pairs, meshes: own, factor, excess }
    })
}

/// S' and P₀' of one group after another.
#[derive(Debug, Clone, Default)]
struct Pressing {
    touching: Vec<usize>,
    groups: Vec<usize>,
    stiffness: Vec<f64>,
    preload: Vec<f64>,
    /// By columns, for the touching pairs of a group: S, then P₀.
    right: Vec<f64>,
    /// I + S E of a group, then its inverse.
    matrix: Vec<f64>,
    /// S' and P₀' of a group.
    solved: Vec<f64>,
}

impl Pressing {
    #[inline(always)]
    fn clear(&mut self) {
        self.touching.clear();
        self.groups.clear();
        self.stiffness.clear();
        self.preload.clear();
    }

    /// Adds a group that is known.
    #[inline(always)]
    fn take(&mut self, (touching, stiffness, preload): (&[usize], &[f64], &[f64])) {
        self.touching.extend_from_slice(touching);
        self.groups.push(touching.len());
        self.stiffness.extend_from_slice(stiffness);
        self.preload.extend_from_slice(preload);
    }

    /// Touching pairs and S' of the last group.
    #[inline(always)]
    fn last(&self) -> (&[usize], &[f64]) {
        let size = self.groups.last().copied().unwrap_or(0);
        let (touching, stiffness) = (&self.touching, &self.stiffness);
        (&touching[touching.len() - size..], &stiffness[stiffness.len() - size * size..])
    }

    /// Adds a group.
    #[inline(always)]
    fn press(&mut self, group: &Group<'_>, maps: &[ContactMaps]) -> Result<(), FeError> {
        let Self { touching, groups, stiffness, preload, right, matrix, solved } = self;
        let meshes = || group.meshes.iter().filter_map(|of| Some((of, of.map(maps)?)));
        let first = touching.len();
        for (of, map) in meshes() {
            for (i, row) in map.stiffness().chunks_exact(of.count.max(1)).enumerate() {
                if row.iter().any(|s| *s != 0.0) {
                    touching.push(of.first + i);
                }
            }
        }
        let touching = &touching[first..];
        let size = touching.len();
        groups.push(size);
        if size == 0 {
            return Ok(());
        }
        // By columns: S, then P₀.
        right.clear();
        right.resize(size * (size + 1), 0.0);
        let mut at = 0;
        for (of, map) in meshes() {
            let end = of.first + of.count;
            let count = touching[at..].iter().take_while(|pair| **pair < end).count();
            let among = at..at + count;
            let (forces, all) = (map.forces(), map.stiffness());
            for i in among.clone() {
                let pair = touching[i] - of.first;
                right[size * size + i] = forces[pair];
                for j in among.clone() {
                    right[j * size + i] = all[pair * of.count + touching[j] - of.first];
                }
            }
            at += count;
        }
        // I + S E
        matrix.clear();
        matrix.resize(size * size, 0.0);
        for (j, pair) in touching.iter().enumerate() {
            let column = &group.excess[(pair - group.pairs.start) * group.pairs.len()..];
            let own = &mut matrix[j * size..(j + 1) * size];
            own[j] = 1.0;
            for (other, s) in touching.iter().zip(right.chunks_exact(size)) {
                let e = group.factor * column[other - group.pairs.start];
                own.iter_mut().zip(s).for_each(|(own, s)| *own += e * s);
            }
        }
        if !DMatrixViewMut::from_slice(matrix, size, size).try_inverse_mut() {
            return Err(singular());
        }
        solved.clear();
        solved.resize(size * (size + 1), 0.0);
        for (own, right) in solved.chunks_exact_mut(size).zip(right.chunks_exact(size)) {
            for (inverse, r) in matrix.chunks_exact(size).zip(right) {
                own.iter_mut().zip(inverse).for_each(|(own, a)| *own += a * r);
            }
        }
        preload.extend_from_slice(&solved[size * size..]);
        for i in 0..size {
            stiffness.extend(solved[..size * size].iter().skip(i).step_by(size));
        }
        Ok(())
    }
}

/// What changes the inverse where one mesh has another map.
#[derive(Debug, Clone, Default)]
struct Change {
    /// Pairs that touch before or after.
    pairs: Vec<usize>,
    /// ΔS' by columns.
    stiffness: Vec<f64>,
    /// X, pair after pair.
    columns: Vec<f64>,
    /// Y, pair after pair.
    rows: Vec<f64>,
    /// I + ΔS' R X by columns, then its inverse.
    matrix: Vec<f64>,
    /// A row of Z Y.
    along: Vec<f64>,
}

impl Change {
    /// Changes an inverse from touching pairs and S' of one mesh, by rows, to others; whether the result is finite.
    #[inline(always)]
    fn apply(
        &mut self,
        all: &[ShortRow],
        before: (&[usize], &[f64]),
        now: (&[usize], &[f64]),
        inverse: &mut Packed,
    ) -> bool {
        let Self { pairs, stiffness, columns, rows, matrix, along } = self;
        pairs.clear();
        pairs.extend(now.0);
        pairs.extend(before.0.iter().filter(|pair| !now.0.contains(pair)));
        let (m, n, padded) = (pairs.len(), inverse.columns(), inverse.column_len());
        stiffness.clear();
        stiffness.resize(m * m, 0.0);
        for ((touching, own), sign) in [(before, -1.0), (now, 1.0)] {
            let place = |pair: &usize| pairs.iter().position(|other| other == pair).unwrap_or(0);
            for (of, row) in touching.iter().zip(own.chunks_exact(touching.len().max(1))) {
                let i = place(of);
                for (on, s) in touching.iter().zip(row) {
                    stiffness[place(on) * m + i] += sign * s;
                }
            }
        }
        columns.clear();
        columns.resize(m * padded, 0.0);
        rows.clear();
        rows.resize(m * n, 0.0);
        let both = columns.chunks_exact_mut(padded.max(1)).zip(rows.chunks_exact_mut(n.max(1)));
        for (pair, (column, row)) in pairs.iter().zip(both) {
            inverse.add_times_row(&all[*pair], column);
            inverse.add_row_times(&all[*pair], row);
        }
        matrix.clear();
        matrix.resize(m * m, 0.0);
        for j in 0..m {
            let own = &mut matrix[j * m..(j + 1) * m];
            own[j] = 1.0;
            for (pair, s) in pairs.iter().zip(stiffness.chunks_exact(m)) {
                let moved = all[*pair].dot(&columns[j * padded..][..padded]);
                own.iter_mut().zip(s).for_each(|(own, s)| *own += s * moved);
            }
        }
        if !DMatrixViewMut::from_slice(matrix, m, m).try_inverse_mut() {
            return false;
        }
        for (i, column) in columns.chunks_exact(padded.max(1)).enumerate() {
            along.clear();
            along.resize(n, 0.0);
            for (s, row) in stiffness.chunks_exact(m).zip(rows.chunks_exact(n.max(1))) {
                // Z_ij = Σ_k C⁻¹_ik ΔS'_kj
                let z: f64 = s.iter().enumerate().map(|(k, s)| matrix[k * m + i] * s).sum();
                along.iter_mut().zip(row).for_each(|(along, y)| *along -= z * y);
            }
            if !along.iter().all(|x| x.is_finite()) {
                return false;
            }
            inverse.add_product_of(column, along);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use gearset::{Facing, PathDirection};
    use scene::Scene;

    use super::super::prepared::Loading;
    use super::super::rotation::NominalRotation;
    use super::super::set::VibratingSet;
    use super::*;
    use crate::statics::{Bodies, Imperfections};

    /// The step that was made from another combination by changing single meshes is the one that elimination gives: at
    /// few steps per cycle of a low speed, where meshes are far stiffer than the inertia of a step, and at usual ones.
    #[test]
    fn changed_combinations_are_those_of_an_elimination() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        let bodies = Bodies::new(&scene).unwrap();
        for (mesh_frequency, least) in [(20.0, 10), (570.0, 10)] {
            let rotation = NominalRotation::Turning {
                mesh_frequency,
                steps_per_cycle: 28,
                direction: PathDirection::Forward,
            };
            let loading = Loading { torque_nm: 1130.0, mesh_force: 12000.0 };
            let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
            let mut set =
                VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
            let mut compared = 0;
            // Every cycle begins anew at another torque, so that the touching cells change at every position.
            for cycle in 0..6 {
                let torque = 700.0 + 90.0 * f64::from(cycle);
                set.rest(torque).unwrap();
                for _ in 0..28 {
                    set.step().unwrap();
                    let k = set.clock.step_in_cycle;
                    let mut frame = set.frames.take(k, false).unwrap();
                    let own = frame.combinations[frame.used].clone();
                    if own.changes > 0 {
                        let kept = std::mem::take(&mut frame.combinations);
                        let races = &set.race_dynamics.stiffness;
                        let work = &mut CombiningWork::default();
                        let made =
                            Combination::new(&frame, &set.contact.maps, &own.maps, races, work);
                        let made = made.unwrap().unwrap();
                        assert_eq!(made.changes, 0);
                        assert_eq!((&made.places, &made.numbers), (&own.places, &own.numbers));
                        let (inverse, exact) = (own.inverse.full(), made.inverse.full());
                        let off = (inverse - &exact).amax() / exact.amax();
                        assert!(
                            off < 1e-11,
                            "{mesh_frequency} Hz, {} changes: {off:e}",
                            own.changes
                        );
                        frame.combinations = kept;
                        compared += 1;
                    }
                    set.frames.put_back(k, frame, false);
                }
            }
            assert!(compared >= least, "{mesh_frequency} Hz: {compared} compared");
        }
    }
}
