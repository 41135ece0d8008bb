//! Sets in time: at rest, free, turning.

use fe_contact::body::BodyMatrices;
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{LinearSet, Loading, NominalRotation, VibratingSet, fixed_race_modes};
use gearset::{Axis, Body, Facing, PathDirection};
use scene::{Fidelity, Scene};

const TORQUE: f64 = 1130.0;

fn scene(name: &str, fidelity: Fidelity) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    // A coarse FE mesh suffices: no statement tested here depends on it.
    scene.fe_contact.flank_elements = 8;
    scene.dynamics.fidelity = fidelity;
    scene
}

fn force(scene: &Scene, bodies: &Bodies) -> f64 {
    let sun = bodies.geometry.sun.as_ref().unwrap();
    TORQUE / scene.planets.psi_rad.len() as f64 / sun.base_radius
}

fn set<'b>(scene: &Scene, bodies: &'b Bodies, rotation: NominalRotation) -> VibratingSet<'b> {
    let sense = Facing::CounterClockwise;
    let loading = Loading { torque_nm: TORQUE, mesh_force: force(scene, bodies) };
    VibratingSet::new(scene, bodies, sense, Imperfections::default(), rotation, loading).unwrap()
}

fn loading(mesh_force: f64) -> Loading {
    Loading { torque_nm: TORQUE, mesh_force }
}

fn standing(step: f64) -> NominalRotation {
    NominalRotation::Standing { position: 0.3, step }
}

fn turning(steps_per_cycle: usize) -> NominalRotation {
    NominalRotation::Turning {
        mesh_frequency: 500.0,
        steps_per_cycle,
        direction: PathDirection::Forward,
    }
}

/// At every fidelity a set stays at rest in its equilibrium.
#[test]
fn a_set_at_rest_stays_at_rest() {
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(3), Fidelity::Full] {
        let scene = scene("oh58_4p", fidelity);
        let bodies = Bodies::new(&scene).unwrap();
        let mut set = set(&scene, &bodies, standing(5e-6));
        set.rest(TORQUE).unwrap();
        let start = set.motion().x.clone();
        let size = start.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        for _ in 0..12 {
            set.step().unwrap();
        }
        let moved = set.motion().x.iter().zip(&start).map(|(a, b)| (a - b).abs());
        let moved = moved.fold(0.0f64, f64::max);
        assert!(moved < 1e-9 * size, "{fidelity:?}: {moved:e} of {size:e}");
    }
}

/// Displacements of the races after the torque has risen by a thousandth and fallen back within 1
/// ms.
fn after_swell(scene: &Scene, bodies: &Bodies, steps: usize) -> Vec<f64> {
    let span = 1e-3;
    let step = span / steps as f64;
    let mut set = set(scene, bodies, standing(step));
    set.rest(TORQUE).unwrap();
    let steady = set.external.clone();
    let start = set.motion().x.clone();
    for k in 1..=steps {
        let t = k as f64 / steps as f64;
        let swell = 1e-3 * (std::f64::consts::PI * t).sin().powi(4);
        set.external.copy_from(&(&steady * (1.0 + swell)));
        set.step().unwrap();
    }
    set.motion().x.iter().zip(&start).map(|(a, b)| a - b).collect()
}

#[test]
fn newmark_is_of_second_order_with_and_without_lag() {
    for beta in [None, Some(0.0)] {
        let mut scene = scene("oh58_4p", Fidelity::QuasiStatic);
        if let Some(beta) = beta {
            scene.damping.stiffness_proportional_s = beta;
        }
        let bodies = Bodies::new(&scene).unwrap();
        let runs = [200, 400, 800].map(|steps| after_swell(&scene, &bodies, steps));
        let apart = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
        };
        let order = (apart(&runs[0], &runs[1]) / apart(&runs[1], &runs[2])).log2();
        assert!((order - 2.0).abs() < 0.1, "β {beta:?}: order {order}");
    }
}

