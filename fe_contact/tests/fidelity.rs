//! Every level of fidelity runs with every kind of set; full bodies move as quasi-static ones do.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use fe_contact::vibration::{Loading, NominalRotation, VibratingSet};
use gearset::{Facing, PathDirection};
use scene::{Fidelity, Freedom, Scene, Torsional};

const TORQUE: f64 = 1130.0;

/// A scene with a coarse FE mesh, which suffices: no statement tested here depends on it.
fn scene(name: &str, flank_elements: u32) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = flank_elements;
    scene
}

/// A set turning at its scene's speed, at rest under the torque.
fn turning<'b>(scene: &Scene, bodies: &'b Bodies, steps_per_cycle: usize) -> VibratingSet<'b> {
    let sun = bodies.geometry.sun.as_ref().unwrap();
    let force = TORQUE / scene.planets.count() as f64 / sun.base_radius;
    let mesh_frequency = scene.kinematics().unwrap().mesh_frequency_hz;
    let rotation = NominalRotation::Turning {
        mesh_frequency,
        steps_per_cycle,
        direction: PathDirection::Forward,
    };
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let loading = Loading { torque_nm: TORQUE, mesh_force: force };
    let mut set = VibratingSet::new(scene, bodies, sense, none, rotation, loading).unwrap();
    set.rest(TORQUE).unwrap();
    set
}

/// A few steps at every fidelity: displacements are finite, and every mesh carries force. At the
/// start the forces of the sun meshes balance the torque.
fn every_fidelity_turns(mut scene: Scene) {
    let bodies = Bodies::new(&scene).unwrap();
    let radius = bodies.geometry.sun.as_ref().unwrap().base_radius;
    let planets = scene.planets.count();
    let mut forces = Vec::new();
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(2), Fidelity::Full] {
        scene.dynamics.fidelity = fidelity;
        let mut set = turning(&scene, &bodies, 16);
        assert_eq!(set.elastic_unknowns() == 0, fidelity == Fidelity::QuasiStatic);
        set.mesh_forces(&mut forces);
        // Corner contacts have moment arms other than the base radius: a difference of 0.09 % was
        // observed with four planets.
        let carried = radius * forces[..planets].iter().sum::<f64>();
        assert!((carried - TORQUE).abs() < 2e-3 * TORQUE, "{fidelity:?}: {carried} N m");
        for step in 1..=3 {
            set.step().unwrap();
            let (central, planet) = set.displacements();
            let mut moves = central.iter().chain(&planet).flatten();
            assert!(moves.all(|x| x.is_finite()), "{fidelity:?}, step {step}");
            set.mesh_forces(&mut forces);
            assert_eq!(forces.len(), 2 * planets, "{fidelity:?}, step {step}: backside flanks");
            assert!(forces.iter().all(|p| *p > 0.0), "{fidelity:?}, step {step}: {forces:?}");
        }
    }
}

#[test]
fn three_planets() {
    every_fidelity_turns(scene("oh58_3p", 8));
}

#[test]
#[ignore = "long: .ci/full runs it"]
fn four_planets() {
    every_fidelity_turns(scene("oh58_4p", 8));
}

#[test]
#[ignore = "long: .ci/full runs it"]
fn four_planets_of_best_thickness() {
    every_fidelity_turns(scene("oh58_4p_best_thickness", 8));
}

#[test]
fn a_ring_on_springs_and_a_rigid_carrier() {
    let mut scene = scene("oh58_3p", 6);
    let ring = &mut scene.supports.ring;
    ring.motion = Freedom::Free;
    ring.bearing_n_per_m = 200e6;
    ring.torsional = Torsional::PerLength(500e6);
    scene.geometry.as_mut().unwrap().carrier.as_mut().unwrap().is_rigid = true;
    every_fidelity_turns(scene);
}

#[test]
fn a_carrier_without_shape() {
    let mut scene = scene("oh58_4p", 6);
    scene.geometry.as_mut().unwrap().carrier = None;
    every_fidelity_turns(scene);
}

