//! `compare`: lists of natural frequencies as others write them.

use serde_json::Value;

use super::harness::{csv_of_own_modes, json, keeps_to_schema, run, scene};

#[test]
fn compare_agrees_with_itself_and_not_with_the_published_spacing() {
    let own = csv_of_own_modes();
    let own = own.to_str().unwrap();
    let (code, out, _) = run(&["compare", own, "--scene", &scene("oh58_4p.toml")]);
    assert_eq!(code, 0, "{out}");
    let (code, out, _) = run(&["compare", own, "--scene", &scene("oh58_3p.toml")]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("the model has no such mode"), "{out}");
}

#[test]
fn compare_takes_letter_case_an_index_column_and_a_table_that_ends() {
    let folder = tempfile::tempdir().unwrap();
    let set = scene("oh58_4p_as_published.toml");
    let compared = |text: &str, more: &[&str]| {
        let path = folder.path().join("modes.csv");
        std::fs::write(&path, text).unwrap();
        let mut all = vec!["compare", path.to_str().unwrap(), "--scene", &set];
        all.extend(more);
        run(&all)
    };
    // As pandas writes it.
    let table =
        ",Frequency_Hz,Mode_Type,Multiplicity\n0,774.08,Translational,2\n1,1150.19,ROTATIONAL,\n";
    let (code, out, err) = compared(table, &["--tolerance-percent", "1.5"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("above the list's highest frequency"), "{out}");
    let (code, ..) = compared(table, &["--tolerance-percent", "1.5", "--whole"]);
    assert_eq!(code, 1);
    // As a spreadsheet of another country writes it, in another unit and with a column more.
    let table =
        "\u{feff}frequency_khz;type;note\n0,77408;translational;a\n0,77408;translational;b\n";
    let (code, out, err) = compared(table, &["--tolerance-percent", "1.5"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("`note`") && out.contains("times 1000"), "{out}");
}

#[test]
fn compare_takes_the_rows_of_its_scene_from_a_results_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("modes.csv");
    let text = "scene,frequency_hz\noh58_4p_as_published,768.75\nlin_parker_1999_3p,743.164\n";
    std::fs::write(&path, text).unwrap();
    let set = scene("oh58_4p_as_published.toml");
    let (code, out, err) = run(&["compare", path.to_str().unwrap(), "--scene", &set]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("1 rows are of other scenes and left out"), "{out}");
}

#[test]
fn bad_tables_of_modes_name_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("hz\n1\n", "modes.csv:1: column `frequency_hz` is absent"),
        ("frequency_hz\nabc\n", "modes.csv:2: column `frequency_hz` is `abc`"),
        ("frequency_hz\n-1\n", "modes.csv:2: column `frequency_hz` is `-1`"),
        ("frequency_hz,mode_type\n1,wobble\n", "modes.csv:2: column `mode_type` is `wobble`"),
        ("frequency_hz,multiplicity\n1,0\n", "modes.csv:2: column `multiplicity` is `0`"),
        ("frequency_hz\n", "no rows"),
        ("", "no rows"),
        ("frequency_hz,mode_type\n1150,rotational\n1150,rotational\n", "modes.csv:2 and"),
    ];
    for (text, words) in cases {
        let path = folder.path().join("modes.csv");
        std::fs::write(&path, text).unwrap();
        let set = scene("oh58_4p.toml");
        let (code, _, err) = run(&["compare", path.to_str().unwrap(), "--scene", &set]);
        assert_eq!(code, 2, "{text}");
        assert!(err.contains(words), "{err}");
    }
}

#[test]
fn a_list_in_another_unit_is_told_which() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("modes.csv");
    let path = path.to_str().unwrap();
    // With a floating sun, ring and carrier that turn together at 0 Hz.
    let set = scene("lin_parker_1999_4p.toml");
    let own = json(&["modes", &set, "--format", "json"]);
    let own: Vec<f64> = own["modes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| m["frequency_hz"].as_f64().unwrap())
        .collect();
    let compared = |factor: f64, list: &[f64]| {
        let rows: String = list.iter().map(|hz| format!("{:.4}\n", factor * hz)).collect();
        std::fs::write(path, format!("frequency_hz\n{rows}")).unwrap();
        run(&["compare", path, "--scene", &set])
    };
    let as_json = || {
        let (_, out, err) = run(&["compare", path, "--scene", &set, "--format", "json"]);
        let found: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{e}: {out}{err}"));
        keeps_to_schema("compare", &found);
        found
    };
    let elastic: Vec<f64> = own.into_iter().filter(|hz| *hz > 1.0).collect();
    let few = &elastic[..2];
    for (factor, unit, column) in [
        (1e-3, "kHz", "frequency_khz"),
        (std::f64::consts::TAU, "rad/s", "frequency_rad_per_s"),
        (60.0, "1/min", "frequency_rpm"),
    ] {
        let (code, out, err) = compared(factor, few);
        assert_eq!(code, 1, "{out}{err}");
        let hint = format!(
            "the list likely is in {unit}: 2 of 2 would agree with its column called `{column}`"
        );
        assert!(out.contains(&hint), "{out}");
        let found = as_json();
        assert_eq!(found["likely_unit"]["unit"], unit);
        assert_eq!(found["likely_unit"]["agreed"], 2);
    }
    // In Hz, of one mode only, and wrong in every unit.
    for (factor, list) in [(1.0, few), (1e-3, &elastic[..1]), (3.0, few)] {
        let (_, out, err) = compared(factor, list);
        assert!(!out.contains("likely"), "{out}{err}");
        let found = as_json();
        assert!(found.get("likely_unit").is_none(), "{found}");
    }
}
