//! Every machine turns its own way: which members drive and are held, driving and braking, decide in which
//! direction meshes run along the path of contact.

use crate::shipped;

use std::f64::consts::TAU;

use experiments::sweep::{
    Coordinate, Direction, FeModel, Memory, MeshLawModel, Part, Plan, SteadySettings, SweepModel,
    SweepPoint, naturals, run,
};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Member, PathDirection};
use lumped::ModeType;
use scene::{LoadCase, Scene};

/// Driver, held member and the direction while driving.
const MACHINES: [(Member, Member, PathDirection); 6] = [
    (Member::Sun, Member::Ring, PathDirection::Forward),
    (Member::Sun, Member::Carrier, PathDirection::Forward),
    (Member::Carrier, Member::Ring, PathDirection::Backward),
    (Member::Carrier, Member::Sun, PathDirection::Forward),
    (Member::Ring, Member::Carrier, PathDirection::Backward),
    (Member::Ring, Member::Sun, PathDirection::Backward),
];

/// Magnitude of the torque on the sun, N m.
const SUN_NM: f64 = 1130.0;

/// OH-58 with four planets as a machine with its speed and torque in given senses. The torque acts on a member
/// that turns, the other two are held.
fn machine_loaded_at(
    loaded: Member,
    (driver, held): (Member, Member),
    [speed, torque]: [f64; 2],
) -> (Scene, LoadCase) {
    use scene::Freedom::{Free, RotationHeld};
    let mut scene = shipped::scene("oh58_4p", 56, 1.0);
    scene.fe_contact.flank_elements = 6;
    let supports = &mut scene.supports;
    supports.ring.bearing_n_per_m = supports.sun.bearing_n_per_m;
    for (member, support) in [
        (Member::Sun, &mut supports.sun),
        (Member::Ring, &mut supports.ring),
        (Member::Carrier, &mut supports.carrier),
    ] {
        support.motion = if member == loaded { Free } else { RotationHeld };
    }
    let operation = scene.operation.as_mut().unwrap();
    (operation.input, operation.fixed) = (driver, held);
    (operation.speed_rpm, operation.torque_nm) = (speed, torque);
    let case = LoadCase::of_scene(&scene).unwrap();
    let sun_nm = SUN_NM * case.sun_torque_nm.signum();
    assert_eq!(scene.loaded_member(), Ok(loaded));
    (scene, case.with_sun_torque(sun_nm))
}

/// The same, loaded at its driver.
fn machine(driver: Member, held: Member, signs: [f64; 2]) -> (Scene, LoadCase) {
    machine_loaded_at(driver, (driver, held), signs)
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

/// The order of the first harmonics of sun-mesh forces follows −σ Z_s ψ_n/2π for every driver, held member, sense
/// of rotation and of torque; the flanks follow the torque alone.
#[test]
#[ignore = "long: .ci/full runs it"]
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
            // The loaded member is wound up in the sense of its torque.
            let (part, torque) = match driver {
                Member::Sun => (Part::SUN, case.sun_torque_nm),
                Member::Ring => (Part::RING, case.sun_torque_nm),
                Member::Carrier => (Part::CARRIER, -case.sun_torque_nm),
            };
            assert!(case.input_torque_nm * torque > 0.0);
            let windup = point.state.line(part, Coordinate::Rotation, 0).unwrap();
            assert!(windup.amplitude * windup.phase_rad.cos() * torque > 0.0);
        }
    }
}

/// Displacements and mesh forces at the ends of the steps of some cycles from rest.
fn marched(scene: &Scene, case: LoadCase, mesh_hz: f64) -> Vec<(Vec<[f64; 3]>, Vec<f64>)> {
    let bodies = Bodies::new(scene).unwrap();
    let model = FeModel::new(scene, &bodies, Imperfections::default(), case);
    let rpm = mesh_hz / case.mesh_frequency_per_rpm_hz();
    let mut set = model.turning(&case.at_speed(rpm), 0).unwrap();
    set.rest().unwrap();
    let step = |_| {
        set.step().unwrap();
        let (central, planets) = set.displacements();
        let mut forces = Vec::new();
        set.mesh_forces(&mut forces);
        (central.into_iter().chain(planets).collect(), forces)
    };
    (0..3 * 56).map(step).collect()
}

