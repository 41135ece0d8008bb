//! Steady states by shooting against marching, on all fidelities that have a derivative.

use dynamics::{CarriedChange, MapDerivative, Multiplier, multipliers};
use experiments::ExperimentError;
use experiments::sweep::{
    Coordinate, CycleDerivative, Effort, FeModel, Marching, MeshLawModel, Record, SteadyMethod,
    SteadySettings, SweepModel, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{Along, LoadedStep};
use gearset::{Fidelity, LoadCase, Scene, Symmetry};
use nalgebra::DMatrix;

fn scene(name: &str, fidelity: Fidelity, steps: u32) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 6;
    scene.dynamics.steps_per_cycle = steps;
    scene.dynamics.fidelity = fidelity;
    scene
}

fn fe<'b>(scene: &Scene, bodies: &'b Bodies, torque_nm: f64) -> FeModel<'b> {
    let case = LoadCase::of_scene(scene).unwrap().with_sun_torque(torque_nm);
    FeModel::new(scene, bodies, Imperfections::default(), case)
}

/// Largest difference between the records of shooting and of marching from rest, relative to the peak-to-peak
/// vibration; also the cycles that each took, and the largest multiplier.
fn compare(model: &dyn SweepModel, rpm: f64, most_cycles: usize) -> (f64, [usize; 2], f64) {
    let shooting = SteadySettings { between_cycles: 0, most_cycles, ..SteadySettings::default() };
    let marching =
        SteadySettings { method: SteadyMethod::Marching, tolerance: 1e-11, ..shooting.clone() };
    let find = |settings: &SteadySettings| {
        let mut set = model.turning(&model.case().at_speed(rpm), 0).unwrap();
        set.rest().unwrap();
        let steps = model.steps_per_cycle();
        steady(set.as_mut(), model.shape(), model.first_planet_rad(), steps, settings).unwrap()
    };
    let shot = find(&shooting);
    assert_eq!(shot.method, SteadyMethod::Shooting, "{rpm} rpm: {:?}", shot.why_marched);
    assert!(shot.residual <= shooting.tolerance);
    let marched = find(&marching);
    let largest = shot.multipliers.first().map_or(0.0, |m| m.size());
    (shot.record.change_from(&marched.record), [shot.cycles, marched.cycles], largest)
}

/// 1e-6 of the response, on and off resonance, with corner contact (each mesh passes it twice a cycle).
#[test]
fn shooting_and_marching_agree_on_quasi_static_bodies() {
    for (name, torque) in [("oh58_4p", 1130.0), ("oh58_3p", 500.0)] {
        let scene = scene(name, Fidelity::QuasiStatic, 56);
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, torque);
        for k in 0..8 {
            let rpm = 300.0 + 310.0 * f64::from(k);
            let (off, cycles, largest) = compare(&model, rpm, 2000);
            assert!(off < 1e-6, "{name}, {rpm} rpm: {off:e}, {cycles:?}");
            assert!(largest < 1.0 && 2 * cycles[0] < cycles[1], "{rpm}: {largest} {cycles:?}");
        }
    }
}

/// Modes of the gears stand in frames that turn by a tooth in each cycle.
#[test]
fn shooting_and_marching_agree_on_modal_bodies() {
    let scene = scene("oh58_4p", Fidelity::Modal(6), 56);
    let bodies = Bodies::new(&scene).unwrap();
    let model = fe(&scene, &bodies, 1130.0);
    for rpm in [900.0, 1430.0, 2200.0] {
        let (off, cycles, largest) = compare(&model, rpm, 2000);
        assert!(off < 1e-6, "{rpm} rpm: {off:e}, {cycles:?}");
        assert!(largest < 1.0);
    }
}

/// Tabulated mesh forces on three sets and a pair of gears, and the lumped models of the sets.
#[test]
fn shooting_and_marching_agree_where_meshes_follow_a_law() {
    for (name, torque, speeds) in [
        ("oh58_4p", 1130.0, [400.0, 800.0, 1200.0, 1600.0, 2000.0, 2400.0].as_slice()),
        ("oh58_3p", 500.0, &[450.0, 1150.0, 1650.0, 2350.0]),
        ("five_planets", 800.0, &[450.0, 1150.0, 1650.0, 2350.0]),
        ("pair_50_50", 150.0, &[900.0, 1400.0, 1900.0, 3300.0]),
    ] {
        let scene = scene(name, Fidelity::MeshLaw, 56);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(torque);
        let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
        let lumped = scene.lumped.is_some().then(|| law.lumped());
        for model in std::iter::once(&law).chain(&lumped) {
            for rpm in speeds {
                let (off, cycles, largest) = compare(model, *rpm, 4000);
                assert!(off < 1e-6, "{name}, {}, {rpm} rpm: {off:e}, {cycles:?}", model.name());
                assert!(largest < 1.0);
            }
        }
    }
}

