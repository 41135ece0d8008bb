//! Sets on tabulated mesh forces against the quasi-static fidelity, which solves contact.

use std::f64::consts::TAU;
use std::time::Instant;

use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use fe_contact::vibration::{
    Loading, MeshLawSet, MeshLawSettings, NominalRotation, VibratingSet, mesh_law,
};
use gearset::{Facing, FlankSide, PathDirection};
use scene::{Fidelity, Scene};

const TORQUE: f64 = 1413.0;

/// Loading with contact tables laid out for a force (N) of each mesh.
fn loading(mesh_force: f64) -> Loading {
    Loading { torque_nm: TORQUE, mesh_force }
}

const FREQUENCY: f64 = 565.714;
const STEPS: usize = 140;

fn scene(name: &str) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    // A coarse FE mesh suffices: no statement tested here depends on it.
    scene.fe_contact.flank_elements = 8;
    scene
}

fn force(scene: &Scene, bodies: &Bodies) -> f64 {
    TORQUE / scene.planets.count() as f64 / bodies.geometry.sun.as_ref().unwrap().base_radius
}

/// Amplitudes of harmonics 0 to 5 as complex numbers.
fn harmonics(record: &[f64]) -> Vec<[f64; 2]> {
    let n = record.len() as f64;
    let of = |h: usize| {
        let mut sum = [0.0; 2];
        for (i, x) in record.iter().enumerate() {
            let (sin, cos) = (TAU * (h * i) as f64 / n).sin_cos();
            sum = [sum[0] + x * cos, sum[1] - x * sin];
        }
        let scale = if h == 0 { 1.0 / n } else { 2.0 / n };
        sum.map(|s| scale * s)
    };
    (0..=5).map(of).collect()
}

fn size(z: [f64; 2]) -> f64 {
    z[0].hypot(z[1])
}

/// Sun rotation and the forces of all front meshes over the last of `cycles` mesh cycles.
fn record(cycles: usize, mut step: impl FnMut(&mut Vec<f64>)) -> Vec<Vec<f64>> {
    let mut row = Vec::new();
    (0..(cycles - 1) * STEPS).for_each(|_| step(&mut row));
    let mut list = vec![Vec::new(); 9];
    for _ in 0..STEPS {
        step(&mut row);
        list.iter_mut().zip(&row).for_each(|(list, x)| list.push(*x));
    }
    list
}

