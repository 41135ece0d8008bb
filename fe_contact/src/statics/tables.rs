//! Tables of contact for all the phases that some positions of a set need.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use gearset::MeshKind;
use rayon::prelude::*;

use super::phase::PHASE_RESOLUTION;
use super::set::StaticSet;
use super::slopes::{NeighbourTables, Slopes};
use crate::complementarity::ActiveSet;
use crate::contact::{CellSettings, MeshTable, SharedMaps};
use crate::error::FeError;

/// Tables of all (meshes that share them, phase) some positions need, for one size of load; equal phases
/// share one.
#[derive(Debug, Clone)]
pub struct SetTables {
    /// The tables.
    pub list: Vec<Arc<MeshTable>>,
    /// Maps of each that sets in time have found.
    pub(crate) maps: Vec<Arc<SharedMaps>>,
    place: Arc<HashMap<(usize, i64), usize>>,
    /// Tables beside each, once slopes were asked for: of the nearest pairs, and of all.
    beside: Arc<Vec<[OnceLock<Arc<NeighbourTables>>; 2]>>,
    /// Settings they were made with.
    pub settings: CellSettings,
}

/// Which pairs tables beside another have, and for which load they are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Beside {
    /// Those with the smallest gaps, for the load at rest.
    Nearest,
    /// All that the other may have, for its load.
    All,
}

fn key(group: usize, phase: f64) -> (usize, i64) {
    (group, (phase * PHASE_RESOLUTION).round() as i64)
}

impl SetTables {
    /// Memory of the compliances, bytes.
    pub fn bytes(&self) -> usize {
        self.list.iter().map(|table| 8 * table.compliance.len()).sum()
    }

    /// Whether there is a table for meshes of a group at a phase (cycles).
    pub(crate) fn holds(&self, group: usize, phase: f64) -> bool {
        self.place.contains_key(&key(group, phase))
    }

    /// Place in the list of meshes of a group at a phase (cycles) the tables were made for.
    pub(crate) fn place_of(&self, group: usize, phase: f64) -> usize {
        self.place[&key(group, phase)]
    }
}

impl StaticSet<'_> {
    /// Tables for all meshes at the given positions (cycles), their grids sized for meshes that carry
    /// `force` (N).
    ///
    /// # Errors
    /// If a matching point lies outside its tooth.
    pub fn tables(&self, force: f64, positions: &[f64]) -> Result<SetTables, FeError> {
        self.tables_of(self.bodies.cells(force), positions, None)
    }

    /// The same on given cells. Those that `known` has, which are of the same gears, are not made again.
    ///
    /// # Errors
    /// As [`StaticSet::tables`].
    pub(crate) fn tables_of(
        &self,
        settings: CellSettings,
        positions: &[f64],
        known: Option<&SetTables>,
    ) -> Result<SetTables, FeError> {
        let known = known.filter(|own| own.settings == settings);
        let place_of = |group, phase| Some((known?, *known?.place.get(&key(group, phase))?));
        let mut wanted: Vec<(usize, f64)> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        for position in positions {
            for (mesh, pose) in self.reference.meshes.iter().enumerate() {
                let phase = self.phase(mesh, *position);
                if seen.insert(key(pose.group, phase)) {
                    wanted.push((pose.group, phase));
                }
            }
        }
        let list: Result<Vec<_>, FeError> = wanted
            .par_iter()
            .map(|(group, phase)| match place_of(*group, *phase) {
                Some((own, i)) => Ok(Arc::clone(&own.list[i])),
                None => self.table(*group, *phase, &settings).map(Arc::new),
            })
            .collect();
        let place = wanted.iter().enumerate().map(|(i, (g, phase))| (key(*g, *phase), i));
        let place = Arc::new(place.collect());
        let list = list?;
        let beside = wanted.iter().map(|(g, phase)| match place_of(*g, *phase) {
            Some((own, i)) => own.beside[i].clone(),
            None => [const { OnceLock::new() }; 2],
        });
        let beside = Arc::new(beside.collect());
        let maps = wanted.iter().map(|(g, phase)| match place_of(*g, *phase) {
            Some((own, i)) => Arc::clone(&own.maps[i]),
            None => Arc::default(),
        });
        let maps = maps.collect();
        Ok(SetTables { list, maps, place, beside, settings })
    }

    /// Lays out what [`StaticSet::slopes`] needs beside every table, on all threads.
    ///
    /// # Errors
    /// If a table cannot be had.
    pub(crate) fn lay_out_beside(&self, tables: &SetTables) -> Result<(), FeError> {
        let mut of: Vec<(usize, usize)> = tables.place.iter().map(|(k, i)| (*i, k.0)).collect();
        of.sort_unstable();
        of.into_par_iter().try_for_each(|(place, group)| {
            self.beside(tables, place, group, Beside::Nearest)?;
            Ok(())
        })
    }

    /// Tables beside one of the list, made at the first time of asking.
    fn beside<'t>(
        &self,
        tables: &'t SetTables,
        place: usize,
        group: usize,
        which: Beside,
    ) -> Result<&'t NeighbourTables, FeError> {
        let slot = &tables.beside[place][which as usize];
        if let Some(beside) = slot.get() {
            return Ok(beside);
        }
        let mesh = &self.reference.loaded[group].mesh;
        let (phase, settings) = (tables.list[place].phase, &tables.settings);
        let made = match which {
            Beside::Nearest => {
                let at_rest = self.share(self.reference.torque_nm);
                NeighbourTables::nearest(self.bodies, mesh, phase, settings, at_rest)
            }
            Beside::All => NeighbourTables::coarse(self.bodies, mesh, phase, settings),
        }?;
        Ok(slot.get_or_init(|| Arc::new(made)))
    }

    /// Slopes of the flanks of a front mesh at a position, whose pairs carry `forces` (N).
    ///
    /// # Errors
    /// If a table beside the position's cannot be had, or contact on it not be solved.
    pub(crate) fn slopes(
        &self,
        tables: &SetTables,
        mesh: usize,
        position: f64,
        forces: &[f64],
    ) -> Result<Slopes, FeError> {
        let place = self.place_of(tables, mesh, position);
        let group = self.reference.meshes[mesh].group;
        let between = &tables.list[place];
        let nearest = self.beside(tables, place, group, Beside::Nearest)?;
        if let Some(slopes) = nearest.slopes_of(between, forces, &ActiveSet)? {
            return Ok(slopes);
        }
        self.beside(tables, place, group, Beside::All)?.slopes(between, forces, &ActiveSet)
    }

    /// One table of the meshes of a group.
    pub(crate) fn table(
        &self,
        group: usize,
        phase: f64,
        settings: &CellSettings,
    ) -> Result<MeshTable, FeError> {
        let mesh = &self.reference.loaded[group].mesh;
        let bodies = self.bodies.pair(mesh.kind).ok_or_else(|| missing(mesh.kind))?;
        MeshTable::new(mesh, bodies, phase, settings)
    }

    /// Whether some tables hold the phases of all front meshes at a position.
    pub(crate) fn is_covered(&self, position: f64, tables: &SetTables) -> bool {
        let mut meshes = self.reference.meshes.iter().enumerate();
        meshes.all(|(mesh, pose)| tables.holds(pose.group, self.phase(mesh, position)))
    }
}

