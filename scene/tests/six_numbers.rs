//! A scene of six numbers: circles, distance, positions and supports follow, and are noted.

use gearset::{MeshKind, MeshMember};
use scene::{Fidelity, Scene, Verb, warnings};

fn planetary([z_s, z_p, z_r]: [u32; 3], planets: u32, module: f64) -> String {
    format!(
        "format = 1\nkind = \"planetary\"\nplanets.count = {planets}\n\
         teeth = {{ sun = {z_s}, planet = {z_p}, ring = {z_r} }}\n\
         geometry = {{ rack.module_mm = {module}, face_width_mm = {} }}\noperation.torque_nm = {}\n",
        10.0 * module,
        20.0 * module.powi(3)
    )
}

/// The scene of the README.
const SIX: [u32; 3] = [21, 39, 99];

#[test]
fn six_numbers_are_enough_for_every_verb_that_computes_sets() {
    let text = planetary(SIX, 3, 10.0);
    assert!(text.lines().count() <= 8);
    let (scene, remarks) = Scene::with_remarks(&text).unwrap();
    for verb in [
        Verb::Modes,
        Verb::Rules,
        Verb::Mesh,
        Verb::Static,
        Verb::Impulse,
        Verb::Sweep(Fidelity::QuasiStatic),
        Verb::Sweep(Fidelity::MeshLaw),
    ] {
        assert!(scene.lacks(verb).is_empty(), "{verb:?}: {:?}", scene.lacks(verb));
    }
    let value = |key: &str| {
        let chosen = remarks.chosen.iter().find(|chosen| chosen.key == key);
        chosen.unwrap_or_else(|| panic!("{key}: {remarks:?}")).value.clone()
    };
    for (key, expected) in [
        ("geometry.center_distance_mm", "300"),
        ("geometry.sun.tip_diameter_mm", "230"),
        ("geometry.sun.root_diameter_mm", "185"),
        ("geometry.sun.fillet_radius_mm", "3.8"),
        ("geometry.sun.bore_diameter_mm", "115"),
        ("geometry.planet.tip_diameter_mm", "410"),
        ("geometry.ring.tip_diameter_mm", "970"),
        ("geometry.ring.root_diameter_mm", "1015"),
        ("geometry.ring.rim_diameter_mm", "1085"),
        ("ring.motion", "\"held\""),
        ("carrier.motion", "\"held\""),
        ("operation.speed_rpm", "1000"),
        ("planet.bearing_n_per_m", "1.5846e9"),
    ] {
        assert_eq!(value(key), expected, "{key}");
    }
    assert!(!remarks.chosen.iter().any(|chosen| chosen.key.contains("position")));
    let found = warnings(&scene);
    assert!(found.iter().all(|warning| warning.key == "dynamics.steps_per_cycle"), "{found:?}");
    // The file with everything written out is the same scene, and leaves nothing to choose.
    let (again, remarks) = Scene::with_remarks(&scene.to_toml()).unwrap();
    assert_eq!(again, scene);
    assert_eq!(remarks, scene::Remarks::default());
    scene.check().unwrap();
}

/// The README shows the scene and the diameters that follow from it.
#[test]
fn the_readme_has_the_scene_and_its_diameters() {
    let readme = include_str!("../../README.md");
    let (_, after) = readme.split_once("```toml\n").unwrap();
    let (text, after) = after.split_once("```").unwrap();
    assert_eq!(text, planetary(SIX, 3, 10.0));
    let (scene, _) = Scene::with_remarks(text).unwrap();
    let input = scene.geometry.unwrap();
    let mm = |gear: &gearset::GearInput| {
        let [tip, root] =
            [gear.tip_radius_m, gear.root_radius_m].map(|r| format!("{:.0}", 2e3 * r));
        format!("{tip} and {root} mm of the")
    };
    let shown = after.split_once("\n\nWithout").unwrap().0.replace('\n', " ");
    assert!(shown.contains(&format!("centre distance is {:.0} mm", 1e3 * input.center_distance_m)));
    for (gear, name) in
        [(input.sun.unwrap(), "sun"), (input.planet, "planets"), (input.ring.unwrap(), "ring")]
    {
        assert!(shown.contains(&format!("{} {name}", mm(&gear))), "{name}: {}", mm(&gear));
    }
}

