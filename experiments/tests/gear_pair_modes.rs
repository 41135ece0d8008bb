//! Natural frequencies of finite-element gear pairs: by linearisation, by impulse test, and as lumped models have them.

use std::f64::consts::TAU;

use experiments::modal::{ImpulseSettings, Preload, impulse_test, linear_modes, preloaded};
use fe_contact::statics::Bodies;
use lumped::{LumpedModel, NaturalModes};
use scene::{LoadCase, LumpedInput, PerBody, PerMesh, Scene};

/// The catalogue scene on a coarse mesh, with supports given as text.
fn meshed(supports: &str) -> (Scene, Bodies) {
    let text = format!("{}\n{supports}", include_str!("../../scenes/pair_50_50.toml"));
    let mut scene = Scene::from_toml(&text).unwrap();
    scene.fe_contact.flank_elements = 8;
    let bodies = Bodies::new(&scene).unwrap();
    (scene, bodies)
}

/// Frequencies of the linearised pair at a position, Hz, and the tangent stiffness of its mesh, N/m.
fn linearised(scene: &Scene, bodies: &Bodies, position: f64) -> (Vec<f64>, f64) {
    let load = LoadCase::of_scene(scene).unwrap();
    let set = preloaded(scene, bodies, &Preload { load, position, step_s: 5e-6 }).unwrap();
    let linear = set.linearised().unwrap();
    let modes = linear_modes(&set, &linear).unwrap();
    (modes.iter().map(|m| m.frequency_hz).collect(), linear.mesh_tangents[0])
}

/// The scene with the lumped model of its gears and the given mesh stiffness.
fn lumped(scene: &Scene, bodies: &Bodies, stiffness: f64) -> Vec<f64> {
    let (sun, planet) = (bodies.sun.as_ref().unwrap(), &bodies.planet);
    let mesh = bodies.geometry.sun_planet.as_ref().unwrap();
    let radii = [sun, planet].map(|gear| gear.mesh.outline.gear().base_radius);
    let of = |sun: f64, planet: f64| PerBody {
        sun: Some(sun),
        planet: Some(planet),
        ..PerBody::default()
    };
    let mut scene = scene.clone();
    scene.lumped = Some(LumpedInput {
        mass_kg: of(sun.mass, planet.mass),
        inertia_over_r2_kg: of(sun.inertia / radii[0].powi(2), planet.inertia / radii[1].powi(2)),
        radius_m: of(radii[0], radii[1]),
        mesh_n_per_m: PerMesh { sun_planet: stiffness, ring_planet: 0.0 },
        pressure_angle_rad: PerMesh { sun_planet: mesh.pressure_angle, ring_planet: 0.0 },
    });
    let modes = NaturalModes::of(&LumpedModel::from_scene(&scene).unwrap()).unwrap();
    modes.lambda.iter().map(|l| l.max(0.0).sqrt() / TAU).collect()
}

#[test]
fn rigid_bearings_leave_the_frequency_of_the_effective_mass() {
    let (scene, bodies) = meshed("");
    for position in [0.0, 0.4, 0.9] {
        let (found, stiffness) = linearised(&scene, &bodies, position);
        assert_eq!(found.len(), 1);
        // The common rotation comes first.
        let expected = lumped(&scene, &bodies, stiffness);
        assert_eq!(expected.len(), 2);
        println!("at {position}: {found:?} {expected:?} k = {stiffness:e}");
        assert!(expected[0] < 1e-3 * expected[1]);
        assert!((found[0] / expected[1] - 1.0).abs() < 2e-3);
    }
}

#[test]
fn six_coordinates_have_the_frequencies_of_the_lumped_pair() {
    let gear = "bearing_n_per_m = 4e8\ntorsional_nm_per_rad = 1e5\n";
    let (scene, bodies) = meshed(&format!("[sun]\n{gear}[planet]\n{gear}"));
    let (found, stiffness) = linearised(&scene, &bodies, 0.4);
    let expected = lumped(&scene, &bodies, stiffness);
    println!("{found:?}\n{expected:?}");
    assert_eq!((found.len(), expected.len()), (6, 6));
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found / expected - 1.0).abs() < 5e-3, "{found} {expected}");
    }
}

#[test]
fn an_impulse_test_finds_the_linearised_frequency() {
    let (scene, bodies) = meshed("");
    let (linear, _) = linearised(&scene, &bodies, 0.4);
    let load = LoadCase::of_scene(&scene).unwrap();
    let band = (0.5 * linear[0], 1.4 * linear[0]);
    let found = impulse_test(&scene, &bodies, &ImpulseSettings::in_band(load, 0.4, band)).unwrap();
    let list: Vec<f64> = found.modes.iter().map(|m| m.frequency_hz).collect();
    println!("{list:?} {linear:?}");
    assert_eq!(list.len(), 1);
    assert!((list[0] / linear[0] - 1.0).abs() < 3e-3);
}
