//! The scene of a gear pair: supports, load, what is refused, and by which key.

use gearset::Member;
use scene::{Fidelity, Freedom, LoadCase, Scene, SceneKind, Torsional, Verb, template};

fn with(text: &str) -> String {
    format!("{}\n{text}\n", template(SceneKind::GearPair))
}

fn scene(text: &str) -> Scene {
    Scene::from_toml(&with(text)).unwrap()
}

#[test]
fn a_bearing_left_out_is_rigid_and_a_shaft_left_out_turns_freely() {
    let free = scene("");
    let of = |scene: &Scene| [scene.supports.sun, scene.supports.pair.unwrap().planet];
    assert!(of(&free).iter().all(|s| s.motion == Freedom::CentreHeld && s.turns_freely()));
    assert!(free.is_free_pair());
    assert_eq!(free.supports.carrier.motion, Freedom::Held);
    let sprung = scene(
        "[sun]\nbearing_n_per_m = 4e8\nmass_kg = 2.5\n[planet]\nbearing_n_per_m = 5e8\n\
         torsional_nm_per_rad = 1e4\ninertia_kg_m2 = 0.01",
    );
    let [sun, planet] = of(&sprung);
    assert_eq!((sun.motion, sun.bearing_n_per_m), (Freedom::Free, 4e8));
    assert_eq!((planet.motion, planet.bearing_n_per_m), (Freedom::Free, 5e8));
    assert_eq!(planet.torsional, Torsional::PerAngle(1e4));
    let pair = sprung.supports.pair.unwrap();
    assert_eq!((pair.sun_inertia.mass_kg, pair.sun_inertia.inertia_kg_m2), (Some(2.5), None));
    assert_eq!(pair.planet_inertia.inertia_kg_m2, Some(0.01));
    assert!(!sprung.is_free_pair());
    let held = scene("[planet]\nmotion = \"rotation_held\"");
    assert_eq!(of(&held)[1].motion, Freedom::Held);
    assert!(!held.is_free_pair());
    let sliding = scene("[planet]\nmotion = \"rotation_held\"\nbearing_n_per_m = 5e8");
    assert_eq!(of(&sliding)[1].motion, Freedom::RotationHeld);
}

#[test]
fn the_mesh_frequency_is_that_of_the_sun() {
    let case =
        LoadCase::of_scene(&scene("[operation]\nspeed_rpm = -1200\ntorque_nm = -80")).unwrap();
    // 27 teeth.
    assert!((case.mesh_frequency_hz - 540.0).abs() < 1e-9);
    assert_eq!((case.driven, case.held), (Member::Sun, Some(Member::Carrier)));
    assert_eq!((case.sun_torque_nm, case.input_torque_nm), (-80.0, -80.0));
    assert!((case.at_speed(2400.0).mesh_frequency_hz - 1080.0).abs() < 1e-9);
}

