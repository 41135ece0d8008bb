//! Studies as a user meets them: a small one, and study files that are refused.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::harness::{keeps_to_schema, run, scene};

/// A study of some seconds.
pub(crate) fn small(folder: &Path) -> PathBuf {
    let text = format!(
        r#"
format = 1
title = "Contact cells"
scene = "{}"
sun_torque_nm = 1413
tolerance_percent = 2
rounds = 3
keys = {{ fe_contact.flank_elements = 6 }}
[[quantity]]
name = "peak to peak"
kind = "transmission_error_peak_to_peak"
positions = 4
[[quantity]]
name = "first frequency"
kind = "natural_frequency"
mode_type = "rotational"
number = 1
[[truth]]
name = "cells"
kind = "extrapolated"
key = "fe_contact.contact_cells"
values = [20, 40, 80]
[[series]]
name = "cells"
key = "fe_contact.contact_cells"
values = [14, 20]
[[setting]]
name = "lumped"
model = "lumped"
"#,
        scene("oh58_4p.toml")
    );
    let path = folder.join("small.toml");
    std::fs::write(&path, text).unwrap();
    path
}

/// A quantity of the small study, and one of growth with torque in its place.
const PEAK_TO_PEAK: &str = "kind = \"transmission_error_peak_to_peak\"\npositions = 4";

fn torque_ratio(more: &str) -> String {
    let kind = "kind = \"torque_ratio\"\npart = \"sun\"\nmotion = \"rotation\"\nharmonic = 2";
    format!("{kind}\nspeeds_rpm = [1600, 1630, 1660]\n{more}")
}

/// Takes away what depends on a clock.
pub(crate) fn without_times(value: &mut Value) {
    match value {
        Value::Object(map) => {
            map.remove("time");
            map.values_mut().for_each(without_times);
        }
        Value::Array(list) => list.iter_mut().for_each(without_times),
        _ => (),
    }
}

