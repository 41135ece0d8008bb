//! The lumped model with parameters from FE where the two models must be equal: signs, inertias, senses.

use experiments::modal::{Preload, agreement, lumped_from_fe};
use fe_contact::statics::Bodies;
use gearset::MeshKind;
use validation::{PublishedScene, scene};

#[test]
fn where_all_pairs_press_along_the_line_of_action_the_models_are_one() {
    let mut three = scene(PublishedScene::Oh58ThreePlanets).unwrap();
    three.fe_contact.flank_elements = 10;
    let bodies = Bodies::new(&three).unwrap();
    let at = |torque_nm| Preload {
        load: scene::LoadCase::standing(torque_nm),
        position: 0.0,
        step_s: 5e-6,
    };
    // Both senses of torque, which load opposite flanks.
    for torque in [1130.0, -1130.0] {
        let found = agreement(&three, &bodies, &at(torque)).unwrap();
        assert_eq!(found.modes, 2 + 3 + 9);
        assert!(found.along_the_line_percent.abs() < 1e-9, "{}", found.along_the_line_percent);
        // The slopes of the deformed flanks rotate the force of every pair slightly; no corner contact
        // presses.
        assert!(found.worst_percent.abs() < 0.2, "{}", found.worst_percent);
    }
    let from_fe = lumped_from_fe(&three, &bodies, &at(1130.0)).unwrap();
    let lumped = from_fe.lumped.as_ref().unwrap();
    let planet = &bodies.planet;
    let r = bodies.geometry.planet.base_radius;
    assert_eq!(lumped.mass_kg.planet, Some(planet.mass));
    assert!(
        (lumped.inertia_over_r2_kg.planet.unwrap() * r * r / planet.inertia - 1.0).abs() < 1e-14
    );
    let angle = bodies.geometry.mesh(MeshKind::RingPlanet).unwrap().pressure_angle;
    // The loaded planets have orbited by some 0.2 mm on an arm of 89 mm, which rotates the lines of centres.
    let moved = (lumped.pressure_angle_rad.ring_planet - angle).abs();
    assert!(moved > 0.0 && moved < 5e-3, "{moved}");
    // All meshes are in phase, hence equally stiff; the range is that of steel teeth one inch wide.
    for own in &from_fe.overrides {
        for (k, first) in [
            (own.sun_mesh_n_per_m, from_fe.overrides[0].sun_mesh_n_per_m),
            (own.ring_mesh_n_per_m, from_fe.overrides[0].ring_mesh_n_per_m),
        ] {
            let (k, first) = (k.unwrap(), first.unwrap());
            assert!((k / first - 1.0).abs() < 1e-6 && (4e8..1.2e9).contains(&k), "{k}");
        }
    }
}
