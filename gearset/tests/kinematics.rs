//! Kinematics of planetary sets: OH-58, both mesh equations, power, frame shifts.

use std::f64::consts::TAU;
use std::path::Path;

use gearset::{Kinematics, KinematicsError, Member};
use scene::{Scene, SceneKind, excitation_of_scene};

const MEMBERS: [Member; 3] = [Member::Sun, Member::Ring, Member::Carrier];

/// Teeth of OH-58: Table 1 of Parker, Agashe & Vijayakar (2000).
const OH_58: (u32, u32, u32) = (27, 35, 99);

fn set(teeth: (u32, u32, u32), fixed: Member, input: Member, rpm: f64) -> Kinematics {
    Kinematics::new(teeth.0, teeth.1, teeth.2, fixed, input, rpm).unwrap()
}

/// Every pair (fixed, input) of different members.
fn drives() -> impl Iterator<Item = (Member, Member)> {
    let pairs = MEMBERS.into_iter().flat_map(|f| MEMBERS.into_iter().map(move |i| (f, i)));
    pairs.filter(|(fixed, input)| fixed != input)
}

/// Every drive of several sets in both directions, with Z_r = Z_s + 2 Z_p and without.
fn many_sets() -> impl Iterator<Item = Kinematics> {
    let teeth = [OH_58, (30, 20, 70), (12, 60, 132), (61, 17, 96)];
    teeth.into_iter().flat_map(|teeth| {
        drives().flat_map(move |(fixed, input)| {
            [2500.0, -731.5].map(|rpm| set(teeth, fixed, input, rpm))
        })
    })
}

#[track_caller]
fn assert_close(actual: f64, expected: f64, scale: f64) {
    assert!((actual - expected).abs() <= 1e-12 * scale.abs(), "{actual} instead of {expected}");
}

#[test]
fn oh_58_at_2500_rpm() {
    // Analytic: f_m = Z_s Z_r/(Z_s + Z_r) n_s/60 and n_c = Z_s/(Z_s + Z_r) n_s.
    let k = set(OH_58, Member::Ring, Member::Sun, 2500.0);
    assert_close(k.mesh_frequency_hz, 27.0 * 99.0 / 126.0 * 2500.0 / 60.0, 1.0e3);
    assert!((k.mesh_frequency_hz - 883.9).abs() < 0.05);
    assert!((k.speeds_rpm.carrier - 535.71).abs() < 0.005);
    assert_close(k.speed_ratio, 27.0 / 126.0, 1.0);
    // n_p − n_c = −(27/35)(n_s − n_c)
    let planet = k.speeds_rpm.planet_relative_to_carrier;
    assert_close(planet, -27.0 / 35.0 * (2500.0 - 2500.0 * 27.0 / 126.0), 1.0e3);
    assert_eq!(k.output, Member::Carrier);
}

#[test]
fn both_mesh_equations_hold_for_every_drive() {
    for k in many_sets() {
        let [z_s, z_p, z_r] = [k.teeth_sun, k.teeth_planet, k.teeth_ring].map(f64::from);
        let w = k.speeds_rad_per_s;
        let scale = (z_s + z_r) * (w.sun.abs() + w.ring.abs() + w.carrier.abs());
        assert_close(z_s * (w.sun - w.carrier), -z_p * (w.planet - w.carrier), scale);
        assert_close(z_r * (w.ring - w.carrier), z_p * (w.planet - w.carrier), scale);
        assert_close(w.planet - w.carrier, w.planet_relative_to_carrier, scale);
        // f_m in either mesh
        assert_close(k.mesh_frequency_hz, z_s * (w.sun - w.carrier).abs() / TAU, scale);
        assert_close(k.mesh_frequency_hz, z_r * (w.ring - w.carrier).abs() / TAU, scale);
        // The two given speeds are kept.
        assert_eq!(k.speeds_rpm.of(k.fixed), 0.0);
        assert_close(w.of(k.input), k.speeds_rpm.of(k.input) * TAU / 60.0, scale);
        assert_close(w.of(k.output), k.speed_ratio * w.of(k.input), scale);
    }
}

#[test]
fn external_torques_balance_and_lose_no_power() {
    for k in many_sets() {
        let t = k.torques_nm(1130.0);
        let (z_s, z_r) = (f64::from(k.teeth_sun), f64::from(k.teeth_ring));
        let scale = t.sun.abs() + t.ring.abs() + t.carrier.abs();
        assert_eq!(t.of(k.input), 1130.0);
        assert_close(t.sun + t.ring + t.carrier, 0.0, scale);
        assert_close(t.sun * z_r, t.ring * z_s, scale * z_r);
        let w = k.speeds_rad_per_s;
        let power = MEMBERS.map(|m| t.of(m) * w.of(m));
        assert_close(power.iter().sum(), 0.0, scale * w.of(k.input));
        // The held member's torque does no work: T_out ω_out = −T_in ω_in.
        assert_close(t.of(k.output) * w.of(k.output), -1130.0 * w.of(k.input), scale * 1e3);
    }
}

