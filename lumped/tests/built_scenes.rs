//! Scenes that a program changes are refused with the key, where no file could hold what they say.

use lumped::LumpedModel;
use scene::{Scene, SceneKind, template};

#[test]
fn models_are_made_of_scenes_without_a_fault() {
    type Change = (fn(&mut Scene), &'static str);
    let changes: [Change; 2] = [
        (|s| s.planets.psi_rad.clear(), "planets.count"),
        (
            |s| s.lumped.as_mut().unwrap().mass_kg.sun = Some(-0.4),
            "`lumped.mass_kg` of the sun is -0.4",
        ),
    ];
    for (change, key) in changes {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        change(&mut scene);
        let refused = LumpedModel::from_scene(&scene).unwrap_err().to_string();
        assert!(refused.contains(key), "{key}: {refused}");
    }
}

/// Degrees taken for radians are refused; the negative angles of a mirrored set are not.
#[test]
fn pressure_angles_are_below_a_right_angle() {
    let with = |angle: f64| {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        scene.lumped.as_mut().unwrap().pressure_angle_rad.sun_planet = angle;
        LumpedModel::from_scene(&scene).map(|_| ())
    };
    assert_eq!(with(-0.43), Ok(()));
    for wrong in [24.6, f64::NAN] {
        let refused = with(wrong).unwrap_err().to_string();
        assert!(refused.contains("lumped.pressure_angle_deg.sun_planet"), "{refused}");
    }
}
