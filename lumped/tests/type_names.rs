//! Names of modes where the kinds of a set do not say what moves: gear pairs, planets on rigid bearings.

use std::f64::consts::TAU;

use lumped::{LumpedModel, NaturalModes, type_warnings};
use scene::{Scene, SceneKind, template};

fn named(scene: &Scene) -> Vec<(&'static str, f64, usize)> {
    let model = LumpedModel::from_scene(scene).unwrap();
    let modes = NaturalModes::of(&model).unwrap();
    let named = modes.named(&model);
    let coordinates: usize = named.iter().map(|n| n.group.vectors.ncols()).sum();
    assert_eq!(coordinates, model.mass.len(), "no mode is lost");
    named.iter().map(|n| (n.name, n.group.frequency_hz, n.group.multiplicity)).collect()
}

fn has(found: &[(&str, f64, usize)], name: &str, hertz: f64, times: usize) {
    let is = |(n, f, t): &&(&str, f64, usize)| {
        *n == name && *t == times && (f - hertz).abs() <= 2e-5 * hertz
    };
    assert_eq!(found.iter().filter(is).count(), 1, "{name} {hertz} ×{times}: {found:?}");
}

/// Stage 2 of the NREL 5 MW reference gearbox (18/36/93), bearings all but rigid.
/// What planets do alone is f = √((k_s + k_r)/(I_p/r_p²))/2π, N − 1 times.
#[test]
fn torsional_modes_of_planets_are_those_of_planets() {
    let text = |planets: usize| {
        format!(
            "format = 1\nkind = \"planetary\"\nplanets.count = {planets}\n\
             teeth = {{ sun = 18, planet = 36, ring = 93 }}\n\
             [geometry]\ncenter_distance_mm = 584.0\nface_width_mm = 550.0\n\
             rack = {{ module_mm = 21.0, pressure_angle_deg = 20.0 }}\n\
             [geometry.thickness]\nprofile_shift = {{ sun = 0.3805, planet = 0.4924, ring = -0.0962 }}\n\
             [sun]\nbearing_n_per_m = 1e15\n[ring]\nmotion = \"held\"\n\
             [carrier]\nbearing_n_per_m = 1e15\n[planet]\nbearing_n_per_m = 1e15\n\
             [lumped]\nmass_kg = {{ sun = 379.740, planet = 880.299, carrier = 1500.0 }}\n\
             inertia_kg_m2 = {{ sun = 8.91389, planet = 101.89854, carrier = 400.0 }}\n\
             mesh_n_per_m = {{ sun_planet = 8.602e9, ring_planet = 11.30965e9 }}\n"
        )
    };
    let alone = ((8.602e9f64 + 11.30965e9) / (101.89854 / 0.3552038f64.powi(2))).sqrt() / TAU;
    let three = named(&Scene::from_toml(&text(3)).unwrap());
    has(&three, "planet", alone, 2);
    has(&three, "rotational", 745.05, 1);
    has(&three, "rotational", 1653.52, 1);
    // Four planets make three.
    let four = Scene::from_toml(&text(4)
        .replace("teeth = { sun = 18, planet = 36, ring = 93 }", "teeth = { sun = 18, planet = 36, ring = 90 }")
        .replace("center_distance_mm = 584.0\n", "")
        .replace("[geometry.thickness]\nprofile_shift = { sun = 0.3805, planet = 0.4924, ring = -0.0962 }\n", ""));
    let four = four.unwrap();
    let r = four.lumped.as_ref().unwrap().radius_m.planet.unwrap();
    let alone = ((8.602e9 + 11.30965e9) / (101.89854 / (r * r))).sqrt() / TAU;
    let four = named(&four);
    has(&four, "planet", alone, 3);
}

/// At right angles to the line of action each gear of a pair translates alone, at √(k_b/m); along it translation and
/// rotation are coupled; the common rotation is one.
#[test]
fn modes_of_pairs_are_named_by_what_the_gears_do() {
    let text = "[sun]\nbearing_n_per_m = 4e8\n[planet]\nbearing_n_per_m = 3e8\n\
                [lumped]\nmass_kg = { sun = 0.7, planet = 1.1 }\n\
                inertia_kg_m2 = { sun = 0.002, planet = 0.005 }\nmesh_n_per_m = { sun_planet = 3e8 }\n";
    let scene = Scene::from_toml(&format!("{}\n{text}", template(SceneKind::GearPair))).unwrap();
    let found = named(&scene);
    has(&found, "translational", (4e8f64 / 0.7).sqrt() / TAU, 1);
    has(&found, "translational", (3e8f64 / 1.1).sqrt() / TAU, 1);
    assert_eq!(found.iter().filter(|(name, ..)| *name == "coupled").count(), 3, "{found:?}");
    assert_eq!(found[0].0, "rotational");
    // The gears alike: the two at right angles and the common translation along the line are one frequency.
    let alike = text.replace("3e8\n[lumped]", "4e8\n[lumped]").replace("1.1", "0.7");
    let alike = Scene::from_toml(&format!("{}\n{alike}", template(SceneKind::GearPair))).unwrap();
    has(&named(&alike), "translational", (4e8f64 / 0.7).sqrt() / TAU, 3);
    let model = LumpedModel::from_scene(&alike).unwrap();
    assert!(type_warnings(&model, &NaturalModes::of(&model).unwrap()).is_empty());
}
