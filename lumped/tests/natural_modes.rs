//! Published frequencies, classification where modes coincide, structure over random sets.

use crate::common;

use gearset::{Axis, Body, PlanetPositions};
use lumped::{LumpedModel, ModeType, NaturalModes};
use proptest::prelude::*;
use scene::{PlanetOverride, Scene, Torsional};

use common::{modes, of_type, scene};

/// Frequencies of one type, each with multiplicity `each`, within `tolerance` Hz.
fn assert_type(found: &NaturalModes, kind: ModeType, each: usize, hz: &[f64], tolerance: f64) {
    let own = of_type(found, kind);
    assert!(own.len() >= hz.len(), "{kind:?}: {own:?}");
    for (expected, (f, multiplicity)) in hz.iter().zip(&own) {
        assert!((f - expected).abs() <= tolerance, "{kind:?}: {f} {expected}");
        assert_eq!(*multiplicity, each, "{kind:?} {f}");
    }
}

#[test]
fn lin_parker_1999() {
    let (_, three) = modes(&scene("lin_parker_1999_3p.toml"));
    let rotational = [0.0, 1475.7, 1930.3, 2658.3, 7462.8, 11775.3];
    let translational = [743.2, 1102.4, 1896.0, 2276.4, 6986.3, 9647.9];
    assert_type(&three, ModeType::Rotational, 1, &rotational, 0.5);
    assert_type(&three, ModeType::Translational, 2, &translational, 0.5);
    assert_eq!(three.groups.len(), 12);
    let (_, four) = modes(&scene("lin_parker_1999_4p.toml"));
    let rotational = [0.0, 1536.6, 1970.6, 2625.7, 7773.6, 13071.1];
    let translational = [727.0, 1091.0, 1892.8, 2342.5, 7189.9, 10437.6];
    assert_type(&four, ModeType::Rotational, 1, &rotational, 0.5);
    assert_type(&four, ModeType::Translational, 2, &translational, 0.5);
    assert_type(&four, ModeType::Planet, 1, &[1808.2, 5963.8, 6981.7], 0.5);
    assert_eq!(four.groups.len(), 15);
}

#[test]
fn shapes_by_name_and_as_json_solve_the_eigenproblem_of_the_matrices() {
    let (model, found) = modes(&scene("oh58_4p.toml"));
    let [mass, stiffness] = [model.mass_matrix(), model.stiffness()];
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!(json["coordinates"][0], serde_json::json!(["carrier", "first"]));
    for (number, group) in found.groups.iter().enumerate() {
        let scale = (&stiffness * &group.vectors).amax();
        let left = &stiffness * &group.vectors - &mass * &group.vectors * group.lambda;
        assert!(left.amax() <= 1e-9 * scale, "{left}");
        let sun = model.coordinates.of(Body::Sun, Axis::Rotation).unwrap();
        let turning = found.displacement(group, Body::Sun, Axis::Rotation).unwrap();
        for (k, &u) in turning.iter().enumerate() {
            assert_eq!(u, group.vectors[(sun, k)]);
            assert_eq!(json["groups"][number]["vectors"][k][sun], u);
        }
        assert_eq!(found.displacement(group, Body::Ring, Axis::Rotation), None, "the ring is held");
    }
}

#[test]
fn oh58_with_consistent_geometry() {
    let (_, four) = modes(&scene("oh58_4p.toml"));
    let translational = [770.7, 778.6, 1715.8, 1724.5, 2169.8, 2175.0];
    assert_type(&four, ModeType::Translational, 1, &translational, 0.3);
    assert_type(&four, ModeType::Rotational, 1, &[1150.2, 1788.5], 0.3);
    assert_type(&four, ModeType::Planet, 1, &[1710.4], 0.3);
    assert_eq!(of_type(&four, ModeType::Mixed), []);
    let (_, three) = modes(&scene("oh58_3p.toml"));
    assert_type(&three, ModeType::Translational, 2, &[773.5, 1742.6, 2116.9], 0.3);
    assert_type(&three, ModeType::Rotational, 1, &[1112.4, 1779.7], 0.3);
}