/// The mirror image of a machine, planets, speed and torque reversed, moves as its mirror image, bit for bit.
#[test]
fn mirror_images_pair_up() {
    for (driver, held, _) in MACHINES {
        for torque in [300.0, -300.0] {
            let (scene, case) = machine(driver, held, [100.0, torque]);
            let (mut mirrored, other) = machine(driver, held, [-100.0, -torque]);
            mirrored.planets.psi_rad.iter_mut().for_each(|psi| *psi *= -1.0);
            if let Some(steps) = &mut mirrored.planets.steps {
                steps.iter_mut().for_each(|step| *step *= -1);
            }
            assert_eq!(case.direction(), other.direction());
            let pairs =
                marched(&scene, case, 700.0).into_iter().zip(marched(&mirrored, other, 700.0));
            for ((x, forces), (image, of_image)) in pairs {
                assert_eq!(forces, of_image);
                for ([a, b, c], [x, y, z]) in x.into_iter().zip(image) {
                    assert_eq!([a, b, c], [x, -y, -z]);
                }
            }
        }
    }
}

/// A set driven through the carrier against a held ring is the same set braked through its sun.
#[test]
fn driving_through_the_carrier_is_braking_through_the_sun() {
    let of = |driver, signs| machine_loaded_at(Member::Sun, (driver, Member::Ring), signs);
    let (scene, driven) = of(Member::Carrier, [100.0, 300.0]);
    let (_, braked) = of(Member::Sun, [100.0, -300.0]);
    assert!(driven.sun_torque_nm < 0.0 && driven.direction() == PathDirection::Backward);
    let [a, b] = [driven, braked].map(|case| marched(&scene, case, 700.0));
    assert!(a == b);
    // Driving through the sun under the same torque is another motion.
    let (_, other) = of(Member::Sun, [-100.0, -300.0]);
    assert!(a != marched(&scene, other, 700.0));
}

/// Where nothing vibrates, a set that runs backward is at every instant as the set that runs forward is in the
/// same position.
#[test]
fn slow_sets_pass_the_same_positions_in_reverse() {
    let of = |speed: f64| {
        let (mut scene, case) = machine(Member::Sun, Member::Ring, [speed, 300.0]);
        scene.dynamics.steps_per_cycle = 280;
        let bodies = Bodies::new(&scene).unwrap();
        let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
        at(&model, 40.0)
    };
    let (forward, backward) = (of(100.0), of(-100.0));
    let largest = forward.state.amplitude(Part::SunMesh(0), Coordinate::Force, 1);
    for (mesh, harmonic) in (0..4).flat_map(|n| [1, 2, 3].map(|l| (n, l))) {
        for part in [Part::SunMesh(mesh), Part::RingMesh(mesh)] {
            let [a, b] = [&forward, &backward].map(|p| {
                let line = p.state.line(part, Coordinate::Force, harmonic).unwrap();
                [line.amplitude * line.phase_rad.cos(), line.amplitude * line.phase_rad.sin()]
            });
            // Time reversed: the conjugate.
            let off = (a[0] - b[0]).hypot(a[1] + b[1]);
            assert!(off < 0.02 * largest, "{part:?}, l = {harmonic}: {a:?} {b:?}");
        }
    }
}

/// Gyroscopic terms split the first translational mode as whirl and carrier turn: a whirl in the carrier's sense
/// appears slower in its frame. Of five planets with 27 sun teeth harmonic 2 whirls at −σ, the carrier turns at σ
/// with the ring held and at −σ with the sun held.
#[test]
#[ignore = "long: .ci/full runs it"]
fn gyroscopic_peaks_split_as_the_carrier_turns() {
    let peak = |driver: Member, held: Member, torque: f64, is_on: bool| {
        let mut scene = shipped::scene("five_planets", 60, 0.25);
        scene.fe_contact.flank_elements = 6;
        scene.dynamics.gyroscopic = is_on;
        let operation = scene.operation.as_mut().unwrap();
        (operation.input, operation.fixed) = (driver, held);
        (operation.speed_rpm, operation.torque_nm) = (100.0, torque);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let case = case.with_sun_torque(SUN_NM * case.sun_torque_nm.signum());
        let model = MeshLawModel::new(&scene, &bodies, case).unwrap();
        let mut linear = scene.clone();
        linear.dynamics.fidelity = scene::Fidelity::QuasiStatic;
        let found = naturals(&linear, &bodies, case).unwrap();
        let first = found.iter().find(|own| own.mode_type == ModeType::Translational);
        let hz = first.unwrap().frequency_hz;
        let height = |share: f64| {
            let point = at(&model, 0.5 * hz * share);
            let lines = point.state.with_translations();
            let mut lines = lines.into_iter();
            let is_own = |l: &experiments::sweep::Line| {
                l.part == Part::SUN && l.coordinate == Coordinate::Translation && l.harmonic == 2
            };
            lines.find(is_own).unwrap().amplitude
        };
        let mut best = (0.0, 0.0);
        for k in -12..=12 {
            let share = 1.0 + 0.0025 * f64::from(k);
            let own = height(share);
            if own > best.1 {
                best = (share, own);
            }
        }
        let [a, b, c] = [-1.0, 0.0, 1.0].map(|k| height(best.0 + 0.0025 * k).powi(-2));
        let share = best.0 + 0.0025 * 0.5 * (a - c) / (a - 2.0 * b + c);
        let speeds = scene.kinematics().unwrap();
        let carrier = speeds.speeds_rpm.carrier / speeds.mesh_frequency_hz / 60.0;
        // Peak, and the carrier's speed as part of it.
        (share * hz, 0.5 * carrier.abs())
    };
    let (still, _) = peak(Member::Sun, Member::Ring, 300.0, false);
    for (driver, held, torque, sign) in [
        (Member::Sun, Member::Ring, 300.0, 1.0),
        (Member::Sun, Member::Ring, -300.0, 1.0),
        (Member::Carrier, Member::Ring, 300.0, 1.0),
        (Member::Sun, Member::Carrier, 300.0, 0.0),
        (Member::Ring, Member::Sun, 300.0, -1.0),
        (Member::Carrier, Member::Sun, 300.0, -1.0),
    ] {
        let (found, carrier) = peak(driver, held, torque, true);
        let shift = (found / still - 1.0) / carrier.max(1e-3);
        println!("{driver:?} {held:?} {torque}: {found:.3} Hz, {shift:.3} of the carrier's speed");
        match sign {
            0.0 => assert!((found / still - 1.0).abs() < 1e-3),
            _ => assert!(sign * shift > 0.2 && sign * shift < 1.0, "{shift}"),
        }
    }
}

