//! Parts of a cycle after which a symmetric set is itself, against the whole cycle.

use dynamics::{CarriedChange, MapDerivative, Multiplier};
use experiments::sweep::{
    CycleDerivative, Effort, Marching, MeshLawModel, SteadyMethod, SteadySettings, SweepError,
    SweepModel, steady,
};
use fe_contact::statics::Bodies;
use fe_contact::vibration::{Along, LoadedStep};
use gearset::Symmetry;
use scene::{Fidelity, LoadCase};

use super::apart;
use super::sets::{fe, scene};

/// A set whose cycles are marched as a whole although it is itself after a part, or one whose parts are put together
/// without renumbering the planets.
struct Told<'m> {
    set: Box<dyn Marching + 'm>,
    forgets_renumbering: bool,
}

impl Marching for Told<'_> {
    fn rest(&mut self) -> Result<(), SweepError> {
        self.set.rest()
    }

    fn step(&mut self) -> Result<(), SweepError> {
        self.set.step()
    }

    fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements()
    }

    fn mesh_forces(&self, out: &mut Vec<f64>) {
        self.set.mesh_forces(out);
    }

    fn loaded_step(&self) -> Option<LoadedStep> {
        self.set.loaded_step()
    }

    fn kinematic_rest(&self, at: &LoadedStep) -> Option<[f64; 2]> {
        self.set.kinematic_rest(at)
    }

    fn effort(&self) -> Effort {
        self.set.effort()
    }

    fn state(&mut self) -> Vec<f64> {
        self.set.state()
    }

    fn counters(&self) -> usize {
        self.set.counters()
    }

    fn restore(&mut self, state: &[f64]) -> Result<(), SweepError> {
        self.set.restore(state)
    }

    fn derivative(&mut self) -> Option<&mut dyn CycleDerivative> {
        Some(self)
    }

    fn displacements_of(&self, coordinates: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements_of(coordinates)
    }
}

impl CycleDerivative for Told<'_> {
    fn coordinates(&mut self) -> Vec<f64> {
        self.set.derivative().unwrap().coordinates()
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError> {
        self.set.derivative().unwrap().set_coordinates(y)
    }

    fn symmetry(&mut self) -> Result<Option<Symmetry>, SweepError> {
        if !self.forgets_renumbering {
            return Ok(None);
        }
        let own = self.set.derivative().unwrap().symmetry()?;
        Ok(own.map(|own| Symmetry { shift: 0, ..own }))
    }

    fn start(&mut self) {
        self.set.derivative().unwrap().start();
    }

    fn keep_step(&mut self) {
        self.set.derivative().unwrap().keep_step();
    }

    fn end(&mut self) -> Result<(), SweepError> {
        self.set.derivative().unwrap().end()
    }

    fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, SweepError> {
        self.set.derivative().unwrap().of_cycle(along)
    }

    fn of_cycle_with(&mut self, change: CarriedChange<'_>) -> Result<MapDerivative, SweepError> {
        self.set.derivative().unwrap().of_cycle_with(change)
    }
}

/// Multipliers by the part of a cycle and by the whole.
struct Compared {
    name: String,
    of_part: Vec<Multiplier>,
    of_whole: Vec<Multiplier>,
}

/// The scenes with the parts of a cycle after which they are themselves: two opposed pairs of planets after half a
/// cycle, five planets after a fifth; three planets in phase have no such part. Steps per cycle, torque on the sun (N
/// m).
const SYMMETRIC: [(&str, Option<usize>, u32, f64); 3] = [
    ("oh58_4p", Some(2), 56, 1130.0),
    ("five_planets", Some(5), 60, 800.0),
    ("oh58_3p", None, 56, 500.0),
];