/// Light load and a fifth of the damping, near resonances of the second and third harmonic: meshes part for 5 to
/// 21 % of the cycle.
#[test]
fn shooting_and_marching_agree_where_teeth_part() {
    let mut scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
    scene.damping.mass_proportional_per_s *= 0.2;
    scene.damping.stiffness_proportional_s *= 0.2;
    scene.damping.bearing_s *= 0.2;
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(40.0);
    // Tables for eight times the usual mesh force: resonance multiplies a light load.
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), case).with_tables(3);
    let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    for rpm in [3050.0, 3300.0, 3350.0] {
        let (off, cycles, largest) = compare(&model, rpm, 4000);
        assert!(off < 1e-6, "{rpm} rpm: {off:e}, {cycles:?}");
        assert!(largest < 1.0 && 10 * cycles[0] < cycles[1], "{rpm}: {cycles:?}");
        let mut set = model.turning(&model.case().at_speed(rpm), 0).unwrap();
        set.rest().unwrap();
        let found = steady(set.as_mut(), 4, 0.0, model.steps_per_cycle(), &settings).unwrap();
        let apart = |mesh: usize| found.record.mesh_force(mesh).iter().any(|f| *f <= 0.0);
        assert!((0..8).any(apart), "{rpm}");
    }
}

/// Marches a cycle with every step kept, and takes it back.
fn march_cycle(set: &mut dyn Marching, steps: usize) {
    set.derivative().unwrap().start();
    for _ in 0..steps {
        set.step().unwrap();
        set.derivative().unwrap().keep_step();
    }
    set.derivative().unwrap().end().unwrap();
}

/// Coordinates at the end of a cycle from those at its start.
fn end_of_cycle(set: &mut dyn Marching, start: &[f64], steps: usize) -> Vec<f64> {
    set.derivative().unwrap().set_coordinates(start).unwrap();
    march_cycle(set, steps);
    set.derivative().unwrap().coordinates()
}

/// A cycle in the middle of which a step failed is begun anew by setting coordinates or a state: the same cycle follows, but for
/// the rounding of contact patterns that were met in between.
#[test]
fn a_cycle_that_fails_leaves_nothing_behind() {
    let steps = 28;
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(4)] {
        let scene = scene("oh58_4p", fidelity, steps as u32);
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, 1130.0);
        let mut set = model.turning(&model.case().at_speed(1500.0), 0).unwrap();
        set.rest().unwrap();
        march_cycle(set.as_mut(), steps);
        let (start, state) = (set.derivative().unwrap().coordinates(), set.state());
        let end = end_of_cycle(set.as_mut(), &start, steps);
        // Away from the motion by more and more, until a mesh gives way beyond its tables in the middle of the cycle.
        let fail = |set: &mut dyn Marching| {
            (0..60).any(|k| {
                let factor = 2f64.powf(0.5 * f64::from(k));
                let away = |(a, b): (&f64, &f64)| a + factor * (b - a);
                let wild: Vec<f64> = start.iter().zip(&end).map(away).collect();
                set.derivative().unwrap().set_coordinates(&wild).unwrap();
                let failed = (0..steps).find(|_| set.step().is_err());
                if failed.is_none() {
                    set.derivative().unwrap().end().unwrap();
                }
                failed.is_some_and(|step| step > 0)
            })
        };
        let displaced = |set: &dyn Marching, y: &[f64]| -> Vec<f64> {
            let (central, planets) = set.displacements_of(y);
            central.iter().chain(&planets).flatten().copied().collect()
        };
        let expected = displaced(set.as_ref(), &end);
        let size = expected.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let is_same = |set: &dyn Marching, y: &[f64]| {
            let found = displaced(set, y);
            found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-10 * size)
        };
        assert!(fail(set.as_mut()));
        let again = end_of_cycle(set.as_mut(), &start, steps);
        assert!(is_same(set.as_ref(), &again), "{fidelity:?}");
        assert!(fail(set.as_mut()));
        set.restore(&state).unwrap();
        march_cycle(set.as_mut(), steps);
        let again = set.derivative().unwrap().coordinates();
        assert!(is_same(set.as_ref(), &again), "{fidelity:?}");
    }
}