#[test]
fn harmonics_are_those_of_the_quasi_static_fidelity() {
    let scene = scene("oh58_4p");
    let bodies = Bodies::new(&scene).unwrap();
    let (sense, force) = (Facing::CounterClockwise, force(&scene, &bodies));
    let start = Instant::now();
    let law = mesh_law(&scene, &bodies, sense, STEPS, &MeshLawSettings::at(TORQUE)).unwrap();
    println!(
        "law: {} curves, {:.1} kB, damped shares {:.4} and {:.4}, made in {:.2} s",
        law.curves().len(),
        law.bytes() as f64 / 1e3,
        law.damping_share(0),
        law.damping_share(4),
        start.elapsed().as_secs_f64()
    );
    let mut fast = MeshLawSet::new(&scene, &bodies, sense, FREQUENCY, TORQUE, law).unwrap();
    fast.rest(TORQUE).unwrap();
    let rotation = NominalRotation::Turning {
        mesh_frequency: FREQUENCY,
        steps_per_cycle: STEPS,
        direction: PathDirection::Forward,
    };
    let none = Imperfections::default();
    let mut full =
        VibratingSet::new(&scene, &bodies, sense, none, rotation, loading(force)).unwrap();
    full.rest(TORQUE).unwrap();
    // The sun has the same rotation in equilibrium.
    let (a, b) = (fast.displacements().0[2][2], full.displacements().0[2][2]);
    println!("sun's rotation at rest: {a:.6e} and {b:.6e} rad, {:.2e} apart", (a / b - 1.0).abs());
    assert!((a / b - 1.0).abs() < 2e-3);
    let one = record(60, |row| {
        fast.step().unwrap();
        fast.mesh_forces(row);
        row.truncate(8);
        row.insert(0, fast.displacements().0[2][2]);
    });
    assert!(fast.is_within_tables());
    let two = record(60, |row| {
        full.step().unwrap();
        full.mesh_forces(row);
        row.truncate(8);
        row.insert(0, full.displacements().0[2][2]);
    });
    let time = |step: &mut dyn FnMut()| {
        let start = Instant::now();
        (0..100 * STEPS).for_each(|_| step());
        start.elapsed().as_nanos() as f64 / (100 * STEPS) as f64
    };
    let (ours, theirs) = (time(&mut || fast.step().unwrap()), time(&mut || full.step().unwrap()));
    println!(
        "a step: {ours:.0} ns and {theirs:.0} ns, ratio {:.1}; {:.2} iterations",
        theirs / ours,
        fast.counts().0
    );
    for (k, (one, two)) in one.iter().zip(&two).enumerate() {
        let name = match k {
            0 => "sun rotation".to_owned(),
            1..5 => format!("sun mesh {}", k - 1),
            _ => format!("ring mesh {}", k - 5),
        };
        let (one, two) = (harmonics(one), harmonics(two));
        let largest = two[1..].iter().map(|z| size(*z)).fold(0.0, f64::max);
        for h in 0..=5 {
            let apart = size([one[h][0] - two[h][0], one[h][1] - two[h][1]]);
            let scale = if h == 0 { size(two[0]) } else { largest };
            println!(
                "{name}, harmonic {h}: {:.5e} and {:.5e}, {:.2e} of the largest apart",
                size(one[h]),
                size(two[h]),
                apart / scale
            );
            assert!(apart / scale < if h == 0 { 2e-3 } else { 0.15 }, "{name}, harmonic {h}");
            // The second harmonic is near a resonance, and the mesh law gives it 8.3 % low, with 140 and 280 steps
            // and with 40 and 80 contact cells alike: an error of the law itself, between 7.5 and 9.5 % until that
            // changes. About half of this is due to the side loads, which depend on the vibration with contact but on
            // the position only with the mesh law; half to the lag of βK, which acts on each pair with contact but on
            // the mesh as a whole with the mesh law.
            if k == 0 {
                let low = (size(two[h]) - size(one[h])) / largest.max(size(two[h]));
                assert!(
                    if h == 2 { (0.075..0.095).contains(&low) } else { low.abs() < 0.08 },
                    "{low}"
                );
            }
        }
    }
}

/// Tables computed twice are equal, and have front and backside flanks with the expected first
/// contact.
#[test]
fn laws_are_deterministic_and_have_both_flanks() {
    let scene = scene("oh58_3p");
    let bodies = Bodies::new(&scene).unwrap();
    let settings = MeshLawSettings { nodes: 8, ..MeshLawSettings::at(TORQUE) };
    let make = || mesh_law(&scene, &bodies, Facing::CounterClockwise, 28, &settings).unwrap();
    let law = make();
    assert_eq!(law, make());
    for mesh in 0..6 {
        let front = law.first_contact_m(mesh, FlankSide::Front).unwrap();
        let backside = law.first_contact_m(mesh, FlankSide::Backside).unwrap();
        // Corner contacts may begin before the mesh has a deflection.
        assert!((-6e-6..0.2e-6).contains(&front), "{front:e}");
        assert!((70e-6..100e-6).contains(&backside), "{backside:e}");
        assert!((0.3..1.0).contains(&law.damping_share(mesh)));
        // The tables reach three times the mean force, and at most 3 % more.
        for step in 0..28 {
            let curve = law.front(mesh, step);
            let largest = curve.force(curve.end_m()).0;
            assert!((1.0..1.03).contains(&(largest / (3.0 * force(&scene, &bodies)))));
        }
    }
}