/// The set without a symmetry, and if told so with one that forgets to renumber the planets.
fn found(
    model: &dyn SweepModel,
    how: Option<bool>,
) -> (Option<Symmetry>, experiments::sweep::Steady) {
    let mut set = model.turning(&model.case().at_speed(1450.0), 0).unwrap();
    set.rest().unwrap();
    let mut set: Box<dyn Marching + '_> = match how {
        Some(forgets_renumbering) => Box::new(Told { set, forgets_renumbering }),
        None => set,
    };
    let own = set.derivative().unwrap().symmetry().unwrap();
    let settings =
        SteadySettings { tolerance: 1e-11, between_cycles: 0, ..SteadySettings::default() };
    let (planets, first) = (model.planets(), model.first_planet_rad());
    let found = steady(set.as_mut(), planets, first, model.steps_per_cycle(), &settings).unwrap();
    assert_eq!(found.method, SteadyMethod::Shooting, "{}: {:?}", model.name(), found.why_marched);
    (own, found)
}

/// A part of the cycle with the planets renumbered gives what the whole cycle gives: states to 1e-10 of the vibration.
/// Without renumbering the record is another one.
fn part_and_whole(name: &str, model: &dyn SweepModel, parts: Option<usize>) -> Compared {
    let name = format!("{name}, {}", model.name());
    let (symmetry, of_part) = found(model, None);
    assert_eq!(symmetry.map(|own| own.parts), parts, "{name}");
    let (none, whole) = found(model, Some(false));
    assert!(none.is_none());
    let off = of_part.record.change_from(&whole.record);
    assert!(off < 1e-10, "{name}: {off:e}");
    assert_eq!(of_part.record.len(), whole.record.len());
    for mesh in 0..2 * model.planets() {
        let (a, b) = (of_part.record.mesh_force(mesh), whole.record.mesh_force(mesh));
        let largest = b.iter().fold(0.0f64, |a, f| a.max(*f));
        let off = a.iter().zip(&b).fold(0.0f64, |off, (a, b)| off.max((a - b).abs()));
        assert!(off < 1e-8 * largest, "{name}, mesh {mesh}: {off:e} of {largest:e}");
    }
    if parts.is_some() {
        let off = found(model, Some(true)).1.record.change_from(&whole.record);
        assert!(off > 1e-3, "{name} without renumbering: {off:e}");
    }
    Compared { name, of_part: of_part.multipliers, of_whole: whole.multipliers }
}

fn with_quasi_static_bodies() -> Vec<Compared> {
    let each = SYMMETRIC.iter().map(|(name, parts, steps, torque)| {
        let scene = scene(name, Fidelity::QuasiStatic, *steps);
        let bodies = Bodies::new(&scene).unwrap();
        part_and_whole(name, &fe(&scene, &bodies, *torque), *parts)
    });
    each.collect()
}

#[test]
fn parts_of_a_cycle_are_the_whole_of_symmetric_sets() {
    for Compared { name, of_part, of_whole } in with_quasi_static_bodies() {
        let [a, b] = [of_part[0], of_whole[0]];
        assert!(apart(a, b) < 1e-8, "{name}: {a:?} {b:?}");
    }
}

/// All multipliers to 1e-8.
fn all_agree(Compared { name, of_part, of_whole }: &Compared) {
    assert!(of_whole.len() >= 20, "{name}");
    for (a, b) in of_part.iter().zip(of_whole).take(24) {
        assert!(apart(*a, *b) < 1e-8, "{name}: {a:?} {b:?}");
    }
}

/// Where meshes follow a law, and of the lumped model: states to 1e-10, all multipliers to 1e-8.
#[test]
fn parts_of_a_cycle_are_the_whole_where_meshes_follow_a_law() {
    for (name, parts, steps, torque) in SYMMETRIC {
        let scene = scene(name, Fidelity::MeshLaw, steps);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(torque);
        let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
        for model in [&law as &dyn SweepModel, &law.lumped()] {
            all_agree(&part_and_whole(name, model, parts));
        }
    }
}

#[test]
fn multipliers_of_parts_are_those_of_the_whole() {
    with_quasi_static_bodies().iter().for_each(all_agree);
}
