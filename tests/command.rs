//! The command as a user meets it: results on stdout, one clear message and exit code 2 for bad
//! input, JSON that keeps to its schema.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn scene(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).display().to_string()
}

/// Exit code, stdout and stderr of one in-process run.
fn run(arguments: &[&str]) -> (u8, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let all = std::iter::once("epicyclic").chain(arguments.iter().copied());
    let code = epicyclic::run(all, &mut out, &mut err);
    (code, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
}

fn json(arguments: &[&str]) -> Value {
    let (code, out, err) = run(arguments);
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

#[test]
fn modes_of_oh58_as_json() {
    let result = json(&["modes", &scene("oh58_4p.toml"), "--format", "json"]);
    let modes = result["modes"].as_array().unwrap();
    let of = |kind: &str| -> Vec<f64> {
        let own = modes.iter().filter(|m| m["mode_type"] == kind);
        own.map(|m| m["frequency_hz"].as_f64().unwrap()).collect()
    };
    let near = |found: Vec<f64>, expected: &[f64]| {
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= 0.3, "{f} {e}");
        }
    };
    near(of("translational"), &[770.7, 778.6, 1715.8, 1724.5, 2169.8, 2175.0]);
    near(of("rotational"), &[1150.2, 1788.5]);
    near(of("planet"), &[1710.4]);
    assert!(of("mixed").is_empty());
    let all: u64 = modes.iter().map(|m| m["multiplicity"].as_u64().unwrap()).sum();
    assert_eq!(all, 17);
}

#[test]
fn every_json_output_keeps_to_its_schema() {
    let modes = csv_of_own_modes();
    let set = scene("oh58_4p.toml");
    let runs: [(&str, Vec<&str>); 5] = [
        ("validate", vec!["validate"]),
        ("modes", vec!["modes", &set, "--carrier-speeds-rpm", "0,535.7"]),
        ("rules", vec!["rules", &set]),
        ("scene_check", vec!["scene", "check", &set]),
        ("compare", vec!["compare", modes.to_str().unwrap(), "--scene", &set]),
    ];
    for (name, mut arguments) in runs {
        arguments.extend(["--format", "json"]);
        let result = json(&arguments);
        let path = format!("{}/schemas/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let schema: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let validator = jsonschema::validator_for(&schema).unwrap();
        let faults: Vec<_> = validator.iter_errors(&result).map(|e| e.to_string()).collect();
        assert!(faults.is_empty(), "{name}: {faults:?}");
    }
}

/// The model's own modes as somebody else's list.
fn csv_of_own_modes() -> PathBuf {
    let result = json(&["modes", &scene("oh58_4p.toml"), "--format", "json"]);
    let mut text = String::from("frequency_hz,mode_type\n");
    for m in result["modes"].as_array().unwrap() {
        text += &format!("{},{}\n", m["frequency_hz"], m["mode_type"].as_str().unwrap());
    }
    let path = std::env::temp_dir().join(format!("epicyclic-own-modes-{}.csv", std::process::id()));
    std::fs::write(&path, text).unwrap();
    path
}

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
fn bad_tables_of_modes_name_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("hz\n1\n", "`hz` is not known"),
        ("frequency_hz\nabc\n", "line 2, `frequency_hz` is `abc`"),
        ("frequency_hz\n-1\n", "line 2, `frequency_hz` is `-1`"),
        ("frequency_hz,mode_type\n1,wobble\n", "line 2, `mode_type` is `wobble`"),
        ("frequency_hz,multiplicity\n1,0\n", "line 2, `multiplicity` is `0`"),
        ("frequency_hz\n", "no rows"),
        ("", "`frequency_hz` is absent"),
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
fn scenes_that_do_not_fit_a_verb_are_refused_with_the_key() {
    let cases = [
        (vec!["modes", "oh58_sun_planet_pair.toml"], "kind"),
        (vec!["rules", "oh58_ring_planet_pair.toml"], "kind"),
        (vec!["rules", "lin_parker_1999_4p.toml"], "teeth"),
    ];
    for (arguments, key) in cases {
        let (code, _, err) = run(&[arguments[0], &scene(arguments[1])]);
        assert_eq!(code, 2);
        assert!(err.contains(key), "{err}");
    }
    let (code, _, err) = run(&["modes", "no/such/scene.toml"]);
    assert_eq!(code, 2);
    assert!(err.contains("no/such/scene.toml"), "{err}");
    let (code, _, err) = run(&["rules", &scene("oh58_4p.toml"), "--harmonics", "0"]);
    assert_eq!(code, 2);
    assert!(err.contains("--harmonics"), "{err}");
}

#[test]
fn every_scene_of_the_repository_is_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let (code, _, err) = run(&["scene", "check", path.to_str().unwrap()]);
        assert_eq!(code, 0, "{err}");
        count += 1;
    }
    assert!(count >= 8);
}

#[test]
fn scene_new_writes_a_valid_scene_and_never_overwrites() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let path = path.to_str().unwrap();
    for kind in ["planetary", "gear-pair"] {
        let _ = std::fs::remove_file(path);
        assert_eq!(run(&["scene", "new", path, "--kind", kind]).0, 0);
        assert_eq!(run(&["scene", "check", path]).0, 0);
    }
    let (code, _, err) = run(&["scene", "new", path]);
    assert_eq!(code, 2);
    assert!(err.contains(path), "{err}");
}

#[test]
fn a_fault_is_shown_with_its_line_underlined() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.toml");
    let text = std::fs::read_to_string(scene("oh58_4p.toml")).unwrap();
    std::fs::write(&path, text.replace("poisson_ratio = 0.3", "poisson_ratio = 0.7")).unwrap();
    let (code, out, err) = run(&["modes", path.to_str().unwrap()]);
    assert_eq!((code, out.as_str()), (2, ""));
    for words in ["material.poisson_ratio", "0.7", "┬", "allowed"] {
        assert!(err.contains(words), "{err}");
    }
}

#[test]
fn the_binary_itself_prints_the_verdict_and_refuses_bad_input() {
    let binary = env!("CARGO_BIN_EXE_epicyclic");
    let good = Command::new(binary).arg("validate").output().unwrap();
    assert_eq!(good.status.code(), Some(0));
    let text = String::from_utf8(good.stdout).unwrap();
    assert!(text.contains("table3.lumped.6") && text.contains("0 failed"), "{text}");
    assert!(!text.contains('\u{1b}'), "colour off a terminal");
    let bad = Command::new(binary).args(["modes", "nowhere.toml"]).output().unwrap();
    assert_eq!(bad.status.code(), Some(2));
    assert!(bad.stdout.is_empty());
}

#[test]
fn the_counts_in_the_readme_are_those_of_the_verdict() {
    let verdict = validation::validate(validation::Profile::Quick, "").unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = std::fs::read_to_string(path).unwrap();
    let words = format!(
        "{} checks pass, {} fail, {} published value",
        verdict.passed, verdict.failed, verdict.missed
    );
    assert!(readme.contains(&words), "README.md should say: {words}");
}

#[test]
fn a_report_that_cannot_be_written_is_one_message() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let (code, _, err) = run(&["validate", "--report", file.path().to_str().unwrap()]);
    assert_eq!(code, 2);
    assert!(err.contains("cannot write"), "{err}");
}