/// Columns of the derivative against central differences over a whole cycle.
#[test]
fn the_derivative_is_that_of_the_cycle() {
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(4)] {
        let scene = scene("oh58_4p", fidelity, 28);
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, 1130.0);
        let mut set = model.turning(&model.case().at_speed(1500.0), 0).unwrap();
        set.rest().unwrap();
        let mut record = Record::new(4);
        record.march(set.as_mut(), 0.0, 28 * 4).unwrap();
        let start = set.derivative().unwrap().coordinates();
        march_cycle(set.as_mut(), 28);
        let derivative = set.derivative().unwrap().of_cycle(Along::Every).unwrap();
        for (column, j) in derivative.active.iter().enumerate().step_by(5) {
            let change = 1e-10 * derivative.scales[*j];
            let ends = [1.0, -1.0].map(|sign| {
                let mut y = start.clone();
                y[*j] += sign * change;
                end_of_cycle(set.as_mut(), &y, 28)
            });
            let (mut size, mut off) = (0.0f64, 0.0f64);
            for (i, scale) in derivative.scales.iter().enumerate() {
                let exact = derivative.columns[(i, column)] * derivative.scales[*j] / scale;
                let found =
                    (ends[0][i] - ends[1][i]) / (2.0 * change) * derivative.scales[*j] / scale;
                size = size.max(exact.abs());
                off = off.max((found - exact).abs());
            }
            assert!(off < 1e-5 * (1.0 + size), "{fidelity:?}, coordinate {j}: {off:e} of {size:e}");
        }
    }
}

/// Difference of two multipliers by half the sum and by the product of each with its conjugate, which the derivative
/// determines: near the real axis the imaginary part itself is the root of a small difference.
fn apart(a: Multiplier, b: Multiplier) -> f64 {
    (a.re - b.re).abs().max((a.size().powi(2) - b.size().powi(2)).abs())
}

/// The derivative of a steady cycle along displacements and velocities, and another one.
fn both_derivatives(fidelity: Fidelity, other: Along) -> [MapDerivative; 2] {
    let scene = scene("oh58_4p", fidelity, 56);
    let bodies = Bodies::new(&scene).unwrap();
    both_derivatives_of(&fe(&scene, &bodies, 1130.0), other)
}

fn both_derivatives_of(model: &dyn SweepModel, other: Along) -> [MapDerivative; 2] {
    let mut set = model.turning(&model.case().at_speed(2200.0), 0).unwrap();
    set.rest().unwrap();
    // The cycle before the start must be as that before the end.
    (0..400).for_each(|_| march_cycle(set.as_mut(), 56));
    [Along::Motion, other].map(|along| set.derivative().unwrap().of_cycle(along).unwrap())
}

/// Largest difference of the multipliers above 0.01 of the second from those of the first.
fn multipliers_off(first: &MapDerivative, second: &MapDerivative) -> f64 {
    let [a, b] = [first, second].map(|own| multipliers(own).unwrap());
    let large = b.iter().filter(|m| m.size() > 1e-2);
    assert!(large.clone().count() >= 20);
    large.zip(&a).fold(0.0f64, |off, (b, a)| off.max(apart(*a, *b)))
}

/// Displacements and velocities suffice: the derivative along them, with accelerations and lag following, has the
/// multipliers of the derivative with respect to every coordinate.
#[test]
fn multipliers_follow_from_displacements_and_velocities() {
    let [motion, every] = both_derivatives(Fidelity::QuasiStatic, Along::Every);
    let off = multipliers_off(&motion, &every);
    assert!(off < 1e-8, "{off:e}");
}

/// The same with a fifth and a twentieth of the damping, whose lag is a smaller part of a step and is followed over fewer steps.
#[test]
fn multipliers_follow_from_displacements_and_velocities_at_little_damping() {
    for factor in [0.2, 0.05] {
        let mut scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
        scene.damping.mass_proportional_per_s *= factor;
        scene.damping.stiffness_proportional_s *= factor;
        scene.damping.bearing_s *= factor;
        let bodies = Bodies::new(&scene).unwrap();
        let [motion, every] = both_derivatives_of(&fe(&scene, &bodies, 1130.0), Along::Every);
        let off = multipliers_off(&motion, &every);
        println!("{factor}: {off:e}");
        assert!(off < 1e-8, "{factor}: {off:e}");
    }
}

/// The same with modes of the bodies.
#[test]
fn multipliers_follow_from_displacements_and_velocities_of_modal_bodies() {
    let [motion, every] = both_derivatives(Fidelity::Modal(4), Along::Every);
    let off = multipliers_off(&motion, &every);
    println!("{off:e}");
    assert!(off < 1e-8, "{off:e}");
}