#[test]
fn a_study_gives_the_same_but_for_times_and_keeps_to_its_formats() {
    let folder = tempfile::tempdir().unwrap();
    let file = small(folder.path());
    let of = |out: &Path, format: &str| {
        let (file, out) = (file.to_str().unwrap(), out.to_str().unwrap());
        let (code, text, err) = run(&["study", file, "--out", out, "--format", format]);
        assert_eq!(code, 0, "{err}");
        text
    };
    let outs = ["first", "again"].map(|name| folder.path().join(name));
    let result: Value = serde_json::from_str(&of(&outs[0], "json")).unwrap();
    let text = of(&outs[1], "text");
    keeps_to_schema("study", &result);
    for name in ["small.json", "small.csv", "study_small.svg", "study_small.png"] {
        assert!(outs[0].join(name).metadata().unwrap().len() > 100, "{name}");
    }
    let [first, again] = outs.each_ref().map(|out| {
        let text = std::fs::read_to_string(out.join("small.json")).unwrap();
        let mut value: Value = serde_json::from_str(&text).unwrap();
        without_times(&mut value);
        value
    });
    assert_eq!(first, again);
    for (k, quantity) in result["quantities"].as_array().unwrap().iter().enumerate() {
        for row in quantity["rows"].as_array().unwrap() {
            // The lumped model has natural frequencies and no contact at rest.
            let is_refused = k == 0 && row["setting"] == "lumped";
            assert_eq!(row["refusal"].is_null(), !is_refused, "{row}");
            let cost = &row["time"]["cost_cycles"]["median"];
            assert_eq!(cost.as_f64().is_some_and(|c| c > 0.0), !is_refused, "{row}");
        }
    }
    let mut reader = csv::Reader::from_path(outs[0].join("small.csv")).unwrap();
    assert_eq!(reader.records().collect::<Result<Vec<_>, _>>().unwrap().len(), 6);
    assert!(text.contains("U = ") && text.contains("For peak to peak within 2 %"), "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

#[test]
fn faults_of_a_study_file_name_the_key_and_what_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(small(folder.path())).unwrap();
    let replaced = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    };
    for (text, named) in [
        (replaced("format = 1", "format = 2"), ["`format` is 2", "allowed: 1"]),
        (replaced("tolerance_percent = 2", "tolerance = 2"), ["tolerance", "expected one of"]),
        (
            replaced("tolerance_percent = 2", "tolerance_percent = 0"),
            ["tolerance_percent", "above 0"],
        ),
        (replaced("rounds = 3", "rounds = 2"), ["rounds", "from 3"]),
        (replaced("oh58_4p.toml", "none.toml"), ["`scene`", "none.toml"]),
        (replaced("positions = 4", "speed_rpm = 8"), ["speed_rpm", "positions"]),
        (replaced("number = 1\n", ""), ["number", "needs mode_type, number"]),
        (
            replaced("positions = 4", "reference_torque_nm = 8"),
            ["reference_torque_nm", "positions for this kind"],
        ),
        (
            replaced(PEAK_TO_PEAK, &torque_ratio("")),
            ["reference_torque_nm", "speeds_rpm, reference_torque_nm"],
        ),
        (
            replaced(PEAK_TO_PEAK, &torque_ratio("reference_torque_nm = 0")),
            ["reference_torque_nm", "other than 0"],
        ),
        (
            replaced(PEAK_TO_PEAK, &torque_ratio("reference_torque_nm = 1e9")),
            ["reference_torque_nm", "N·m"],
        ),
        (replaced("kind = \"extrapolated\"", "kind = \"guessed\""), ["guessed", "extrapolated"]),
        (replaced("values = [20, 40, 80]", "values = [40, 80]"), ["values", "three numbers"]),
        (replaced("values = [20, 40, 80]", "values = [160, 80, 40]"), ["values", "ascending"]),
        (replaced("key = \"fe_contact.contact_cells\"", "key = \"cells\""), ["key", "table_size"]),
        (
            replaced(
                "key = \"fe_contact.contact_cells\"",
                "integrator = \"bathe\"\nkey = \"fe_contact.contact_cells\"",
            ),
            ["integrator", "lumped"],
        ),
        (
            replaced("key = \"fe_contact.contact_cells\"", "key = \"fe_contact.cells\""),
            ["fe_contact.cells", "allowed"],
        ),
        (replaced("flank_elements = 6", "flank_elements = 1"), ["flank_elements", "3 to 64"]),
        (replaced("model = \"lumped\"", "model = \"beam\""), ["beam", "fe_contact"]),
        (replaced("name = \"lumped\"", "name = \"cells: 14\""), ["setting.name", "differ"]),
        (replaced("kind = \"extrapolated\"", "kind = \"kept\""), ["truth", "extrapolated"]),
        (format!("{text}\nsteady_tolerance = 1.0"), ["steady_tolerance", "1e-12"]),
        ("format = ".to_owned(), ["TOML", ""]),
        (replaced("rounds = 3", "rounds = -1"), ["`rounds` is -1", "a whole number from 3 to 999"]),
        (replaced("rounds = 3", "rounds = 0"), ["`rounds` is 0", "a whole number from 3 to 999"]),
        (replaced("format = 1", "format = \"1\""), ["`format` is \"1\"", "allowed: 1"]),
        (
            replaced("title = \"Contact cells\"\n", ""),
            ["`title` is absent", "a string of one line in quotes"],
        ),
        (
            replaced("tolerance_percent = 2", "tolerance_percent = \"2\""),
            ["`tolerance_percent` is \"2\"", "a finite number"],
        ),
        (text.replace("[[truth]]", "[truth]"), ["`truth` is a table", "an array of tables"]),
        (
            replaced("kind = \"natural_frequency\"\n", ""),
            ["`quantity \"first frequency\".kind` is absent", "a string"],
        ),
        (replaced("name = \"first frequency\"\n", ""), ["`quantity.1.name` is absent", "a string"]),
        (
            replaced("positions = 4", "positions = 4.5"),
            ["`quantity \"peak to peak\".positions` is 4.5", "a whole number"],
        ),
        (
            replaced("values = [14, 20]", "values = []"),
            ["`series \"cells\".values` is []", "two values or more"],
        ),
        (
            replaced("values = [14, 20]", "values = [10]"),
            ["`series \"cells\".values` is [10]", "two values or more"],
        ),
        (
            replaced("values = [14, 20]", "values = 14"),
            ["`series \"cells\".values` is 14", "a list of values"],
        ),
        (
            replaced("values = [14, 20]", "values = [40, 10]"),
            ["`series \"cells\".values` is [40, 10]", "ascending"],
        ),
        (
            text.replace("values = [14, 20]", "values = [1e-6, 1e-3]").replace(
                "[[series]]\nname = \"cells\"\nkey = \"fe_contact.contact_cells\"",
                "[[series]]\nname = \"t\"\nkey = \"steady_tolerance\"",
            ),
            ["`series \"t\".values` is", "descending"],
        ),
        (replaced("name = \"lumped\"", "name = \"\""), ["`setting.name` is \"\"", "not empty"]),
        (replaced("name = \"peak to peak\"", "name = \" \""), ["`quantity.name`", "not empty"]),
        (
            replaced("sun_torque_nm = 1413", "sun_torque_nm = 1e30"),
            ["`sun_torque_nm` is 1e30 N·m", "allowed is a magnitude below"],
        ),
        (
            replaced("positions = 4", "positions = 4\nsun_torque_nm = 1e-30"),
            ["`quantity \"peak to peak\".sun_torque_nm` is 1e-30 N·m", "magnitude above"],
        ),
    ] {
        let path = folder.path().join("faulty.toml");
        std::fs::write(&path, &text).unwrap();
        let (code, out, err) = run(&["study", path.to_str().unwrap()]);
        assert_eq!((code, out.as_str()), (2, ""), "{named:?}: {err}");
        assert!(named.iter().all(|word| err.contains(word)), "{named:?}: {err}");
    }
    let (code, _, err) = run(&["study", "none.toml"]);
    assert!(code == 2 && err.contains("none.toml"), "{err}");
}

/// Every study of the repository can be run: its files are there, its keys and scenes are valid.
#[test]
fn shipped_studies_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if let Err(error) = epicyclic::experiments::study::StudyFile::read(&path) {
            panic!("{}: {error}", path.display());
        }
        count += 1;
    }
    assert!(count >= 7, "{count}");
}
