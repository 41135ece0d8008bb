//! A public test gearbox for diagnosis against independent programs: one mesh softened by a crack, and planet bearings
//! that are stiffer in one direction, which no scene has, between two scenes with equal ones.

use std::f64::consts::TAU;

use lumped::{LumpedModel, NaturalModes, Spring, SpringId};
use scene::Scene;

/// 17/37/91, module 5, with planet bearings of this stiffness, N/m.
fn model(bearing: f64) -> LumpedModel {
    model_with(bearing, "")
}

/// The same with further lines.
fn model_with(bearing: f64, lines: &str) -> LumpedModel {
    let text = format!(
        "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = {{ sun = 17, planet = 37, ring = 91 }}\n\
         geometry = {{ rack = {{ module_mm = 5, pressure_angle_deg = 20 }}, face_width_mm = 6 }}\n\
         [sun]\nbearing_n_per_m = 1e7\ntorsional_n_per_m = 1e7\n\
         [ring]\nbearing_n_per_m = 1e9\ntorsional_n_per_m = 5.76e7\n\
         [carrier]\nbearing_n_per_m = 1.95e8\ntorsional_n_per_m = 1e7\n[planet]\nbearing_n_per_m = {bearing:e}\n\
         [lumped]\nmass_kg = {{ sun = 20.29, planet = 3.91, ring = 59.88, carrier = 57.314 }}\n\
         inertia_kg_m2 = {{ sun = 27049.57e-6, planet = 22368.33e-6, ring = 3853845.79e-6, carrier = 776910.239e-6 }}\n\
         mesh_n_per_m = {{ sun_planet = 8e7, ring_planet = 1e8 }}\n{lines}"
    );
    LumpedModel::from_scene(&Scene::from_toml(&text).unwrap()).unwrap()
}

fn hertz(model: &LumpedModel) -> Vec<f64> {
    let modes = NaturalModes::of(model).unwrap();
    modes.lambda.iter().map(|lambda| lambda.max(0.0).sqrt() / TAU).collect()
}

/// The sun mesh of one planet at 6e7 for 8e7 N/m: its 18 frequencies from matrices that were put together apart from
/// this program.
#[test]
fn a_softer_mesh_splits_the_frequencies_as_independent_matrices_do() {
    let cracked = "[[planet_override]]\nplanet = 1\nsun_planet_n_per_m = 6e7\n";
    let found = hertz(&model_with(5.8e7, cracked));
    let expected = [
        95.80, 125.70, 156.71, 157.29, 321.92, 323.53, 377.18, 585.67, 616.91, 618.19, 652.25,
        652.45, 1106.07, 1210.86, 1252.79, 1345.52, 1366.03, 1383.47,
    ];
    assert_eq!(found.len(), expected.len());
    for (f, expected) in found.iter().zip(expected) {
        assert!((f - expected).abs() < 6e-3, "{f} {expected}");
    }
}

/// Radial 2.9e7, tangential 8.7e7 N/m: a list of an independent program. xᵀKx grows with either stiffness, so that each
/// natural frequency lies between those with both bearings at the smaller and at the larger one.
#[test]
fn frequencies_with_unequal_bearings_lie_between_those_with_equal_ones() {
    let (radial, tangential) = (2.9e7, 8.7e7);
    let mut unequal = model(radial);
    let each = std::mem::take(&mut unequal.springs);
    unequal.springs = each
        .into_iter()
        .flat_map(|spring| {
            let split = matches!(spring.id, SpringId::PlanetBearing(_));
            let Spring { id, stiffness, mut rows } = spring;
            let second = if split { rows.split_off(1) } else { Vec::new() };
            let other = Spring { id, stiffness: tangential, rows: second };
            [Spring { id, stiffness, rows }, other]
        })
        .filter(|spring| !spring.rows.is_empty())
        .collect();
    let found = hertz(&unequal);
    let listed = [
        (95.89, 1),
        (125.71, 1),
        (164.68, 2),
        (325.49, 2),
        (412.52, 1),
        (439.39, 1),
        (465.31, 2),
        (649.14, 2),
        (1271.55, 2),
        (1335.99, 1),
        (1371.74, 2),
        (1387.94, 1),
    ];
    let listed: Vec<f64> =
        listed.into_iter().flat_map(|(f, times)| std::iter::repeat_n(f, times)).collect();
    assert_eq!(found.len(), listed.len());
    let (low, high) = (hertz(&model(radial)), hertz(&model(tangential)));
    for (i, (f, listed)) in found.iter().zip(&listed).enumerate() {
        assert!((f - listed).abs() < 0.006, "{f} {listed}");
        assert!(
            low[i] <= f * (1.0 + 1e-9) && *f <= high[i] * (1.0 + 1e-9),
            "{} {f} {}",
            low[i],
            high[i]
        );
    }
}
