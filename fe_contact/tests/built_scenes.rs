//! Scenes that a program changes are refused with the key, where no file could hold what they say.

use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::Facing;
use scene::{LoadCase, Scene, SceneKind, template};

fn scene() -> Scene {
    let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
    scene.fe_contact.flank_elements = 6;
    scene
}

#[test]
fn bodies_are_made_of_planets_apart_cells_and_a_material() {
    type Change = (fn(&mut Scene), &'static str);
    let changes: [Change; 4] = [
        (|s| s.fe_contact.contact_cells = 0, "fe_contact.contact_cells"),
        (|s| s.planets.psi_rad = vec![0.0, 0.0, 1.0, 2.0], "planets.positions_deg"),
        (|s| s.planets.psi_rad.clear(), "planets.count"),
        (|s| s.planets.psi_rad = vec![0.0, 90.0, 180.0, 270.0], "planets.positions_deg"),
    ];
    for (change, key) in changes {
        let mut scene = scene();
        change(&mut scene);
        match Bodies::new(&scene) {
            Err(FeError::Scene(faults)) => {
                assert!(faults.0.iter().any(|fault| fault.key == key), "{key}: {faults}");
            }
            Err(FeError::Unfit { key: found, .. }) => assert_eq!(found, key),
            Err(other) => panic!("{key}: {other}"),
            Ok(_) => panic!("{key} is accepted"),
        }
    }
}

#[test]
fn a_mesh_cycle_has_a_torque_and_positions() {
    let scene = scene();
    let bodies = Bodies::new(&scene).unwrap();
    let set = StaticSet::new(&scene, &bodies, Facing::CounterClockwise, Imperfections::default());
    let set = set.unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    let torque = case.with_sun_torque(f64::NAN).sun_load_nm();
    for (torque, positions, key) in
        [(torque, 4, "operation.torque_nm"), (case.sun_load_nm(), 0, "positions")]
    {
        match set.cycle(torque, positions, &ActiveSet) {
            Err(FeError::Unfit { key: found, .. }) => assert_eq!(found, key),
            Err(other) => panic!("{key}: {other}"),
            Ok(_) => panic!("{key} is accepted"),
        }
    }
}

/// The mean of fourteen positions is that of four times as many to 1e-7 of the motion of the sun; of four it
/// is another.
#[test]
fn the_loaded_configuration_is_the_mean_of_as_many_positions_as_the_scene_asks_for() {
    let sun = |positions: u32| {
        let mut scene = scene();
        scene.fe_contact.mean_positions = Some(positions);
        let bodies = Bodies::new(&scene).unwrap();
        let set =
            StaticSet::new(&scene, &bodies, Facing::CounterClockwise, Imperfections::default());
        let torque = LoadCase::of_scene(&scene).unwrap().sun_load_nm();
        let found = set.unwrap().cycle(torque, 4, &ActiveSet).unwrap();
        found.states.iter().map(|state| state.central[2][2]).sum::<f64>()
    };
    let [four, usual, many] = [4, 14, 56].map(sun);
    println!("{four:e} {usual:e} {many:e}");
    assert!(four != usual && (usual / many - 1.0).abs() < 1e-7, "{four:e} {usual:e} {many:e}");
}
