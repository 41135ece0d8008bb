//! What tables say to a reader beside their JSON: instability, and the reasons of tolerances by check.

use serde_json::Value;

use crate::command::{run, scene};

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
    let rows: Vec<usize> =
        (0..lines.len()).filter(|&i| lines[i].starts_with("carrier at ")).collect();
    let said: Vec<bool> = rows
        .iter()
        .map(|i| lines.get(i + 1).is_some_and(|line| line.contains("unstable: a mode grows")))
        .collect();
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