#[test]
fn what_a_pair_cannot_have_is_refused_by_its_key() {
    let ring_pair = "mesh = \"ring_planet\"";
    let cases = [
        ("[carrier]", "carrier", "stand on the ground"),
        ("[ring]", "ring", "stand on the ground"),
        ("[sun]\nbearing_n_per_m = 0", "sun.bearing_n_per_m", "above 0"),
        ("[sun]\nbearing_n_per_m = -1", "sun.bearing_n_per_m", "0"),
        ("[planet]\nbearing_n_per_m = 0", "planet.bearing_n_per_m", "above 0"),
        ("[planet]\nadded_mass_kg = 1", "planet.added_mass_kg", "include its shaft"),
        ("[planet]\nmass_kg = 0", "planet.mass_kg", "above 0"),
        (
            "[planet]\nmotion = \"rotation_held\"\ntorsional_nm_per_rad = 5",
            "planet.torsional_nm_per_rad",
            "held rotation",
        ),
        ("[sun]\nmass = 1", "sun.mass", "mass_kg"),
        (
            "[operation]\nfixed = \"ring\"\nspeed_rpm = 1\ntorque_nm = 1",
            "operation.fixed",
            "stand still",
        ),
        ("[operation]\ninput = \"ring\"\nspeed_rpm = 1\ntorque_nm = 1", "operation.input", "sun"),
        ("[operation]\nspeed_rpm = 1\ntorque_nm = 1e8", "operation.torque_nm", "than the module"),
        ("[dynamics]\ngyroscopic = \"on\"", "dynamics.gyroscopic", "no turning carrier"),
        (
            "[lumped]\ninertia_kg_m2 = { sun = 1, planet = 1 }\n\
             mesh_n_per_m = { sun_planet = 1e8, ring_planet = 1e8 }",
            "lumped.mesh_n_per_m.ring_planet",
            "no ring",
        ),
        ("[lumped]\nmesh_n_per_m = { sun_planet = 1e8 }", "lumped.inertia_kg_m2.sun", "rotate"),
    ];
    for (text, key, words) in cases {
        let error = Scene::from_toml(&with(text)).expect_err(key);
        let found = error.faults().iter().find(|f| f.key == key);
        let found = found.unwrap_or_else(|| panic!("{key}: {error}"));
        assert!(found.to_string().contains(words), "{found}");
        assert_eq!(
            error.faults().len(),
            if key.starts_with("lumped.inertia") { 2 } else { 1 },
            "{error}"
        );
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_ring_planet_pair.toml");
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.contains(ring_pair));
    for table in ["sun", "planet", "lumped"] {
        let error = Scene::from_toml(&format!("{text}\n[{table}]\n")).expect_err(table);
        assert!(error.faults().iter().any(|f| f.key == table), "{error}");
    }
    let ring = Scene::from_toml(&text).unwrap();
    for verb in [Verb::Modes, Verb::Impulse, Verb::Sweep(Fidelity::QuasiStatic)] {
        let lacks = ring.lacks(verb);
        assert_eq!(lacks.len(), 1);
        assert_eq!(lacks[0].key, "mesh");
    }
}

/// Rigid bearings need no mass in the lumped model, and a held rotation no inertia.
#[test]
fn the_lumped_pair_asks_for_what_can_move() {
    let torsional = "[lumped]\ninertia_kg_m2 = { sun = 0.002, planet = 0.005 }\n\
                     mesh_n_per_m = { sun_planet = 3e8 }";
    assert!(scene(torsional).lacks(Verb::Modes).is_empty());
    let held = "[planet]\nmotion = \"rotation_held\"\n[lumped]\ninertia_kg_m2 = { sun = 0.002 }\n\
                mesh_n_per_m = { sun_planet = 3e8 }";
    assert!(scene(held).lacks(Verb::Modes).is_empty());
    let sprung = format!("[sun]\nbearing_n_per_m = 1e8\n{torsional}");
    let error = Scene::from_toml(&with(&sprung)).unwrap_err();
    assert_eq!(error.faults().len(), 1);
    assert_eq!(error.faults()[0].key, "lumped.mass_kg.sun");
}

#[test]
fn given_masses_and_free_rotations_do_not_go_with_elastic_states() {
    let load = "[operation]\nspeed_rpm = 1000\ntorque_nm = 100\n";
    let keys = |text: &str, fidelity| -> Vec<String> {
        let lacks = scene(&format!("{load}{text}")).lacks(Verb::Sweep(fidelity));
        lacks.into_iter().map(|lack| lack.key).collect()
    };
    let given = "[sun]\nmass_kg = 2\n[planet]\ntorsional_nm_per_rad = 1e4";
    assert!(keys("", Fidelity::QuasiStatic).is_empty());
    assert!(keys(given, Fidelity::MeshLaw).is_empty());
    assert_eq!(keys(given, Fidelity::Modal(4)), ["sun.mass_kg"]);
    assert_eq!(keys("", Fidelity::Full), ["planet.torsional_nm_per_rad"]);
    assert!(keys("[planet]\nmotion = \"rotation_held\"", Fidelity::Modal(4)).is_empty());
}
