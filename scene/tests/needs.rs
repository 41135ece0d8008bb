//! What each verb needs of a scene, and what it lacks.

use scene::{Fidelity, Scene, SceneKind, Verb, template};

fn keys(changes: &[(&str, &str)], kind: SceneKind, verb: Verb) -> Vec<String> {
    let mut text = template(kind).to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let scene = Scene::from_toml(&text).unwrap();
    scene.lacks(verb).into_iter().map(|lack| lack.key).collect()
}

#[test]
fn the_template_lacks_nothing() {
    for verb in Verb::ALL {
        assert!(keys(&[], SceneKind::Planetary, verb).is_empty(), "{}", verb.name());
    }
}

/// The meshes of two planets do not hold the centre of a sun without bearing; those of three do.
#[test]
fn a_sun_on_two_planets_needs_a_bearing() {
    let lacks = |planets: u32, verb: Verb| {
        let scene = Scene::from_toml(&format!(
            "format = 1\nkind = \"planetary\"\nplanets.count = {planets}\n\
             teeth = {{ sun = 30, planet = 40, ring = 110 }}\n\
             geometry = {{ rack.module_mm = 10, face_width_mm = 230 }}\noperation.torque_nm = 20000\n"
        ));
        let lacks = scene.unwrap().lacks(verb).into_iter().map(|lack| lack.key);
        lacks.collect::<Vec<_>>()
    };
    for verb in [Verb::Static, Verb::Impulse, Verb::Sweep(Fidelity::QuasiStatic)] {
        assert_eq!(lacks(2, verb), ["sun.bearing_n_per_m"], "{verb:?}");
        assert_eq!(lacks(1, verb), ["sun.bearing_n_per_m"], "{verb:?}");
        assert!(lacks(4, verb).is_empty(), "{verb:?}");
    }
}

#[test]
fn one_mesh_alone_is_meshed_and_loaded_by_a_force() {
    for verb in Verb::ALL {
        let expected: &[&str] = match verb {
            Verb::Mesh => &[],
            Verb::Static => &["operation.torque_nm"],
            Verb::Modes => &["lumped"],
            Verb::Rules | Verb::Compare => &["kind"],
            Verb::Impulse => &["operation.torque_nm"],
            // A rotation without stiffness, beside elastic states.
            Verb::Sweep(Fidelity::Modal(_) | Fidelity::Full)
            | Verb::Branches(Fidelity::Modal(_)) => {
                &["operation", "operation.torque_nm", "planet.torsional_nm_per_rad"]
            }
            Verb::Sweep(_) | Verb::Branches(_) => &["operation", "operation.torque_nm"],
        };
        assert_eq!(keys(&[], SceneKind::GearPair, verb), expected, "{}", verb.name());
    }
}

#[test]
fn a_rigid_carrier_needs_a_mass_from_somewhere() {
    let text = template(SceneKind::Planetary);
    let (head, tail) = text.split_once("[geometry.carrier]").unwrap();
    let no_shape =
        format!("{head}[geometry.thickness]{}", tail.split_once("[geometry.thickness]").unwrap().1);
    let (head, tail) = no_shape.split_once("[lumped]").unwrap();
    let bare = format!("{head}[damping]{}", tail.split_once("[damping]").unwrap().1);
    let lacks = |text: &str, verb| -> Vec<String> {
        Scene::from_toml(text).unwrap().lacks(verb).into_iter().map(|l| l.key).collect()
    };
    for fidelity in [Fidelity::MeshLaw, Fidelity::QuasiStatic, Fidelity::Modal(1), Fidelity::Full] {
        assert_eq!(lacks(&bare, Verb::Sweep(fidelity)), ["geometry.carrier"]);
        assert!(lacks(&no_shape, Verb::Sweep(fidelity)).is_empty());
    }
    // No derivative of the steps of every degree of freedom.
    assert_eq!(lacks(&no_shape, Verb::Branches(Fidelity::Full)), ["dynamics.fidelity"]);
    assert_eq!(lacks(&bare, Verb::Impulse), ["geometry.carrier"]);
    assert!(lacks(&bare, Verb::Static).is_empty());
    // Closed forms need the shape as well.
    assert_eq!(lacks(&bare, Verb::Modes), ["geometry.carrier"]);
    let held =
        bare.replace("motion = \"rotation_held\"\nbearing_n_per_m = 87.6e6", "motion = \"held\"");
    assert!(lacks(&held, Verb::Impulse).is_empty());
}

#[test]
fn torques_need_a_path_and_modes_do_not() {
    let held = [("motion = \"free\"", "motion = \"rotation_held\"")];
    for verb in Verb::ALL {
        let expected: &[&str] = match verb {
            Verb::Static | Verb::Impulse | Verb::Sweep(_) | Verb::Branches(_) => &["sun.motion"],
            _ => &[],
        };
        assert_eq!(keys(&held, SceneKind::Planetary, verb), expected, "{}", verb.name());
    }
}

#[test]
fn branches_need_damping_and_a_derivative_of_the_steps() {
    let undamped = [
        ("mass_proportional_per_s = 142.9", "mass_proportional_per_s = 0"),
        ("stiffness_proportional_s = 2.21e-6", "stiffness_proportional_s = 0"),
    ];
    let in_bearings =
        [undamped[0], (undamped[1].0, "stiffness_proportional_s = 0\nbearing_s = 1e-5")];
    let exact = [("kinematics = \"about_mean\"", "kinematics = \"exact\"")];
    for verb in Verb::ALL {
        let is_branches = matches!(verb, Verb::Branches(_));
        let of = |changes: &[(&str, &str)]| keys(changes, SceneKind::Planetary, verb);
        let expected: &[&str] =
            if is_branches { &["damping.mass_proportional_per_s"] } else { &[] };
        assert_eq!(of(&undamped), expected, "{}", verb.name());
        // Planets move on their bearings.
        assert!(of(&in_bearings).is_empty(), "{}", verb.name());
        // Of the fidelities only quasi-static bodies follow exact kinematics, and that without a derivative.
        let expected: &[&str] = match verb {
            Verb::Sweep(Fidelity::QuasiStatic) => &[],
            Verb::Sweep(_) | Verb::Branches(_) => &["dynamics.kinematics"],
            _ => &[],
        };
        assert_eq!(of(&exact), expected, "{}", verb.name());
    }
}