/// A run that is resumed from a stored state gives exactly the same motion, and a torque of the
/// opposite sense the opposite rotation of the sun.
#[test]
fn both_senses_and_resumed_runs_agree() {
    let scene = scene("oh58_3p");
    let bodies = Bodies::new(&scene).unwrap();
    let settings = MeshLawSettings { nodes: 16, ..MeshLawSettings::at(TORQUE) };
    let run = |sense| {
        let law = mesh_law(&scene, &bodies, sense, 28, &settings).unwrap();
        let mut set = MeshLawSet::new(&scene, &bodies, sense, FREQUENCY, TORQUE, law).unwrap();
        set.rest(TORQUE).unwrap();
        (0..100).for_each(|_| set.step().unwrap());
        let state = set.state().clone();
        (0..50).for_each(|_| set.step().unwrap());
        let end = set.motion();
        set.set_state(&state).unwrap();
        (0..50).for_each(|_| set.step().unwrap());
        assert_eq!(end, set.motion());
        set.displacements().0[2][2]
    };
    let (ccw, cw) = (run(Facing::CounterClockwise), run(Facing::Clockwise));
    assert!(ccw > 0.0 && (ccw + cw).abs() < 1e-9 * ccw);
}

#[test]
fn contact_is_not_solved_on_this_fidelity() {
    let mut scene = scene("oh58_3p");
    scene.dynamics.fidelity = Fidelity::MeshLaw;
    let bodies = Bodies::new(&scene).unwrap();
    let rotation = NominalRotation::Standing { position: 0.0, step: 1e-5 };
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading(1e4));
    assert!(matches!(set.map(|_| ()), Err(FeError::NoContact)));
    let unfit = MeshLawSettings::at(-1.0);
    let law = mesh_law(&scene, &bodies, sense, 28, &unfit);
    assert!(matches!(law, Err(FeError::Unfit { .. })));
}

/// Equilibrium over a mesh cycle against contact solved for all pairs: sun rotation, mesh forces.
#[test]
fn statics_are_those_of_contact() {
    let scene = scene("oh58_4p");
    let bodies = Bodies::new(&scene).unwrap();
    let sense = Facing::CounterClockwise;
    // Grids of about the size of those in statics, with which it is compared: larger grids have
    // wider cells.
    let settings = MeshLawSettings { reach: 1.3, ..MeshLawSettings::at(TORQUE) };
    let law = mesh_law(&scene, &bodies, sense, 28, &settings).unwrap();
    let mut fast = MeshLawSet::new(&scene, &bodies, sense, FREQUENCY, TORQUE, law).unwrap();
    let statics = StaticSet::new(&scene, &bodies, sense, Imperfections::default()).unwrap();
    let cycle = statics.cycle(TORQUE, 28, &ActiveSet).unwrap();
    let exact: Vec<f64> = cycle.states.iter().map(|s| s.central[2][2]).collect();
    let range = exact.iter().fold(0.0f64, |a, x| a.max(*x))
        - exact.iter().fold(f64::INFINITY, |a, x| a.min(*x));
    let nil = vec![0.0; fast.races().count];
    let (mut worst, mut worst_force, mut row) = (0.0f64, 0.0f64, Vec::new());
    for (i, state) in cycle.states.iter().enumerate() {
        fast.set_motion(i, &nil, &nil).unwrap();
        fast.rest(TORQUE).unwrap();
        worst = worst.max((fast.displacements().0[2][2] - exact[i]).abs() / range);
        fast.mesh_forces(&mut row);
        for (mesh, force) in state.meshes.iter().zip(&row) {
            worst_force = worst_force.max((force / mesh.force - 1.0).abs());
        }
    }
    println!("static transmission error {worst:.2e} of its range apart, forces {worst_force:.2e}");
    // The mesh law counts forces along the line of action, statics along each pair's own normal.
    assert!(worst < 0.015 && worst_force < 0.01);
}