/// After release from rest the sun rotates by some tenths of a µm at its base radius. With full and
/// quasi-static bodies the rotation differs by 9 nm rms, a thousandth of its range over the mesh
/// cycle at rest. The difference oscillates in the modes above 8 kHz that the mesh stiffness
/// governs: elastic inertia changes their frequencies by a few percent, and 28 steps per cycle do
/// not resolve them.
#[test]
fn full_bodies_turn_as_quasi_static_ones() {
    let mut scene = scene("oh58_3p", 8);
    let bodies = Bodies::new(&scene).unwrap();
    let mut run = |fidelity| {
        scene.dynamics.fidelity = fidelity;
        let mut set = turning(&scene, &bodies, 28);
        let (mut rotations, mut forces, mut now) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..12 {
            set.step().unwrap();
            rotations.push(set.displacements().0[2][2]);
            set.mesh_forces(&mut now);
            forces.extend_from_slice(&now);
        }
        (rotations, forces)
    };
    let (quasi, full) = (run(Fidelity::QuasiStatic), run(Fidelity::Full));
    let square = |list: &[f64]| list.iter().map(|x| x * x).sum::<f64>().sqrt();
    let apart: Vec<f64> = quasi.0.iter().zip(&full.0).map(|(a, b)| a - b).collect();
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let at_rest = StaticSet::new(&scene, &bodies, sense, none).unwrap();
    let at_rest = at_rest.cycle(TORQUE, 28, &ActiveSet).unwrap().states;
    let turned = at_rest.iter().map(|s| s.central[2][2]);
    let range = turned.clone().fold(f64::MIN, f64::max) - turned.fold(f64::MAX, f64::min);
    let share = square(&apart) / (apart.len() as f64).sqrt() / range;
    assert!(share < 2e-3, "rotation of the sun: {share}");
    let off = quasi.1.iter().zip(&full.1).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 0.006, "forces: {off}");
}

/// Natural frequencies between 6.9 and 15.3 kHz, which the mesh stiffness governs, are 2 to 5 % lower with quasi-static
/// bodies than with 30 modes a body.
#[test]
#[ignore = "long: .ci/full runs it"]
fn quasi_static_bodies_lower_the_modes_that_meshes_govern() {
    let mut scene = scene("oh58_4p", 8);
    let bodies = Bodies::new(&scene).unwrap();
    let mut modes_at = |fidelity: Fidelity| {
        scene.dynamics.fidelity = fidelity;
        let linear = turning(&scene, &bodies, 140).linearised().unwrap();
        let (frequencies, shapes) = linear.undamped().unwrap();
        let races = linear.races;
        let mass = linear.mass.view((0, 0), (races, races)).into_owned();
        (frequencies, shapes.rows(0, races).into_owned(), mass)
    };
    let (coarse, of_coarse, mass) = modes_at(Fidelity::QuasiStatic);
    let (fine, of_fine, _) = modes_at(Fidelity::Modal(30));
    let governed = coarse.iter().enumerate().filter(|(_, f)| (6.8e3..15.4e3).contains(*f));
    let mut count = 0;
    for (i, frequency) in governed {
        // Share of the races' motion in common: (aᵀMb)²/(aᵀMa bᵀMb).
        let shape = of_coarse.column(i);
        let in_common = |j: usize| {
            let (a, b) = (&mass * shape, of_fine.column(j));
            a.dot(&b).powi(2) / (a.dot(&shape) * (&mass * b).dot(&b))
        };
        let all = (0..fine.len()).map(|j| (in_common(j), fine[j]));
        let (share, same) = all.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        assert!(share > 0.99, "{frequency} Hz has no counterpart: {share}");
        let low = 1.0 - frequency / same;
        assert!((0.015..0.055).contains(&low), "{frequency} Hz is {low} below {same} Hz");
        count += 1;
    }
    assert_eq!(count, 8);
}