#[test]
fn what_is_given_is_taken_and_the_others_follow_it() {
    let six = planetary(SIX, 4, 10.0);
    // Four planets do not divide 120 teeth by chance: they do; five of 21/40/101 do not.
    assert_eq!(Scene::from_toml(&six).unwrap().planets.steps, Some(vec![0, 30, 60, 90]));
    let (uneven, remarks) = Scene::with_remarks(&planetary([21, 40, 101], 4, 10.0)).unwrap();
    assert_eq!(uneven.planets.steps, Some(vec![0, 31, 61, 92]));
    assert!(remarks.chosen.iter().any(|chosen| chosen.value == "[0, 31, 61, 92]"), "{remarks:?}");
    let changed = |from: &str, to: &str| {
        assert!(six.contains(from), "{from}");
        Scene::from_toml(&six.replace(from, to)).unwrap_or_else(|error| panic!("{error}"))
    };
    let circles = |scene: &Scene| scene.geometry.clone().unwrap();
    let rack = "rack.module_mm = 10,";
    let deeper = changed(rack, "rack = { module_mm = 10, dedendum = 1.4, fillet_radius = 0.3 },");
    let input = circles(&deeper);
    assert!((2e3 * input.planet.root_radius_m - 362.0).abs() < 1e-9);
    assert!((1e3 * input.planet.fillet_radius_m - 3.0).abs() < 1e-12);
    let input = circles(&changed(
        rack,
        "rack.module_mm = 10, sun.tip_diameter_mm = 229, sun.bore_diameter_mm = 80,",
    ));
    let sun = input.sun.unwrap();
    assert_eq!([sun.tip_radius_m, sun.body_radius_m.unwrap()], [0.1145, 0.04]);
    assert!((2e3 * sun.root_radius_m - 185.0).abs() < 1e-9);
    // Shifts set the distance: 0.2 + 0.3 modules and their roots.
    let input = circles(&changed(
        rack,
        "rack.module_mm = 10, thickness.profile_shift = { sun = 0.2, planet = 0.3, ring = 0.8 },",
    ));
    assert!((2e3 * input.planet.root_radius_m - 371.0).abs() < 1e-9);
    assert!((1e3 * input.center_distance_m - 304.7).abs() < 0.1, "{}", input.center_distance_m);
    // The torque on another member: the others are held.
    let driven = changed(
        "operation.torque_nm",
        "operation.input = \"ring\"\noperation.fixed = \"sun\"\noperation.torque_nm",
    );
    assert_eq!(driven.loaded_member(), Ok(gearset::Member::Ring));
    assert!(driven.torque_path().is_ok());
    let driven =
        changed("operation.torque_nm", "operation.input = \"carrier\"\noperation.torque_nm");
    assert!(driven.torque_path().is_ok() && driven.lacks(Verb::Modes).is_empty());
}

#[test]
fn a_pair_of_two_numbers_of_teeth() {
    for (mesh, teeth, kind) in [
        ("sun_planet", "sun = 21, planet = 39", MeshKind::SunPlanet),
        ("ring_planet", "planet = 20, ring = 50", MeshKind::RingPlanet),
    ] {
        let text = format!(
            "format = 1\nkind = \"gear_pair\"\nmesh = \"{mesh}\"\nteeth = {{ {teeth} }}\n\
             geometry = {{ rack.module_mm = 2, face_width_mm = 20 }}\n"
        );
        let (scene, _) = Scene::with_remarks(&text).unwrap();
        assert!(scene.lacks(Verb::Mesh).is_empty());
        let geometry = scene.tooth_geometry().unwrap();
        let expected = if kind == MeshKind::SunPlanet { 60.0 } else { 30.0 };
        assert!((1e3 * geometry.center_distance - expected).abs() < 1e-9);
        assert!(geometry.mesh(kind).unwrap().contact_ratio > 1.4);
    }
}

/// Few teeth: tips give way to their mates' involutes, which is said; the default fillet never refuses itself.
#[test]
fn sets_of_any_numbers_of_teeth_are_accepted() {
    for z_s in (12..60).step_by(3) {
        for z_p in 12..60 {
            let text = planetary([z_s, z_p, z_s + 2 * z_p], 3, 2.0);
            let (scene, remarks) =
                Scene::with_remarks(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let geometry = scene.tooth_geometry().unwrap();
            let lowered = remarks.chosen.iter().any(|chosen| chosen.why.contains("would leave"));
            let is_plain =
                |gear: &gearset::Gear, tip: f64| (2e3 * gear.tip_radius - tip).abs() < 1e-6;
            let [z_s, z_p] = [z_s, z_p].map(f64::from);
            let ring = geometry.ring.as_ref().unwrap();
            let plain = is_plain(geometry.sun.as_ref().unwrap(), 2.0 * z_s + 4.0)
                && is_plain(&geometry.planet, 2.0 * z_p + 4.0)
                && is_plain(ring, 2.0 * (z_s + 2.0 * z_p) - 4.0);
            assert_eq!(lowered, !plain, "{text}{remarks:?}");
        }
    }
    // A default fillet beside given circles: smaller than 0.3 p_b/π where that touches the mating tip.
    let text = "format = 1\nkind = \"gear_pair\"\nmesh = \"ring_planet\"\nteeth = { planet = 20, ring = 50 }\n\
        [geometry]\nface_width_mm = 20\nrack.module_mm = 2\n\
        planet = { tip_diameter_mm = 44, root_diameter_mm = 35 }\n\
        ring = { tip_diameter_mm = 97, root_diameter_mm = 104.1 }\n";
    let (scene, remarks) = Scene::with_remarks(text).unwrap();
    assert!(remarks.chosen.iter().any(|chosen| chosen.why.contains("the most that fits")));
    let geometry = scene.tooth_geometry().unwrap();
    let interference = geometry.ring_planet.as_ref().unwrap().interference(MeshMember::Driven);
    assert!((-1e-8..=0.0).contains(&interference), "{interference}");
}
