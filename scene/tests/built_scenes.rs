//! A scene that a program builds or changes is judged as its file is, and reaches the file unchanged.

use std::path::Path;

use scene::{Freedom, Scene, SceneKind, template};

fn set() -> Scene {
    Scene::from_toml(template(SceneKind::Planetary)).unwrap()
}

/// Every scene file, and both templates.
fn texts() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut texts: Vec<_> = files.map(|file| std::fs::read_to_string(file).unwrap()).collect();
    texts.extend([SceneKind::Planetary, SceneKind::GearPair].map(|kind| template(kind).to_owned()));
    texts
}

#[test]
fn a_scene_through_its_file_is_equal() {
    for text in texts() {
        let scene = Scene::from_toml(&text).unwrap();
        let file = scene.to_toml();
        let again = Scene::from_toml(&file).unwrap_or_else(|error| panic!("{error}\n{file}"));
        assert_eq!(again, scene, "{file}");
        assert_eq!(again.to_toml(), file);
        scene.check().unwrap();
        let json = serde_json::to_string(&scene).unwrap();
        assert_eq!(serde_json::from_str::<Scene>(&json).unwrap(), scene);
    }
}

/// A change in a program, and the key of the fault that it makes.
type Change = (fn(&mut Scene), &'static str);

#[test]
fn what_no_file_may_hold_is_a_fault_with_its_key() {
    let changes: [Change; 10] = [
        (|s| s.planets.psi_rad.clear(), "planets.count"),
        (|s| s.planets.psi_rad = [0.0, 90.0, 180.0, 270.0].to_vec(), "planets.positions_deg"),
        (|s| s.planets.psi_rad = vec![0.0; 4], "planets.positions_deg"),
        (|s| s.planets.steps = Some(vec![0, 1, 63, 32]), "planets.position_steps"),
        (|s| s.operation.as_mut().unwrap().torque_nm = f64::NAN, "operation.torque_nm"),
        (|s| s.fe_contact.contact_cells = 0, "fe_contact.contact_cells"),
        (
            |s| s.lumped.as_mut().unwrap().pressure_angle_rad.sun_planet = 24.6,
            "lumped.pressure_angle_deg.sun_planet",
        ),
        (|s| s.material.density_kg_per_m3 = -7850.0, "material.density_kg_per_m3"),
        (|s| s.supports.sun.motion = Freedom::CentreHeld, "sun.motion"),
        (|s| s.dynamics.steps_per_cycle = 0, "dynamics.steps_per_cycle"),
    ];
    for (change, key) in changes {
        let mut scene = set();
        change(&mut scene);
        let faults = scene.check().expect_err(key).0;
        assert!(faults.iter().any(|fault| fault.key == key), "{key}: {faults:?}");
    }
}

#[test]
fn a_set_begins_with_the_defaults_of_the_keys_and_takes_parts_of_another() {
    let whole = set();
    let mut built = Scene::planetary(4, 87.6e6).unwrap();
    assert_eq!((built.fe_contact, built.dynamics), (whole.fe_contact, whole.dynamics));
    assert_eq!(built.damping, whole.damping);
    let Scene { title, source, planets, teeth, geometry, .. } = whole.clone();
    built = Scene { title, source, planets, teeth, geometry, ..built };
    built.check().unwrap();
    let Scene { material, supports, lumped, operation, .. } = whole.clone();
    built = Scene { material, supports, lumped, operation, ..built };
    assert_eq!(built, whole);
    for (planets, bearing, key) in
        [(0, 1e8, "planets.count"), (3, f64::NAN, "planet.bearing_n_per_m")]
    {
        let error = Scene::planetary(planets, bearing).unwrap_err();
        assert!(error.faults().iter().any(|fault| fault.key == key), "{key}: {error}");
    }
}