/// The rough derivative, in single precision and of FE/contact with a shorter follow-up of the lag, differs from the exact one
/// by less than corrections of a state need, also with modes of the bodies and with tabulated mesh forces:
/// (I − D)⁻¹ D' − (I − D)⁻¹ D is what a correction leaves of an error.
#[test]
fn the_rough_derivative_leaves_little_of_an_error() {
    let scene = scene("oh58_4p", Fidelity::MeshLaw, 56);
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(1130.0);
    let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let all = [
        ("quasi_static", both_derivatives(Fidelity::QuasiStatic, Along::MotionRoughly)),
        ("modal", both_derivatives(Fidelity::Modal(4), Along::MotionRoughly)),
        ("mesh_law", both_derivatives_of(&law, Along::MotionRoughly)),
        ("lumped", both_derivatives_of(&law.lumped(), Along::MotionRoughly)),
    ];
    for (name, both) in all {
        let [exact, rough] = both.map(|own| {
            let (active, s) = (&own.active, &own.scales);
            DMatrix::from_fn(active.len(), active.len(), |i, j| {
                own.columns[(active[i], j)] * s[active[j]] / s[active[i]]
            })
        });
        let n = exact.nrows();
        let left = (DMatrix::identity(n, n) - &exact).lu().solve(&(&rough - &exact)).unwrap();
        let largest = left.complex_eigenvalues().iter().fold(0.0f64, |a, x| a.max(x.norm()));
        println!("{name}: left {largest:.1e}, entries off by {:.1e}", (rough - exact).amax());
        assert!(largest > 1e-9 && largest < 1e-2, "{name}: {largest:e}");
    }
}

/// A derivative that forgets the state of the lag, as if it began every cycle at rest, has other multipliers than one
/// that keeps it, by more than the two ways to keep it differ.
#[test]
fn a_forgotten_lag_shows_in_the_multipliers() {
    let [motion, every] = both_derivatives(Fidelity::QuasiStatic, Along::Every);
    let mut forgets = every.clone();
    let kept: Vec<usize> =
        (0..forgets.active.len()).filter(|k| forgets.scales[forgets.active[*k]] != 1e9).collect();
    assert!(kept.len() < forgets.active.len());
    forgets.columns = forgets.columns.select_columns(&kept);
    forgets.active = kept.iter().map(|k| forgets.active[*k]).collect();
    let [right, wrong] = [&motion, &forgets].map(|own| multipliers_off(own, &every));
    println!("lag kept {right:e}, forgotten {wrong:e}");
    assert!(wrong > 10.0 * right, "{wrong:e}, {right:e}");
}

/// A set whose cycles are marched as a whole although it is itself after a part, or one whose parts are put together
/// without renumbering the planets.
struct Told<'m> {
    set: Box<dyn Marching + 'm>,
    forgets_renumbering: bool,
}

impl Marching for Told<'_> {
    fn rest(&mut self) -> Result<(), ExperimentError> {
        self.set.rest()
    }

    fn step(&mut self) -> Result<(), ExperimentError> {
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

    fn restore(&mut self, state: &[f64]) -> Result<(), ExperimentError> {
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

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), ExperimentError> {
        self.set.derivative().unwrap().set_coordinates(y)
    }

    fn symmetry(&mut self) -> Result<Option<Symmetry>, ExperimentError> {
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

    fn end(&mut self) -> Result<(), ExperimentError> {
        self.set.derivative().unwrap().end()
    }

    fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, ExperimentError> {
        self.set.derivative().unwrap().of_cycle(along)
    }

    fn of_cycle_with(
        &mut self,
        change: CarriedChange<'_>,
    ) -> Result<MapDerivative, ExperimentError> {
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
/// cycle, five planets after a fifth; three planets in phase have no such part. Steps per cycle, torque on the sun (N m).
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

/// A kept harmonic of a shot sweep point is that of a marched one.
#[test]
fn harmonics_of_points_agree() {
    use experiments::sweep::{Direction, Memory, Part, Plan, run};
    let scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
    let bodies = Bodies::new(&scene).unwrap();
    let model = fe(&scene, &bodies, 1130.0);
    let of = |method: SteadyMethod| {
        let settings = SteadySettings { method, ..SteadySettings::default() };
        let plan = Plan::new(&[1400.0, 1450.0], &[Direction::Up], settings).unwrap();
        run(&model, &plan, &Memory, &|_| ()).unwrap()
    };
    let (shot, marched) = (of(SteadyMethod::Shooting), of(SteadyMethod::Marching));
    for (a, b) in shot.points().iter().zip(marched.points()) {
        assert!(a.largest_multiplier().is_some() && b.largest_multiplier().is_none());
        assert!(a.between.unwrap() < 1e-15, "{:?}", a.between);
        for harmonic in 1..=5 {
            let of = |p: &&experiments::sweep::SweepPoint| {
                p.state.amplitude(Part::Sun, Coordinate::Rotation, harmonic)
            };
            assert!((of(a) - of(&b)).abs() < 1e-13, "{harmonic}");
        }
    }
    assert!(shot.coexisting_rpm().is_empty());
}