#[test]
fn a_common_speed_added_to_all_members_changes_no_mesh() {
    for k in many_sets() {
        // In a frame that turns with one central member this member is at rest: each in turn.
        for (fixed, input) in drives() {
            let frame = k.speeds_rpm.of(fixed);
            let input_rpm = k.speeds_rpm.of(input) - frame;
            let teeth = (k.teeth_sun, k.teeth_planet, k.teeth_ring);
            let shifted = set(teeth, fixed, input, input_rpm);
            let scale = 1e3 * (frame.abs() + input_rpm.abs());
            assert_close(shifted.mesh_frequency_hz, k.mesh_frequency_hz, scale);
            for m in MEMBERS {
                assert_close(shifted.speeds_rpm.of(m), k.speeds_rpm.of(m) - frame, scale);
            }
            assert_close(shifted.speeds_rpm.planet, k.speeds_rpm.planet - frame, scale);
        }
    }
}

#[test]
fn one_tooth_more_is_noticed() {
    // Negative control: the mesh equations of 27/35/99 do not hold for 28/35/99.
    let right = set(OH_58, Member::Ring, Member::Sun, 2500.0);
    let wrong = set((28, 35, 99), Member::Ring, Member::Sun, 2500.0);
    assert!((wrong.mesh_frequency_hz - right.mesh_frequency_hz).abs() > 10.0);
    let w = wrong.speeds_rad_per_s;
    assert!((27.0 * (w.sun - w.carrier) + 35.0 * (w.planet - w.carrier)).abs() > 100.0);
}

#[test]
fn at_rest_the_ratio_is_still_known() {
    let k = set(OH_58, Member::Ring, Member::Sun, 0.0);
    assert_eq!(k.mesh_frequency_hz, 0.0);
    assert_close(k.speed_ratio, 27.0 / 126.0, 1.0);
}

#[test]
fn impossible_requests_are_refused() {
    let new = |s, p, r, rpm| Kinematics::new(s, p, r, Member::Ring, Member::Sun, rpm);
    assert_eq!(new(0, 35, 99, 1.0), Err(KinematicsError::NoTeeth("sun")));
    assert_eq!(new(27, 0, 99, 1.0), Err(KinematicsError::NoTeeth("planet")));
    assert_eq!(new(27, 35, 0, 1.0), Err(KinematicsError::NoTeeth("ring")));
    let infinite = new(27, 35, 99, f64::INFINITY);
    assert_eq!(infinite, Err(KinematicsError::SpeedNotFinite(f64::INFINITY)));
    assert!(new(27, 35, 99, f64::NAN).is_err());
    for m in MEMBERS {
        let same = Kinematics::new(27, 35, 99, m, m, 1.0);
        assert_eq!(same, Err(KinematicsError::InputIsFixed(m)));
        assert!(same.unwrap_err().to_string().contains(m.name()));
    }
    // The largest numbers of teeth overflow nothing.
    assert!(new(u32::MAX, u32::MAX, u32::MAX, 1.0).is_ok());
}

/// OH-58 with three planets, at 2500 rpm.
fn oh_58_scene() -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_3p.toml");
    let mut scene = Scene::from_file(Path::new(path)).unwrap();
    scene.operation.as_mut().unwrap().speed_rpm = 2500.0;
    scene
}

#[test]
fn a_scene_moves_when_it_has_teeth_and_an_operating_point() {
    let scene = oh_58_scene();
    let k = scene.kinematics().unwrap();
    assert_eq!(k, set(OH_58, Member::Ring, Member::Sun, 2500.0));
    // With 3 planets and Z_s = 27 every harmonic has a net torque and none a net force.
    let strengths = excitation_of_scene(&scene, 5).unwrap();
    assert_eq!(strengths.iter().map(|e| e.harmonic).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    assert!(strengths.iter().all(|e| e.allowed().rotational && !e.allowed().translational));

    let without_teeth = Scene { teeth: None, ..scene.clone() };
    assert!(without_teeth.kinematics().is_err());
    assert!(excitation_of_scene(&without_teeth, 5).is_none());
    let without_operation = Scene { operation: None, ..scene.clone() };
    assert!(without_operation.kinematics().is_err());
    assert!(excitation_of_scene(&without_operation, 5).is_some());
    let pair = Scene { kind: SceneKind::GearPair, ..scene };
    assert!(pair.kinematics().is_err());
    assert!(excitation_of_scene(&pair, 5).is_none());
}