/// The three-planet set with the sun's torsional support tuned until its second rotational frequency
/// stands `apart` (relative) above the third translational one.
fn coinciding(apart: f64) -> Scene {
    let mut scene = scene("oh58_3p.toml");
    let goal = target(&scene) * (1.0 + apart);
    let (mut low, mut high) = (0.0, 5e9);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        scene.supports.sun.torsional = Torsional::PerLength(middle);
        if exact_rotational(&scene) < goal { low = middle } else { high = middle }
    }
    scene
}

/// Third translational frequency; the torsional support does not touch it.
fn target(scene: &Scene) -> f64 {
    let mut free = scene.clone();
    free.supports.sun.torsional = Torsional::PerLength(0.0);
    let found = NaturalModes::of(&LumpedModel::from_scene(&free).unwrap()).unwrap();
    of_type(&found, ModeType::Translational)[2].0
}

/// Second rotational frequency from a model without the translational coordinates: sun u, planet.
fn exact_rotational(scene: &Scene) -> f64 {
    let model = LumpedModel::from_scene(scene).unwrap();
    let k = model.stiffness();
    let index = |body, axis| model.coordinates.of(body, axis).unwrap();
    use gearset::{Axis, Body};
    let n = model.psi.len();
    // In-phase planets: sum the planets' rows and columns.
    let mut coordinates = vec![vec![index(Body::Sun, Axis::Rotation)]];
    for axis in Axis::ALL {
        coordinates.push((0..n).map(|p| index(Body::Planet(p), axis)).collect());
    }
    let reduced = nalgebra::DMatrix::from_fn(4, 4, |i, j| {
        let sum: f64 = coordinates[i]
            .iter()
            .flat_map(|&p| coordinates[j].iter().map(move |&q| (p, q)))
            .map(|(p, q)| k[(p, q)])
            .sum();
        sum
    });
    let mass: Vec<f64> =
        coordinates.iter().map(|c| c.iter().map(|&i| model.mass[i]).sum()).collect();
    let solution = dynamics::generalized_symmetric(&reduced, &mass).unwrap();
    solution.lambda[1].sqrt() / std::f64::consts::TAU
}

#[test]
fn a_rotational_mode_on_top_of_a_translational_pair_is_told_apart() {
    // Equal to rounding, where the solver's eigenvectors are mixed, and 3e-5 apart, where they are not.
    for apart in [0.0, 3e-5] {
        let scene = coinciding(apart);
        let (_, found) = modes(&scene);
        let translational = of_type(&found, ModeType::Translational);
        let rotational = of_type(&found, ModeType::Rotational);
        let gap = rotational[1].0 / translational[2].0 - 1.0;
        assert!((gap - apart).abs() < 1e-9, "{gap:e} {apart}");
        assert_eq!(
            (rotational.len(), translational.len()),
            (4, 5),
            "{rotational:?} {translational:?}"
        );
        assert!(translational.iter().all(|m| m.1 == 2));
        assert!(rotational.iter().all(|m| m.1 == 1));
        assert_eq!(of_type(&found, ModeType::Mixed), []);
    }
}

#[test]
fn a_set_without_symmetry_has_mixed_modes_and_says_how_mixed() {
    let mut scene = scene("oh58_4p.toml");
    let one =
        PlanetOverride { planet: 1, bearing_n_per_m: Some(0.8 * 87.6e6), ..Default::default() };
    scene.overrides.push(one);
    let (_, found) = modes(&scene);
    assert!(of_type(&found, ModeType::Mixed).len() > 5);
    for g in &found.groups {
        let p = g.participation;
        assert!((p.rotational + p.translational + p.planet - 1.0).abs() < 1e-12);
    }
}

#[test]
fn one_and_two_planets_are_classified_too() {
    for count in [1, 2] {
        let mut scene = scene("lin_parker_1999_3p.toml");
        scene.planets = PlanetPositions::equally_spaced(count);
        let (_, found) = modes(&scene);
        let all: usize = found.groups.iter().map(|g| g.multiplicity).sum();
        assert_eq!(all, 9 + 3 * count);
        assert_eq!(of_type(&found, ModeType::Planet), []);
        // Σ e^{iψ_n} = 0 for two opposite planets, not for a single one.
        assert_eq!(of_type(&found, ModeType::Mixed).is_empty(), count == 2);
    }
}

