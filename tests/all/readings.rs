//! What tables say to a reader beside their JSON: instability, and the reasons of tolerances by check.

use serde_json::Value;

use crate::harness::{coarse, run, scene};

/// The table of frequencies over carrier speed says which speeds are unstable, as JSON does.
#[test]
fn the_table_over_carrier_speed_says_what_is_unstable() {
    let set = scene("oh58_4p.toml");
    let at = |format: &str| {
        let speeds = "--carrier-speeds-rpm=0,20000,100000";
        let (code, out, err) = run(&["modes", &set, speeds, "--format", format]);
        assert_eq!(code, 0, "{err}");
        out
    };
    let json: Value = serde_json::from_str(&at("json")).unwrap();
    let unstable: Vec<bool> = json["campbell"]
        .as_array()
        .unwrap()
        .iter()
        .map(|entry| entry["is_unstable"].as_bool().unwrap())
        .collect();
    assert_eq!(unstable, [false, false, true]);
    let text = at("text");
    let lines: Vec<&str> = text.lines().collect();
    // What is said of a speed, up to the next one.
    let speeds = lines.iter().skip_while(|line| !line.starts_with("carrier at "));
    let mut said: Vec<bool> = Vec::new();
    for line in speeds {
        if line.starts_with("carrier at ") {
            said.push(false);
        }
        if let (Some(last), true) = (said.last_mut(), line.contains("unstable: a mode grows")) {
            *last = true;
        }
    }
    assert_eq!(said, unstable, "{text}");
}

/// The report's table of reasons names checks, not their numbers: every check of the run is in one of its rows.
#[test]
fn reasons_of_tolerances_stand_by_check() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().to_str().unwrap();
    let (code, out, err) =
        run(&["validate", "--only", "table1.", "--format", "json", "--report", report]);
    assert_eq!(code, 0, "{err}");
    let checks: Value = serde_json::from_str(&out).unwrap();
    let text = std::fs::read_to_string(folder.path().join("verdict.md")).unwrap();
    let (_, reasons) = text.split_once("| checks | tolerance | reason |").unwrap();
    let rows: Vec<&str> = reasons.lines().filter(|line| line.starts_with("| ")).collect();
    let mut ids = checks["checks"].as_array().unwrap().iter().map(|c| c["id"].as_str().unwrap());
    assert!(rows.len() > 5, "{reasons}");
    for row in rows {
        // `id`, or `first to last (n)` for n neighbours with one reason.
        let named = row.trim_start_matches("| ").split(" |").next().unwrap();
        let words: Vec<&str> = named.split(' ').collect();
        let count = match words[..] {
            [_] => 1,
            [_, "to", _, count] => count.trim_matches(['(', ')']).parse().unwrap(),
            _ => panic!("{row}"),
        };
        let own: Vec<&str> = ids.by_ref().take(count).collect();
        assert_eq!((own[0], own.len()), (words[0], count), "{row}");
        assert!(words.len() == 1 || own[count - 1] == words[2], "{row}");
    }
    assert_eq!(ids.next(), None, "{reasons}");
}

/// Headings of the tables in a text: the lines above a rule that follows a line of words.
fn headings(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let is_rule = |line: &str| line.starts_with('─');
    let heads = (1..lines.len()).filter(|&i| is_rule(lines[i]) && lines[i - 1].contains("  "));
    // The rule below a table follows its last row: only every second one stands below a heading.
    let heads = heads.step_by(2).flat_map(|i| lines[i - 1].split("  "));
    heads.map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()).collect()
}

/// Every column of the tables of meshes and of modal tests is explained below them.
#[test]
fn columns_of_meshes_and_modal_tests_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    let set = coarse(folder.path(), "oh58_4p.toml");
    for (line, count, plain) in [
        (format!("mesh {set}"), 16, vec!["body"]),
        // The share of rotation explains the other two.
        (format!("impulse {set} --duration-ms 10"), 15, vec!["type", "pulse", "transl.", "planet"]),
    ] {
        let (code, text, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(code, 0, "{err}");
        let names = headings(&text);
        assert!(names.len() >= count, "{names:?}");
        for name in names.iter().filter(|name| !plain.contains(&name.as_str())) {
            assert!(
                text.lines().any(|line| line.starts_with(&format!("{name}: "))),
                "{name}: {text}"
            );
        }
    }
}

/// A torque in the scene acts on the input member, and `--sun-torque-nm` on the sun: with the carrier driven the two
/// differ by 1 + z_ring/z_sun, and with either the sun carries the same.
#[test]
fn torques_of_scene_and_command_line_name_their_member() {
    let folder = tempfile::tempdir().unwrap();
    let path = coarse(folder.path(), "oh58_4p.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let at_the_sun = |text: &str, more: &[&str]| {
        std::fs::write(&path, text).unwrap();
        let line = ["static", &path, "--positions", "1", "--format", "json"];
        let (code, out, err) = run(&[&line, more].concat());
        assert_eq!(code, 0, "{err}");
        let result: Value = serde_json::from_str(&out).unwrap();
        let cycle = &result["torques"][0];
        let force = cycle["meshes"][0]["mean_force_n"].as_f64().unwrap();
        (cycle["sun_torque_nm"].as_f64().unwrap(), force)
    };
    assert!(text.contains("input = \"sun\"") && text.contains("torque_nm = 1413"), "{text}");
    let driven = at_the_sun(&text, &[]);
    // 27 teeth of the sun, 99 of the ring, which is fixed.
    let carrier = text
        .replace("input = \"sun\"", "input = \"carrier\"")
        .replace("torque_nm = 1413", &format!("torque_nm = {}", 1413.0 * (1.0 + 99.0 / 27.0)));
    let (torque, force) = at_the_sun(&carrier, &[]);
    assert!((torque.abs() / 1413.0 - 1.0).abs() < 1e-12 && driven.0 == 1413.0, "{torque}");
    let (_, asked) = at_the_sun(&carrier, &["--sun-torque-nm", &torque.to_string()]);
    assert!((asked / force - 1.0).abs() < 1e-9, "{asked} {force}");
    assert!(force > 5000.0 && driven.1 > 5000.0);
}
