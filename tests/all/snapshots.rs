//! The benchmark itself: the numbers of every verb, held in `snapshots/` and compared through the
//! tolerance declared for each kind of number.
//!
//! `INSTA_UPDATE=always cargo test --release --test all -- --include-ignored snapshots` regenerates them (and the
//! schemas); numbers within tolerance keep their stored digits, so the diff shows only what changed.

use std::path::Path;

use insta::Comparator;
use insta::internals::SnapshotContents;
use insta::{Settings, Snapshot};
use serde_json::Value;
use validation::{Figure, Ledger};

/// Relative tolerance of numbers whose key contains this text; the longest match counts.
const RELATIVE: [(&str, f64); 18] = [
    // Frequencies and geometry: an eigenvalue solver's rounding is 1e-13.
    ("", 1e-9),
    // Shares and sensitivities depend on eigenvectors, which are less accurate at close frequencies.
    ("energy", 1e-7),
    ("sensitivity", 1e-7),
    ("participation", 1e-7),
    // Contact: whether a cell at the edge of the patch touches may depend on rounding.
    ("force_n", 1e-6),
    ("_um", 1e-6),
    ("_urad", 1e-6),
    ("stiffness", 1e-5),
    ("pressure", 1e-5),
    // Identified from transients: which of several equally good orders is taken depends on rounding.
    ("identified", 1e-6),
    ("identification/order", 0.5),
    ("identified/shares", 1e-3),
    ("linearised/shares", 1e-5),
    // 100 times a relative difference, about 1e-4, of identified frequencies.
    ("difference_percent", 0.05),
    ("force_change", 1e-4),
    // Of values that agree to a thousandth, and depend on contact as above.
    ("quantities/rows/value", 1e-6),
    ("quantities/rows", 1e-3),
    ("quantities/truth", 1e-3),
];

/// Largest drift of a checked value, as a share of the tolerance it is judged by.
const DRIFT: f64 = 1e-3;

/// Numbers this small are zero: shares, phases and rigid-body frequencies.
const ZERO: f64 = 1e-9;

/// Keys whose numbers are rounding noise: only an upper limit is checked.
const NOISE: [(&str, f64); 4] = [
    ("residual", 1e-12),
    ("worst_residual", 1e-10),
    ("nonlinearity", 1e-6),
    // At carrier speeds frequencies near 0 are the roots of rounding errors.
    ("uncertainty_hz", 1e-3),
];

/// Checks whose value is what the last correction of a steady state leaves, which depends on rounding: only an upper
/// limit is checked, a tenth of the tolerance that they are judged by.
const LEFT_OVER: [(&str, f64); 2] = [("sweep.forbidden.", 1e-9), ("sweep.between.", 1e-17)];

struct Tolerant;

impl Comparator for Tolerant {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        let parse = |s: &Snapshot| match s.contents() {
            SnapshotContents::Text(text) => serde_json::from_str::<Value>(&text.to_string()).ok(),
            SnapshotContents::Binary(_) => None,
        };
        match (parse(reference), parse(test)) {
            (Some(a), Some(b)) => same("", &a, &b),
            _ => false,
        }
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(Self)
    }
}

/// Whether two JSON trees agree; `key` is the path so far.
fn same(key: &str, a: &Value, b: &Value) -> bool {
    match (a, b) {
        // A check: its value may drift by a small part of its own tolerance.
        (Value::Object(a), Value::Object(b)) if a.contains_key("tolerance") => {
            let number = |check: &serde_json::Map<String, Value>| check["actual"].as_f64();
            let drift = a["tolerance"]["absolute"].as_f64().map_or(0.0, |t| DRIFT * t);
            let id = a.get("id").and_then(Value::as_str).unwrap_or_default();
            let left_over = LEFT_OVER.iter().find(|(own, _)| id.starts_with(own));
            let is_same = match (number(a), number(b)) {
                (Some(x), Some(y))
                    if left_over.is_some_and(|(_, limit)| x.abs().max(y.abs()) <= *limit) =>
                {
                    true
                }
                (Some(x), Some(y)) => (x - y).abs() <= drift + 1e-9 * x.abs(),
                _ => same(&format!("{key}/actual"), &a["actual"], &b["actual"]),
            };
            is_same
                && a.len() == b.len()
                && a.iter()
                    .filter(|(k, _)| *k != "actual" && *k != "difference_percent")
                    .all(|(k, x)| b.get(k).is_some_and(|y| same(&format!("{key}/{k}"), x, y)))
        }
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len()
                && a.iter()
                    .all(|(k, x)| b.get(k).is_some_and(|y| same(&format!("{key}/{k}"), x, y)))
        }
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(x, y)| same(key, x, y))
        }
        (Value::Number(x), Value::Number(y)) => {
            let (Some(x), Some(y)) = (x.as_f64(), y.as_f64()) else { return false };
            if let Some((_, limit)) = NOISE.iter().rev().find(|(k, _)| key.ends_with(k)) {
                return x.abs() <= *limit && y.abs() <= *limit;
            }
            let matches = RELATIVE.iter().filter(|(k, _)| key.contains(k));
            let relative = matches.max_by_key(|(k, _)| k.len()).map_or(0.0, |m| m.1);
            (x - y).abs() <= relative * x.abs().max(y.abs()) + ZERO
        }
        _ => a == b,
    }
}