fn missing(kind: MeshKind) -> FeError {
    super::bodies::missing_mesh(kind)
}

#[cfg(test)]
mod tests {
    use gearset::Facing;
    use scene::Scene;

    use super::super::bodies::Bodies;
    use super::super::imperfection::Imperfections;
    use super::*;

    /// Share of a mesh's load that a pair barely carries.
    const SLIGHT: f64 = 1e-4;

    /// Slopes are found under forces of which one pair carries next to nothing, though Newton's iteration for its
    /// approach may part it on its way.
    #[test]
    fn a_pair_that_carries_next_to_nothing_has_its_slopes() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::from_file(path.as_ref()).unwrap();
        let bodies = Bodies::new(&scene).unwrap();
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let set = StaticSet::new(&scene, &bodies, sense, none).unwrap().under(339.0).unwrap();
        let positions: Vec<f64> = (0..140).map(|i| f64::from(i) / 140.0).collect();
        let tables = set.tables(set.share(339.0), &positions).unwrap();
        let load = set.share(339.0);
        for position in positions {
            for mesh in 0..set.nominal.len() {
                let phase = set.phase(mesh, position);
                let between =
                    &tables.list[tables.place_of(set.reference.meshes[mesh].group, phase)];
                // Each pair in turn carries next to nothing, the others the same each.
                for slight in 0..between.pairs.len() {
                    let others = between.pairs.len() - 1;
                    let rest = load * (1.0 - SLIGHT) / others as f64;
                    let mut forces = vec![rest; between.pairs.len()];
                    forces[slight] = SLIGHT * load;
                    set.slopes(&tables, mesh, position, &forces).unwrap();
                }
            }
        }
    }

    /// Slopes from the tables of the nearest pairs are those from tables of all pairs; a pair that only the latter
    /// have is found to be missing.
    #[test]
    fn nearest_pairs_give_the_slopes_of_all() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        let bodies = Bodies::new(&scene).unwrap();
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let set = StaticSet::new(&scene, &bodies, sense, none).unwrap().under(1413.0).unwrap();
        let positions: Vec<f64> = (0..9).map(|i| f64::from(i) / 9.0).collect();
        let tables = set.tables(set.share(1413.0), &positions).unwrap();
        let f = set.load(1413.0);
        let (mut fewer, mut missing, mut worst) = (0, 0, 0.0f64);
        for position in positions {
            let found = set.equilibrium(&f, position, &tables, None, &ActiveSet).unwrap();
            for (mesh, answer) in found.answers.iter().enumerate().take(set.nominal.len()) {
                let (group, phase) = (set.reference.meshes[mesh].group, set.phase(mesh, position));
                let place = tables.place_of(group, phase);
                let between = &tables.list[place];
                let beside = |which| set.beside(&tables, place, group, which).unwrap();
                let (nearest, all) = (beside(Beside::Nearest), beside(Beside::All));
                fewer += usize::from(!nearest.hold(between, &vec![1.0; between.pairs.len()]));
                if !nearest.hold(between, &answer.pair_forces) {
                    missing += 1;
                    continue;
                }
                let of = |b: &NeighbourTables| {
                    b.slopes(between, &answer.pair_forces, &ActiveSet).unwrap()
                };
                let (a, b) = (of(nearest), of(all));
                let scale = b.of_pairs.iter().flatten().fold(0.0f64, |a, k| a.max(k.abs()));
                for (a, b) in a.of_pairs.iter().flatten().zip(b.of_pairs.iter().flatten()) {
                    worst = worst.max((a - b).abs() / scale);
                }
                for which in 0..2 {
                    let load: f64 = answer.pair_forces.iter().sum();
                    worst = worst.max((a.rest[which] - b.rest[which]).abs() / (scale * load));
                }
            }
        }
        println!("largest difference {worst:.1e}; {missing} of 72 meshes need all pairs");
        assert!(worst < 1e-9, "{worst:e}");
        assert!(fewer > 18 && missing < 18, "{fewer} {missing}");
    }
}
