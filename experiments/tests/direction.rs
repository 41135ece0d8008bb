//! Every machine turns its own way: which members drive and are held, driving and braking, decide in which direction meshes
//! run along the path of contact.

mod shipped;

use std::f64::consts::TAU;

use experiments::sweep::{
    Coordinate, Direction, FeModel, Memory, Part, Plan, SteadySettings, SweepModel, SweepPoint, run,
};
use fe_contact::statics::{Bodies, Imperfections};
use gearset::{LoadCase, Member, PathDirection, Scene};

/// Driver, held member and the direction while driving.
const MACHINES: [(Member, Member, PathDirection); 6] = [
    (Member::Sun, Member::Ring, PathDirection::Forward),
    (Member::Sun, Member::Carrier, PathDirection::Forward),
    (Member::Carrier, Member::Ring, PathDirection::Backward),
    (Member::Carrier, Member::Sun, PathDirection::Forward),
    (Member::Ring, Member::Carrier, PathDirection::Backward),
    (Member::Ring, Member::Sun, PathDirection::Backward),
];

/// Largest and smallest torque of the cases, on the sun, N m.
const SUN_NM: f64 = 1130.0;

/// OH-58 with four planets as a machine that turns at a mesh frequency, with its torque and speed in given senses; rotations
/// are held where the catalogue holds them, or of the two members that no torque drives.
fn machine(driver: Member, held: Member, [speed, torque]: [f64; 2]) -> (Scene, LoadCase) {
    let mut scene = shipped::scene("oh58_4p", 56, 1.0);
    scene.fe_contact.flank_elements = 6;
    let operation = scene.operation.as_mut().unwrap();
    (operation.input, operation.fixed) = (driver, held);
    (operation.speed_rpm, operation.torque_nm) = (speed, torque);
    let case = LoadCase::of_scene(&scene).unwrap();
    let sun_nm = SUN_NM * case.sun_torque_nm.signum();
    (scene, case.with_sun_torque(sun_nm))
}

fn at(model: &dyn SweepModel, mesh_hz: f64) -> SweepPoint {
    let rpm = mesh_hz / model.case().mesh_frequency_per_rpm_hz();
    let steady = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan::new(&[rpm], &[Direction::Up], steady).unwrap();
    let swept = run(model, &plan, &Memory, &|_| ()).unwrap().complete().unwrap();
    swept.points()[0].clone()
}

/// First harmonics of the sun meshes, cycles after that of planet 0.
fn order(point: &SweepPoint) -> Vec<f64> {
    let phase = |n: usize| {
        point.state.line(Part::SunMesh(n), Coordinate::Force, 1).unwrap().phase_rad / TAU
    };
    (0..4).map(|n| (phase(n) - phase(0)).rem_euclid(1.0)).collect()
}

/// The order of the first harmonics of sun-mesh forces follows −σ Z_s ψ_n/2π for every driver, held member, sense of rotation
/// and of torque; the flanks follow the torque alone.
#[test]
fn sun_meshes_come_in_the_order_in_which_their_planets_pass() {
    for (driver, held, driving) in MACHINES {
        for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            let (scene, case) = machine(driver, held, [100.0 * signs[0], 300.0 * signs[1]]);
            let bodies = Bodies::new(&scene).unwrap();
            let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
            let point = at(&model, 200.0);
            let sigma = case.sun_turns.sign();
            let is_driving = signs[0] * signs[1] > 0.0;
            assert_eq!(case.direction() == driving, is_driving);
            let found = order(&point);
            for (n, (found, psi)) in found.iter().zip(&scene.planets.psi_rad).enumerate() {
                let expected = -sigma * 27.0 * psi / TAU;
                let off = (found - expected + 0.5).rem_euclid(1.0) - 0.5;
                assert!(
                    off.abs() < 0.03,
                    "{driver:?} drives, {held:?} held, {signs:?}: planet {n} at {found}, expected {}",
                    expected.rem_euclid(1.0)
                );
            }
            // The sun is wound up in the sense of its torque.
            let windup = point.state.line(Part::Sun, Coordinate::Rotation, 0).unwrap();
            let sense = windup.amplitude * windup.phase_rad.cos();
            assert!(sense * case.sun_torque_nm > 0.0);
        }
    }
}