fn assert_json(name: &str, arguments: &[&str]) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let all = std::iter::once("epicyclic").chain(arguments.iter().copied());
    let code = epicyclic::run(all.chain(["--format", "json"]), &mut out, &mut err);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&err));
    assert_text(name, String::from_utf8(out).unwrap());
}

fn assert_text(name: &str, text: String) {
    let mut settings = Settings::clone_current();
    settings.set_snapshot_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_comparator(Box::new(Tolerant));
    settings.bind(|| insta::assert_snapshot!(name, text));
}

fn scene(name: &str) -> String {
    format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// The verdict that the main command of the README wrote, or where `EPICYCLIC_VERDICT` names no file one made here.
#[test]
#[ignore = "as long as the main command: .ci/run holds the verdict of that command against the snapshot"]
fn verdict() {
    match std::env::var("EPICYCLIC_VERDICT") {
        Ok(path) => assert_text("verdict", std::fs::read_to_string(&path).unwrap()),
        Err(_) => assert_json("verdict", &["validate"]),
    }
}

/// The kept verdict, with which the test above compares.
fn kept_verdict() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots/verdict.snap");
    let text = std::fs::read_to_string(path).unwrap();
    let body = text.splitn(3, "---\n").nth(2).unwrap();
    serde_json::from_str(body).unwrap()
}

#[test]
fn the_counts_in_the_readme_are_those_of_the_verdict() {
    let verdict = kept_verdict();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = std::fs::read_to_string(path).unwrap();
    let (passed, failed, missed) = (&verdict["passed"], &verdict["failed"], &verdict["missed"]);
    let words = format!("{passed} checks pass, {failed} fail, {missed} published value");
    assert!(readme.contains(&words), "README.md should say: {words}");
}

/// The page of assumptions is the ledger with the kept verdict's figures, and names checks that exist.
#[test]
fn the_ledger_of_assumptions_has_the_figures_of_the_verdict() {
    let verdict = kept_verdict();
    let checks = verdict["checks"].as_array().unwrap();
    let figure = |id: &str| {
        let check = checks.iter().find(|check| check["id"] == id);
        let check = check.unwrap_or_else(|| panic!("the ledger names {id}, which is no check"));
        Some(Figure {
            actual: check["actual"].as_f64()?,
            unit: check["unit"].as_str()?.to_owned(),
            tolerance: check["tolerance"]["absolute"].as_f64()?,
        })
    };
    let page = Ledger::load().unwrap().page(&figure);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/assumptions.md");
    let kept = std::fs::read_to_string(path).unwrap();
    // Numbers differ between machines by rounding and are compared by the test above.
    let words = |text: &str| -> Vec<String> {
        let is_word = |word: &&str| word.parse::<f64>().is_err();
        text.split_whitespace().filter(is_word).map(String::from).collect()
    };
    assert!(words(&page) == words(&kept), "docs/assumptions.md is stale: regenerate it");
}

#[test]
fn ids_of_checks_are_unique() {
    let verdict = kept_verdict();
    let checks = verdict["checks"].as_array().unwrap();
    let mut ids: Vec<&str> = checks.iter().map(|c| c["id"].as_str().unwrap()).collect();
    let before = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), before);
}

#[test]
fn modes() {
    for name in [
        "oh58_4p",
        "oh58_3p",
        "oh58_4p_as_published",
        "oh58_3p_as_published",
        "coinciding_modes",
        "lin_parker_1999_4p",
        "lin_parker_1999_3p",
        "five_planets",
        "oh58_4p_second_system",
    ] {
        assert_json(&format!("modes_{name}"), &["modes", &scene(name)]);
    }
}