/// At rest it hardly matters which of the three members turns under the torque and which two react: mesh forces and the
/// transmission error by work are the same, and so are the mean torques on all members. Only where pairs touch at
/// corners, whose normals are no common tangents of the base circles, is the ratio of torques not that of the
/// teeth at every instant; the torque that is given is the one that is constant then.
#[test]
fn statics_are_the_same_whichever_member_turns() {
    use scene::Freedom::{Free, Held, RotationHeld};
    let cycle = |loaded: Member| {
        let mut scene = shipped::scene("oh58_4p", 28, 1.0);
        scene.fe_contact.flank_elements = 6;
        let supports = &mut scene.supports;
        // Central members stay where they are, so that only rotations differ.
        (supports.sun.motion, supports.ring.motion) = (RotationHeld, Held);
        supports.carrier.motion = RotationHeld;
        match loaded {
            Member::Sun => supports.sun.motion = Free,
            Member::Ring => (supports.ring.motion, supports.ring.bearing_n_per_m) = (Free, 1e15),
            Member::Carrier => supports.carrier.motion = Free,
        }
        let operation = scene.operation.as_mut().unwrap();
        (operation.fixed, operation.input) = match loaded {
            Member::Sun => (Member::Ring, Member::Sun),
            Member::Ring => (Member::Sun, Member::Ring),
            Member::Carrier => (Member::Sun, Member::Carrier),
        };
        assert_eq!(scene.loaded_member(), Ok(loaded));
        let bodies = Bodies::new(&scene).unwrap();
        let sense = gearset::Facing::CounterClockwise;
        let set = StaticSet::new(&scene, &bodies, sense, Imperfections::default()).unwrap();
        let radius = bodies.geometry.sun.as_ref().unwrap().base_radius;
        (set.cycle(SUN_NM, 56, &ActiveSet).unwrap(), radius)
    };
    let (of_sun, radius) = cycle(Member::Sun);
    let largest = of_sun.mesh_force(0).largest;
    for loaded in [Member::Ring, Member::Carrier] {
        let (found, _) = cycle(loaded);
        for (a, b) in of_sun.states.iter().zip(&found.states) {
            for (a, b) in a.meshes.iter().zip(&b.meshes) {
                assert!((a.force - b.force).abs() < 2e-3 * largest, "{loaded:?}: {a:?} {b:?}");
            }
            let [a, b] = [a, b].map(|state| state.transmission_error(radius));
            assert!((a / b - 1.0).abs() < 2e-3, "{loaded:?}: {a:e} {b:e}");
        }
        let [a, b] = [&of_sun, &found].map(|own| {
            [own.range(|s| s.reactions.carrier_nm).mean, own.range(|s| s.reactions.ring_nm).mean]
        });
        println!("{loaded:?}: {a:?} {b:?}");
        assert!((a[0] / b[0] - 1.0).abs() < 3e-4 && (a[1] / b[1] - 1.0).abs() < 3e-4);
        let willis = [SUN_NM * 126.0 / 27.0, -SUN_NM * 99.0 / 27.0];
        assert!(b.iter().zip(willis).all(|(b, willis)| (b / willis - 1.0).abs() < 3e-4));
    }
}