/// Any equally spaced set with all members free.
fn random_set() -> impl Strategy<Value = Scene> {
    let mass = || 0.2..8.0f64;
    let stiffness = || 1e7..1e9f64;
    let masses = [(); 8].map(|()| mass());
    let springs = [(); 7].map(|()| stiffness());
    (3usize..9, masses, springs, 0.2..0.6f64, 0.2..0.6f64).prop_map(|(n, m, k, a, b)| {
        let mut scene = scene("lin_parker_1999_3p.toml");
        scene.planets = PlanetPositions::equally_spaced(n);
        let lumped = scene.lumped.as_mut().unwrap();
        let set = |values: &mut scene::PerBody, from: &[f64]| {
            values.carrier = Some(from[0]);
            values.ring = Some(from[1]);
            values.sun = Some(from[2]);
            values.planet = Some(from[3]);
        };
        set(&mut lumped.mass_kg, &m[..4]);
        set(&mut lumped.inertia_over_r2_kg, &m[4..]);
        lumped.mesh_n_per_m.sun_planet = k[0];
        lumped.mesh_n_per_m.ring_planet = k[1];
        lumped.pressure_angle_rad.sun_planet = a;
        lumped.pressure_angle_rad.ring_planet = b;
        scene.supports.carrier.bearing_n_per_m = k[2];
        scene.supports.ring.bearing_n_per_m = k[3];
        scene.supports.sun.bearing_n_per_m = k[4];
        scene.supports.planet_bearing_n_per_m = k[5];
        scene.supports.ring.torsional = Torsional::PerLength(k[6]);
        scene
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Lin & Parker's theorem: six rotational frequencies, six translational pairs, three planet
    /// frequencies N − 3 times each, for any equally spaced set with all members free.
    #[test]
    fn structure_of_the_spectrum(scene in random_set()) {
        let n = scene.planets.count();
        let (_, found) = modes(&scene);
        let count = |kind| {
            of_type(&found, kind).iter().map(|m| m.1).collect::<Vec<_>>()
        };
        prop_assert_eq!(count(ModeType::Rotational), vec![1; 6]);
        prop_assert_eq!(count(ModeType::Translational), vec![2; 6]);
        let planet = if n > 3 { vec![n - 3; 3] } else { vec![] };
        prop_assert_eq!(count(ModeType::Planet), planet);
    }
}

/// A scene built in memory has not passed the reader's checks: an invalid stiffness is refused by name.
#[test]
fn stiffnesses_that_are_none_are_refused() {
    for value in [f64::NAN, -1.0, f64::INFINITY] {
        let mut bad = scene("oh58_4p.toml");
        bad.supports.sun.bearing_n_per_m = value;
        let refused = LumpedModel::from_scene(&bad).unwrap_err().to_string();
        assert!(refused.contains("sun_bearing"), "{refused}");
        let mut bad = scene("oh58_4p.toml");
        bad.supports.sun.torsional = Torsional::PerLength(value);
        let refused = LumpedModel::from_scene(&bad).unwrap_err().to_string();
        assert!(refused.contains("sun_torsion"), "{refused}");
    }
}

/// A rotation that is held has no torsional spring, so that no radius is required.
#[test]
fn a_held_rotation_needs_no_radius() {
    let mut set = scene("oh58_4p.toml");
    set.supports.carrier.torsional = Torsional::PerAngle(1e6);
    set.lumped.as_mut().unwrap().radius_m.carrier = None;
    assert!(LumpedModel::from_scene(&set).is_ok());
}

#[test]
fn a_planet_that_is_not_there_has_no_coordinate() {
    let (model, _) = modes(&scene("oh58_4p.toml"));
    assert_eq!(model.coordinates.of(gearset::Body::Planet(4), gearset::Axis::First), None);
}