#[test]
fn campbell() {
    let arguments = ["modes", &scene("oh58_4p"), "--carrier-speeds-rpm", "0,267.857,535.714"];
    assert_json("campbell_oh58_4p", &arguments);
}

#[test]
fn stability() {
    assert_json("stability_explicit_step", &["stability", "explicit-step"]);
    assert_json("stability_list", &["stability"]);
}

/// A study without its times.
#[test]
fn study() {
    let file = format!("{}/studies/first.toml", env!("CARGO_MANIFEST_DIR"));
    let (code, out, err) = super::harness::run(&["study", &file, "--format", "json"]);
    assert_eq!(code, 0, "{err}");
    let mut result: Value = serde_json::from_str(&out).unwrap();
    super::study_command::without_times(&mut result);
    assert_text("study_first", serde_json::to_string_pretty(&result).unwrap());
}

#[test]
fn rules() {
    for name in ["oh58_4p", "oh58_3p", "five_planets"] {
        assert_json(&format!("rules_{name}"), &["rules", &scene(name)]);
    }
}

#[test]
fn statics() {
    for name in ["oh58_sun_planet_pair", "oh58_ring_planet_pair"] {
        let scene = scene(name);
        let arguments = ["static", &scene, "--normal-force-n", "10700.67", "--positions", "12"];
        assert_json(&format!("static_{name}"), &arguments);
    }
    let scene = scene("oh58_4p");
    let arguments = ["static", &scene, "--sun-torque-nm", "1413", "--positions", "4"];
    assert_json("static_oh58_4p", &arguments);
}

#[test]
fn impulse() {
    let scene = scene("oh58_4p");
    let arguments = ["impulse", &scene, "--sun-torque-nm", "1130", "--duration-ms", "20"];
    assert_json("impulse_oh58_4p", &arguments);
}

#[test]
fn meshes() {
    assert_json("mesh_oh58_4p", &["mesh", &scene("oh58_4p")]);
}

#[test]
fn scenes() {
    for name in
        ["oh58_4p", "oh58_3p", "oh58_sun_planet_pair", "oh58_ring_planet_pair", "five_planets"]
    {
        assert_json(&format!("scene_{name}"), &["scene", "check", &scene(name)]);
    }
}

#[test]
fn schemas() {
    let update = std::env::var("INSTA_UPDATE").is_ok_and(|v| v == "always");
    for (name, schema) in epicyclic::schemas() {
        let path = format!("{}/schemas/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        if update {
            std::fs::write(&path, &text).unwrap();
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(stored == text, "schemas/{name}.json is stale: regenerate the snapshots");
    }
}

/// The picture of the README is one the command draws.
#[test]
fn picture_of_the_readme() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().to_str().unwrap();
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = ["epicyclic", "validate", "--only", "table3.", "--report", report];
    assert_eq!(epicyclic::run(arguments, &mut out, &mut err), 0);
    let drawn = std::fs::read_to_string(folder.path().join("campbell_4p.svg")).unwrap();
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/campbell_4p.svg");
    if std::env::var("INSTA_UPDATE").is_ok_and(|v| v == "always") {
        std::fs::write(&kept, &drawn).unwrap();
    }
    // Text and number of marks; coordinates may differ in their last digit between platforms.
    let kept = std::fs::read_to_string(kept).unwrap();
    for mark in ["<circle", "<path", "<text", "Resonances"] {
        assert_eq!(drawn.matches(mark).count(), kept.matches(mark).count(), "{mark}");
    }
}

#[test]
fn the_comparator_can_tell_a_difference() {
    let value = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let base = value(r#"{"modes":[{"frequency_hz":770.0,"mode_type":"planet"}],"residual":1e-15}"#);
    for (text, expected) in [
        (
            r#"{"modes":[{"frequency_hz":770.0000000001,"mode_type":"planet"}],"residual":9e-15}"#,
            true,
        ),
        (r#"{"modes":[{"frequency_hz":770.0001,"mode_type":"planet"}],"residual":1e-15}"#, false),
        (r#"{"modes":[{"frequency_hz":770.0,"mode_type":"mixed"}],"residual":1e-15}"#, false),
        (r#"{"modes":[{"frequency_hz":770.0,"mode_type":"planet"}],"residual":1e-9}"#, false),
        (r#"{"modes":[],"residual":1e-15}"#, false),
    ] {
        assert_eq!(same("", &base, &value(text)), expected, "{text}");
    }
}
