//! Machines that are not driven through the sun, through every verb that turns or loads them.

use serde_json::Value;

use crate::harness::{json, run, scene};

const TRANSMISSION: &str = "automatic_transmission_set.toml";
const TURBINE: &str = "wind_turbine_stage.toml";

fn of(verb: &[&str], name: &str) -> Value {
    let path = scene(name);
    json(&[verb, &[path.as_str(), "--format", "json"]].concat())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Speeds and torques by hand: Z_s ω_s + Z_r ω_r = (Z_s + Z_r) ω_c and T_s : T_r : T_c = Z_s : Z_r : −(Z_s + Z_r).
#[test]
fn scene_check_has_speeds_and_torques_of_all_members() {
    let motion = &of(&["scene", "check"], TRANSMISSION)["motion"];
    assert_eq!(number(&motion["speeds_rpm"]["sun"]), 0.0);
    assert!((number(&motion["speeds_rpm"]["carrier"]) - 2000.0 * 99.0 / 120.0).abs() < 1e-9);
    assert!((number(&motion["torques_nm"]["sun"]) - 900.0 * 21.0 / 99.0).abs() < 1e-9);
    assert!((number(&motion["torques_nm"]["carrier"]) + 900.0 * 120.0 / 99.0).abs() < 1e-9);
    assert_eq!(motion["pairs_run"], "backward");
    assert_eq!(motion["torque_acts_on"], "ring");
    assert_eq!(of(&["scene", "check"], TURBINE)["motion"]["torque_acts_on"], "sun");
    let (_, text, _) = run(&["scene", "check", &scene(TURBINE)]);
    assert!(text.contains("the carrier drives, the ring stands still"), "{text}");
    assert!(text.contains("from the end of the path of contact to its start"), "{text}");
}

#[test]
fn a_held_sun_is_loaded_through_the_ring() {
    let found = json(&["static", &scene(TRANSMISSION), "--positions", "20", "--format", "json"]);
    let torque = &found["torques"][0];
    assert_eq!(torque["torque_acts_on"], "ring");
    for (member, teeth) in [("sun", 21.0), ("ring", 99.0), ("carrier", -120.0)] {
        let expected = 900.0 / 99.0 * teeth;
        let off = number(&torque["member_torques_nm"][member]) / expected - 1.0;
        assert!(off.abs() < 3e-4, "{member}: {off:e}");
    }
    // T_s/(r_b N) in every mesh.
    let mean = 900.0 * 21.0 / 99.0 / (0.5 * 49.3339e-3) / 4.0;
    for mesh in torque["meshes"].as_array().unwrap() {
        assert!((number(&mesh["mean_force_n"]) / mean - 1.0).abs() < 1e-3, "{mesh}");
    }
    for position in torque["positions"].as_array().unwrap() {
        assert_eq!(number(&position["sun"]["rotation_urad"]), 0.0);
        assert!(number(&position["ring"]["rotation_urad"]) > 0.0);
    }
}

/// The operating point says that the ring stands still, the supports let it alone turn.
#[test]
fn supports_that_contradict_the_operating_point_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene(TRANSMISSION)).unwrap();
    let path = folder.path().join("contradiction.toml");
    let text =
        text.replace("fixed = \"sun\"\ninput = \"ring\"", "fixed = \"ring\"\ninput = \"sun\"");
    std::fs::write(&path, text).unwrap();
    for verb in ["static", "impulse", "sweep"] {
        let (code, _, text) = run(&[verb, path.to_str().unwrap()]);
        assert_eq!(code, 2, "{verb}");
        assert!(text.contains("`operation.fixed`: it is \"ring\""), "{text}");
    }
}

/// −σ Z_s ψ_n/2π, whichever way the torque acts.
#[test]
fn scene_check_has_mesh_phases_as_they_follow_in_time() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("oh58_4p.toml")).unwrap();
    let forward = [0.0, 27.0 / 42.0, 0.5, 6.0 / 42.0];
    for (speed, torque) in [(1600i32, 1413), (1600, -1413), (-1600, 1413), (-1600, -1413)] {
        let text = text
            .replace("speed_rpm = 1600", &format!("speed_rpm = {speed}"))
            .replace("torque_nm = 1413", &format!("torque_nm = {torque}"));
        let path = folder.path().join("machine.toml");
        std::fs::write(&path, text).unwrap();
        let found = json(&["scene", "check", path.to_str().unwrap(), "--format", "json"]);
        for (n, forward) in forward.iter().enumerate() {
            let expected = (f64::from(speed.signum()) * forward).rem_euclid(1.0);
            let off = number(&found["sun_mesh_phases"][n]) - expected;
            assert!((off - off.round()).abs() < 1e-9, "{speed} rpm, {torque} N·m: {found}");
        }
    }
}
