//! `scene check`: what verbs lack, against what they refuse; warnings; tip relief; control characters.

use scene::{SceneKind, template};
use serde_json::Value;

use super::harness::{run, sentences};

/// Writes a scene; the name of its file.
fn written(folder: &tempfile::TempDir, text: &str) -> String {
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn check(name: &str) -> Value {
    let (code, out, err) = run(&["scene", "check", name, "--format", "json"]);
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

/// The planetary template, on coarse meshes, without some tables and with some text replaced.
fn mutilated(tables: &[&str], changes: &[(&str, &str)]) -> String {
    let mut text = template(SceneKind::Planetary).to_owned();
    for (from, to) in [
        ("element = \"quadratic\"", "element = \"linear\""),
        ("flank_elements = 14", "flank_elements = 6"),
        ("contact_cells = 40", "contact_cells = 40"),
        ("steps_per_cycle = 140", "steps_per_cycle = 16"),
    ]
    .iter()
    .chain(changes)
    {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let mut kept = String::new();
    let mut is_left_out = false;
    for line in text.lines() {
        if line.starts_with('[') {
            is_left_out = tables.iter().any(|t| line.starts_with(&format!("[{t}]")));
        }
        if !is_left_out {
            kept += line;
            kept.push('\n');
        }
    }
    kept
}

const SHAPE: [&str; 6] = [
    "geometry",
    "geometry.sun",
    "geometry.planet",
    "geometry.ring",
    "geometry.carrier",
    "geometry.thickness",
];

/// Scenes that each lack something, by name.
fn scenes() -> Vec<(&'static str, String)> {
    let own_angles = "pressure_angle_deg = { sun_planet = 24.6, ring_planet = 20.2 }\n\
        radius_mm = { sun = 35.2, planet = 45.6, ring = 129.1, carrier = 88.9 }";
    let angles = ("# pressure_angle_deg = { sun_planet = 24.6, ring_planet = 24.6 }", own_angles);
    let no_teeth = [&SHAPE[..], &["teeth"]].concat();
    let step = ("position_steps = [0, -31, 63, 32]", "positions_deg = [0, -90, 180, 90]");
    vec![
        ("whole", mutilated(&[], &[])),
        ("no lumped", mutilated(&["lumped"], &[])),
        ("no operation", mutilated(&["operation"], &[])),
        ("no torque", mutilated(&[], &[("torque_nm = 1413", "torque_nm = 0")])),
        ("no geometry", mutilated(&SHAPE, &[angles])),
        ("no teeth", mutilated(&no_teeth, &[angles, step])),
        ("no carrier shape", mutilated(&["geometry.carrier"], &[])),
        ("no bore", mutilated(&[], &[("bore_diameter_mm = 57.15\n", "")])),
        (
            "sharp root",
            mutilated(&[], &[("fillet_radius_mm = 0.8   ", "fillet_radius_mm = 0.0   ")]),
        ),
        ("few elements", mutilated(&[], &[("flank_elements = 6", "flank_elements = 4")])),
        ("many elements", mutilated(&[], &[("flank_elements = 6", "flank_elements = 64")])),
        ("mesh law", mutilated(&[], &[("fidelity = \"quasi_static\"", "fidelity = \"mesh_law\"")])),
        (
            "gear pair",
            template(SceneKind::GearPair).replace("flank_elements = 14", "flank_elements = 6"),
        ),
        ("gear pair without bore", {
            template(SceneKind::GearPair).replace("bore_diameter_mm = 57.15\n", "")
        }),
    ]
}

/// Scenes whose lack the verbs saw only in the middle of their work.
fn late_scenes() -> Vec<(&'static str, String)> {
    let no_mass = ["geometry.carrier", "lumped"];
    vec![
        ("carrier without mass", mutilated(&no_mass, &[])),
        ("sun held", mutilated(&[], &[("motion = \"free\"", "motion = \"rotation_held\"")])),
        ("carrier free", mutilated(&[], &[("motion = \"rotation_held\"", "motion = \"free\"")])),
    ]
}

/// Runs every verb on a scene and compares with what `scene check` says of it.
fn compare_with_verbs(what: &str, text: &str) {
    let folder = tempfile::tempdir().unwrap();
    let name = &written(&folder, text);
    let list = folder.path().join("modes.csv");
    std::fs::write(&list, "frequency_hz\n1000\n").unwrap();
    let list = list.display().to_string();
    let summary = check(name);
    let fidelity = match text.contains("fidelity = \"mesh_law\"") {
        true => "sweep (mesh_law)",
        false => "sweep (quasi_static)",
    };
    let runs: [(&str, Vec<&str>, bool); 7] = [
        ("modes", vec!["modes", name], true),
        ("rules", vec!["rules", name], true),
        ("compare", vec!["compare", &list, "--scene", name], true),
        ("mesh", vec!["mesh", name], true),
        ("static", vec!["static", name, "--positions", "1"], true),
        ("impulse", vec!["impulse", name], false),
        (fidelity, vec!["sweep", name], false),
    ];
    for (verb, arguments, is_cheap) in runs {
        let verbs = summary["verbs"].as_array().unwrap();
        let entry = verbs.iter().find(|v| v["verb"] == verb).unwrap();
        let lacks = entry["lacks"].as_array().unwrap();
        if lacks.is_empty() {
            if is_cheap {
                let (code, _, err) = run(&arguments);
                assert!(code <= 1, "{what}, {verb}: {err}");
            }
            continue;
        }
        let (code, out, err) = run(&arguments);
        assert!(code == 2 && out.is_empty(), "{what}, {verb}: {code} {lacks:?}");
        let key = |lack: &Value| lack["key"].as_str().unwrap().to_owned();
        let argument = |lack: &Value| lack["argument"].as_str().unwrap_or("no such").to_owned();
        let is_named = lacks.iter().any(|l| err.contains(&key(l)) || err.contains(&argument(l)));
        assert!(is_named, "{what}, {verb}: {lacks:?} {err}");
        // With the argument that stands in for the key a verb runs.
        if entry["runs"] == true && verb == "static" {
            let argument = lacks[0]["argument"].as_str().unwrap();
            let (code, _, err) = run(&[&arguments[..], &[argument, "1000"]].concat());
            assert_eq!(code, 0, "{what}, {verb}: {err}");
        }
    }
}

#[test]
fn what_verbs_lack_is_what_they_refuse() {
    for (what, text) in scenes() {
        compare_with_verbs(what, &text);
    }
}

#[test]
fn what_verbs_lack_is_refused_before_any_work() {
    for (what, text) in late_scenes() {
        // Bodies of this size are refused where the work begins: a refusal that names the key came before.
        let fine = text.replace("flank_elements = 6", "flank_elements = 64");
        assert!(fine != text);
        compare_with_verbs(what, &fine);
    }
}

#[test]
fn it_says_verb_by_verb_what_is_lacking() {
    let folder = tempfile::tempdir().unwrap();
    let (_, text) = &late_scenes()[0];
    let (code, out, _) = run(&["scene", "check", &written(&folder, text)]);
    assert_eq!(code, 0);
    for words in [
        "verbs that run: rules, mesh, static ",
        "modes, compare cannot run: `geometry.carrier`: ",
        "; or numbers in [lumped], which are then taken from there",
        "branches (modal) cannot run: `geometry.carrier`: ",
    ] {
        assert!(sentences(&out).contains(words), "{words}: {out}");
    }
}

#[test]
fn warnings_as_text_and_json() {
    let folder = tempfile::tempdir().unwrap();
    let text = mutilated(&[], &[("{ sun = 0.40,", "{ sun = 400.0,")]);
    let name = &written(&folder, &text);
    let (_, out, _) = run(&["scene", "check", name]);
    assert!(out.contains("warning: `lumped.mass_kg.sun` is 400: a disc"), "{out}");
    let result = check(name);
    let keys: Vec<&str> =
        result["warnings"].as_array().unwrap().iter().map(|w| w["key"].as_str().unwrap()).collect();
    // The scenes of these tests have bilinear elements.
    assert_eq!(keys, ["lumped.mass_kg.sun", "fe_contact.element"]);
}

#[test]
fn tip_relief_is_shown_for_each_gear_that_has_it() {
    let folder = tempfile::tempdir().unwrap();
    let relief =
        "# tip_relief = { start_diameter_mm = 82.0, amount_um = 10.0, shape = \"linear\" }";
    let text = mutilated(&[], &[(relief, &relief[2..])]);
    let name = &written(&folder, &text);
    let (_, out, _) = run(&["scene", "check", name]);
    assert!(
        out.contains("sun: linear tip relief of 10.000 µm from diameter 82.0000 mm, over "),
        "{out}"
    );
    assert_eq!(out.matches("tip relief of").count(), 1);
    let gears = &check(name)["gears"];
    let relief = &gears[0]["tip_relief"];
    // √(41² − 35.2003²) mm
    assert!((relief["start_roll_length_mm"].as_f64().unwrap() - 21.0218).abs() < 1e-3, "{relief}");
    let share = relief["relieved_share"].as_f64().unwrap();
    assert!(share > 0.0 && share < 0.3, "{share}");
    assert!(gears[1]["tip_relief"].is_null());
}

#[test]
fn escape_sequences_of_a_scene_do_not_reach_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let title = "title = \"A planetary set\"";
    for bad in [
        "title = \"a\\u001b[2Jb\"",
        "title = \"a\\nb\"",
        "title = \"a\u{1b}[2J\"",
        "\"t\\u001b[2J\" = 1",
        "\u{1b}[31m = 1",
    ] {
        let name = written(&folder, &mutilated(&[], &[(title, bad)]));
        let (code, out, err) = run(&["scene", "check", &name]);
        assert!(code == 2 && out.is_empty());
        // Colours of the message itself are no part of the file.
        for sequence in ["\u{1b}[2J", "\u{1b}[31m = 1"] {
            assert!(!err.contains(sequence), "{err:?}");
        }
    }
}

#[test]
fn what_follows_from_six_numbers_and_what_is_taken_for_zero_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let six = "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = { sun = 18, planet = 36, ring = 93 }\n\
        [geometry]\ncenter_distance_mm = 584.0\nrack.module_mm = 21.0\nface_width_mm = 550.0\n\
        thickness.profile_shift = { sun = 0.3890, planet = 0.5039, ring = -0.1171 }\n[operation]\ntorque_nm = 162105.5\n";
    let name = written(&folder, six);
    let (code, out, err) = run(&["scene", "check", &name]);
    assert_eq!(code, 0, "{err}");
    let lines = sentences(&out);
    for words in [
        "chosen: `geometry.ring.root_diameter_mm` = 2000.5818: m (Z + 2 h_fP + 2x)",
        "chosen: `ring.motion` = \"held\": the torque acts on the sun",
        "note: backlash −0.0005 mm of the sun_planet mesh lies within the rounding",
    ] {
        assert!(lines.contains(words), "{words} is not in {out}");
    }
    assert!(!out.contains("-0.0000"), "{out}");
    let summary = check(&name);
    assert_eq!(summary["rounding"].as_array().unwrap().len(), 2);
    assert!(
        summary["chosen"].as_array().unwrap().iter().any(|c| c["key"] == "operation.speed_rpm")
    );
    // Verbs remark the sign of the ring's shift as well.
    let slip = written(&folder, &six.replace("-0.1171", "0.1171"));
    let (code, _, err) = run(&["modes", &slip]);
    assert!(code == 0 && err.contains("ring_sign"), "{err}");
}