/// In every step of a turning set, kinetic energy and energy of the bearings change by the work
/// done.
#[test]
fn the_discrete_energy_identity_holds() {
    let scene = scene("oh58_4p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut set = set(&scene, &bodies, turning(140));
    set.rest(TORQUE).unwrap();
    let mut worst = 0.0f64;
    let mut size = 0.0f64;
    for _ in 0..420 {
        let (before, start) = (set.energies(), set.step_start());
        set.step().unwrap();
        let (after, work) = (set.energies(), set.work_since(&start));
        let change = after.kinetic - before.kinetic + after.bearings - before.bearings;
        let done = work.external - work.damped - work.against_contact;
        worst = worst.max((change - done).abs());
        size = size.max(after.kinetic + after.bearings);
    }
    assert!(worst < 1e-10 * size, "{worst:e} of {size:e}");
}

/// With three planets in phase the sun stays in its centre, and all planets move alike.
#[test]
fn three_planets_keep_the_sun_in_its_centre() {
    let scene = scene("oh58_3p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut set = set(&scene, &bodies, turning(70));
    set.rest(TORQUE).unwrap();
    for _ in 0..350 {
        set.step().unwrap();
        let (central, planets) = set.displacements();
        let across = central[2][0].hypot(central[2][1]);
        assert!(across < 1e-12, "{across:e}");
        for planet in &planets[1..] {
            for (a, b) in planet.iter().zip(&planets[0]) {
                assert!((a - b).abs() < 1e-11);
            }
        }
    }
}

/// The stiffness of the linearised set gives the change of equilibrium under a slightly larger
/// torque.
#[test]
fn linearisation_is_the_derivative_of_statics() {
    let scene = scene("oh58_4p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut set = set(&scene, &bodies, standing(5e-6));
    set.rest(TORQUE).unwrap();
    let linear = set.linearised().unwrap();
    let (low, torque) = (set.motion().x.clone(), TORQUE * (1.0 + 1e-5));
    let load = set.external.clone();
    set.rest(torque).unwrap();
    let step: Vec<f64> = set.motion().x.iter().zip(&low).map(|(a, b)| a - b).collect();
    let step = nalgebra::DVector::from_vec(step);
    let expected = linear.stiffness().lu().solve(&((&set.external) - load)).unwrap();
    let off = (&step - &expected).norm() / expected.norm();
    assert!(off < 1e-4, "{off:e}");
}

/// A linearised set without the turning of its mesh forces, whose stiffness is undamped.
fn undamped_turning_left_out(mut linear: LinearSet) -> LinearSet {
    linear.supports -= &linear.turning;
    linear
}

/// With damping by α and β, the low modes are damped proportionally, except that half-planes are
/// undamped.
#[test]
fn linear_damping_is_near_that_of_proportional_damping() {
    let scene = scene("oh58_3p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut set = set(&scene, &bodies, standing(5e-6));
    set.rest(TORQUE).unwrap();
    let linear = undamped_turning_left_out(set.linearised().unwrap());
    let (alpha, beta) = (142.9, 2.21e-6);
    for mode in linear.damped().unwrap().iter().take(8) {
        let omega = std::f64::consts::TAU * mode.frequency_hz;
        let proportional = 0.5 * (alpha / omega + beta * omega);
        let share = mode.damping_ratio / proportional;
        assert!(share > 0.95 && share < 1.001, "{}: {share}", mode.frequency_hz);
    }
}

/// In a mode φ of unit modal mass slow damping gives 2ζω = φᵀ C φ, which the first eight modes of the damped set have
/// with the state of its lag.
#[test]
fn slow_damping_is_that_of_the_lagging_set() {
    let scene = scene("oh58_4p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut set = set(&scene, &bodies, standing(5e-6));
    set.rest(TORQUE).unwrap();
    let linear = set.linearised().unwrap();
    let damping = linear.slow_damping();
    let (frequencies, shapes) = linear.undamped().unwrap();
    let moving: Vec<usize> = (0..frequencies.len()).filter(|i| frequencies[*i] > 100.0).collect();
    let damped: Vec<_> =
        linear.damped().unwrap().into_iter().filter(|m| m.frequency_hz > 100.0).collect();
    for (i, exact) in moving.iter().zip(&damped).take(8) {
        let shape = shapes.column(*i);
        let omega = std::f64::consts::TAU * frequencies[*i];
        let ratio = shape.dot(&(&damping * shape)) / (2.0 * omega);
        let off = (ratio / exact.damping_ratio - 1.0).abs();
        println!("{:.1} Hz: {ratio:.5} and {:.5}", frequencies[*i], exact.damping_ratio);
        assert!(off < 0.02, "{} Hz: {ratio} {}", frequencies[*i], exact.damping_ratio);
    }
}

#[test]
#[ignore = "long: .ci/full runs it"]
fn modes_and_full_bodies_answer_alike() {
    // All modes together would be the full body; twelve come closer to it than none.
    let run = |fidelity| {
        let scene = scene("oh58_3p", fidelity);
        let bodies = Bodies::new(&scene).unwrap();
        let mut set = set(&scene, &bodies, standing(5e-6));
        set.rest(TORQUE).unwrap();
        let (steady, start) = (set.external.clone(), set.motion().x.clone());
        let mut path = Vec::new();
        for k in 1..=60 {
            let pulse = if k <= 8 { 1e-3 } else { 0.0 };
            set.external.copy_from(&(&steady * (1.0 + pulse)));
            set.step().unwrap();
            path.extend(set.motion().x.iter().zip(&start).map(|(a, b)| a - b));
        }
        path
    };
    let full = run(Fidelity::Full);
    let apart = |path: &[f64]| {
        let square: f64 = path.iter().zip(&full).map(|(a, b)| (a - b).powi(2)).sum();
        (square / full.iter().map(|x| x * x).sum::<f64>()).sqrt()
    };
    let few = apart(&run(Fidelity::QuasiStatic));
    let more = apart(&run(Fidelity::Modal(12)));
    assert!(few < 0.02, "{few}");
    assert!(more < 0.8 * few, "{few} {more}");
}

/// The flexibility that the modes of a body leave out acts statically, between its meshes as within
/// them, so that the equilibrium does not depend on the number of modes.
#[test]
#[ignore = "long: .ci/full runs it"]
fn equilibrium_is_that_of_full_bodies_with_any_number_of_modes() {
    let at_rest = |fidelity| {
        let scene = scene("oh58_4p", fidelity);
        let bodies = Bodies::new(&scene).unwrap();
        let mut set = set(&scene, &bodies, standing(5e-6));
        set.rest(TORQUE).unwrap();
        set.motion().x.clone()
    };
    let full = at_rest(Fidelity::Full);
    let size = full.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    let apart = |fidelity| {
        let x = at_rest(fidelity);
        x.iter().zip(&full).fold(0.0f64, |a, (x, full)| a.max((x - full).abs())) / size
    };
    for n in [1, 5] {
        let apart = apart(Fidelity::Modal(n));
        assert!(apart < 1e-9, "{n} modes: {apart:e}");
    }
    // Quasi-static bodies leave out the coupling between different meshes.
    let apart = apart(Fidelity::QuasiStatic);
    assert!(apart > 1e-5 && apart < 1e-2, "{apart:e}");
}

/// The lowest modes of a gear with its race held are a band of tooth bending modes, one per tooth,
/// well below the next mode.
#[test]
fn teeth_bend_in_a_band_of_as_many_modes() {
    let scene = scene("oh58_4p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    for body in [&bodies.planet, bodies.sun.as_ref().unwrap()] {
        let (mesh, teeth) = (&body.mesh, body.mesh.outline.gear().teeth as usize);
        let matrices = BodyMatrices::of_gear(mesh, &body.material, body.face_width).unwrap();
        let modes = fixed_race_modes(&matrices, teeth + 1, 0.04, mesh.name).unwrap();
        let khz = |i: usize| modes[i].lambda.sqrt() / std::f64::consts::TAU / 1e3;
        println!(
            "{}: {:.1} to {:.1}, then {:.1} kHz",
            mesh.name,
            khz(0),
            khz(teeth - 1),
            khz(teeth)
        );
        let widest = (1..teeth).map(|i| khz(i) / khz(i - 1)).fold(0.0f64, f64::max);
        assert!(widest < 1.12 && khz(teeth) > 1.3 * khz(teeth - 1), "{}: {widest}", mesh.name);
    }
}

#[test]
fn divergence_names_time_body_and_quantity() {
    let scene = scene("oh58_3p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut set = set(&scene, &bodies, standing(5e-6));
    set.rest(TORQUE).unwrap();
    // A lateral force of 1e10 N on the sun.
    let sun = set.races().of(Body::Sun, Axis::First).unwrap();
    set.external[sun] = 1e10;
    let said = (0..200).find_map(|_| set.step().err()).unwrap().to_string();
    assert!(said.contains(" s the ") && said.contains("displacement"), "{said}");
}

#[test]
fn what_cannot_run_is_refused_with_its_key() {
    let mut scene = scene("oh58_3p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let refused = |scene: &Scene, rotation| {
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let made = VibratingSet::new(scene, &bodies, sense, none, rotation, loading(1e4));
        made.err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert!(refused(&scene, turning(7)).contains("dynamics.steps_per_cycle"));
    assert!(refused(&scene, standing(0.0)).contains("step"));
    assert!(refused(&scene, standing(f64::NAN)).contains("step"));
    let still = NominalRotation::Turning {
        mesh_frequency: 0.0,
        steps_per_cycle: 140,
        direction: PathDirection::Forward,
    };
    assert!(refused(&scene, still).contains("operation.speed_rpm"));
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        scene.damping.stiffness_proportional_s = bad;
        assert!(refused(&scene, standing(5e-6)).contains("damping.stiffness_proportional_s"));
    }
}

/// Without torque no flanks touch, the set does not move, and it cannot be linearised but on its supports alone.
#[test]
fn without_torque_nothing_touches() {
    let scene = scene("oh58_3p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let unloaded = Loading { torque_nm: 0.0, mesh_force: 8e3 };
    let made = VibratingSet::new(&scene, &bodies, sense, none, standing(5e-6), unloaded);
    let mut set = made.unwrap();
    set.rest(0.0).unwrap();
    for _ in 0..10 {
        set.step().unwrap();
    }
    assert!(set.motion().x.iter().all(|x| x.abs() < 1e-15));
    assert!(set.linearised().unwrap_err().to_string().contains("no mesh touches"));
    let free = set.tangent().unwrap();
    let meshes = free.stiffness() - &free.supports;
    assert!(meshes.amax() < 1e-12 * free.supports.amax(), "{:e}", meshes.amax());
}

/// A reversed torque drives the sun through the backlash onto the backside flanks, from which it
/// returns.
#[test]
fn a_sun_thrown_back_meets_the_other_flanks() {
    let scene = scene("oh58_3p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    // Grids wide enough for the force of the impact.
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let mut set =
        VibratingSet::new(&scene, &bodies, sense, none, standing(5e-6), loading(4e4)).unwrap();
    set.rest(TORQUE).unwrap();
    let turning = set.races().of(Body::Sun, Axis::Rotation).unwrap();
    let steady = set.external[turning];
    set.external[turning] = -0.5 * steady;
    let start = set.motion().x[turning];
    let path: Vec<f64> = (0..400)
        .map(|_| {
            set.step().unwrap();
            set.motion().x[turning]
        })
        .collect();
    assert!(set.counts.with_backside > 0);
    // It oscillates about its equilibrium under the reversed torque, on the other side of both
    // backlashes (0.2 mm along the line of action), and returns.
    let backlash = 2.0 * bodies.geometry.normal_backlash(gearset::MeshKind::SunPlanet).unwrap();
    let (lowest, at) =
        path.iter().zip(0..).fold((0.0, 0), |a, x| if *x.0 < a.0 { (*x.0, x.1) } else { a });
    let middle = -0.5 * start - backlash;
    assert!(lowest < middle && lowest > 2.0 * middle - start - backlash, "{lowest:e} {middle:e}");
    assert!(path[at..].iter().any(|x| *x > middle), "it stays");
}

/// A clockwise torque on the mirrored set gives the mirrored motion, with and without gyroscopic
/// terms.
#[test]
fn a_mirrored_set_under_reversed_torque_moves_as_the_mirror() {
    let mut scene = scene("oh58_4p", Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let run = |scene: &Scene, sense| {
        let none = Imperfections::default();
        let rotation = turning(28);
        let mut set =
            VibratingSet::new(scene, &bodies, sense, none, rotation, loading(8e3)).unwrap();
        set.rest(TORQUE).unwrap();
        for _ in 0..56 {
            set.step().unwrap();
        }
        set.displacements().0[2]
    };
    let mut paths = Vec::new();
    for gyroscopic in [false, true] {
        scene.dynamics.gyroscopic = gyroscopic;
        let mut mirrored = scene.clone();
        mirrored.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
        if let Some(steps) = &mut mirrored.planets.steps {
            steps.iter_mut().for_each(|s| *s = -*s);
        }
        let one = run(&scene, Facing::CounterClockwise);
        let other = run(&mirrored, Facing::Clockwise);
        let across = one[0].hypot(one[1]);
        let off = (one[0] - other[0]).hypot(one[1] + other[1]);
        assert!(off < 1e-9 * across, "gyroscopic {gyroscopic}: {off:e} of {across:e}");
        assert!((one[2] + other[2]).abs() < 1e-9 * one[2].abs());
        paths.push(one);
    }
    let [still, turning] = [paths[0], paths[1]];
    let moved = (still[0] - turning[0]).hypot(still[1] - turning[1]);
    // The gyroscopic terms change the motion by far more than the tolerance above.
    assert!(moved > 1e-2 * still[0].hypot(still[1]), "gyroscopic terms: {moved:e}");
}

/// Flexibility factors apply equally to the meshes in equilibrium, in motion, in the linearisation
/// and in the damping.
#[test]
fn a_set_with_softer_meshes_is_one_set_at_rest_and_in_motion() {
    let mut soft = scene("oh58_3p", Fidelity::QuasiStatic);
    let factors = &mut soft.fe_contact.flexibility_factor;
    (factors.sun_planet, factors.ring_planet) = (1.9, 2.6);
    let mut bodies = Bodies::new(&soft).unwrap();
    let mut set = set(&soft, &bodies, standing(5e-6));
    set.rest(TORQUE).unwrap();
    let start = set.motion().x.clone();
    let size = start.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    for _ in 0..12 {
        set.step().unwrap();
    }
    for (x, y) in set.motion().x.iter().zip(&start) {
        assert!((x - y).abs() < 1e-9 * size, "{x} {y}");
    }
    // βK acts on the softer flexibility: damping stays proportional, except for the half-planes.
    let (alpha, beta) = (142.9, 2.21e-6);
    let linear = undamped_turning_left_out(set.linearised().unwrap());
    for mode in linear.damped().unwrap().iter().take(8) {
        let omega = std::f64::consts::TAU * mode.frequency_hz;
        let share = mode.damping_ratio / (0.5 * (alpha / omega + beta * omega));
        assert!(share > 0.97 && share < 1.001, "{}: {share}", mode.frequency_hz);
    }
    drop(set);
    bodies.settings.input.flexibility_factor.sun_planet = 1.0;
    for fidelity in [Fidelity::Modal(2), Fidelity::Full] {
        soft.dynamics.fidelity = fidelity;
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let made = VibratingSet::new(&soft, &bodies, sense, none, standing(5e-6), loading(8000.0));
        let refused = made.unwrap_err().to_string();
        assert!(refused.contains("fe_contact.flexibility_factor.ring_planet"), "{refused}");
    }
}

/// Mass and inertia added to the planets' races appear in the masses and do not change the
/// equilibrium.
#[test]
fn added_mass_rides_on_the_planets_races() {
    let plain = scene("oh58_3p", Fidelity::QuasiStatic);
    let mut heavy = plain.clone();
    heavy.supports.planet_added.mass_kg = 0.25;
    heavy.supports.planet_added.inertia_kg_m2 = 2e-3;
    let bodies = Bodies::new(&plain).unwrap();
    let mut sets = [&plain, &heavy].map(|s| set(s, &bodies, standing(5e-6)));
    for set in &mut sets {
        set.rest(TORQUE).unwrap();
    }
    let [light, laden] = sets;
    assert_eq!(light.motion().x, laden.motion().x);
    let radius = bodies.geometry.planet.base_radius;
    let more: Vec<f64> = laden.masses().iter().zip(light.masses()).map(|(a, b)| a - b).collect();
    let turning = 2e-3 / (radius * radius);
    let count = |value: f64| more.iter().filter(|m| (*m - value).abs() < 1e-12).count();
    assert_eq!((count(0.25), count(turning), count(0.0)), (6, 3, more.len() - 9));
}
