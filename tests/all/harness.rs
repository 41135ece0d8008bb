//! Calls of the command inside the test's own process, and files to call it with.

use std::path::{Path, PathBuf};

use serde_json::Value;

pub(crate) fn scene(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).display().to_string()
}

/// Exit code, stdout and stderr of one in-process run.
pub(crate) fn run(arguments: &[&str]) -> (u8, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let all = std::iter::once("epicyclic").chain(arguments.iter().copied());
    let code = epicyclic::run(all, &mut out, &mut err);
    (code, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
}

/// A text with single spaces for all white space: sentences as they were before their lines were broken.
pub(crate) fn sentences(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The result as JSON of a call that succeeds.
pub(crate) fn json(arguments: &[&str]) -> Value {
    let (code, out, err) = run(arguments);
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

/// Holds a result against its schema in `schemas/`.
pub(crate) fn keeps_to_schema(name: &str, result: &Value) {
    let path = format!("{}/schemas/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let faults: Vec<_> = validator.iter_errors(result).map(|e| e.to_string()).collect();
    assert!(faults.is_empty(), "{name}: {faults:?}");
}

/// A scene of the repository with coarse meshes and patches.
pub(crate) fn coarse(folder: &Path, name: &str) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, text + "\n[fe_contact]\nflank_elements = 6\ncontact_cells = 20\n")
        .unwrap();
    path.to_str().unwrap().to_owned()
}

/// The model's own modes as a list to compare with.
pub(crate) fn csv_of_own_modes() -> PathBuf {
    let result = json(&["modes", &scene("oh58_4p.toml"), "--format", "json"]);
    let mut text = String::from("frequency_hz,mode_type\n");
    for m in result["modes"].as_array().unwrap() {
        text += &format!("{},{}\n", m["frequency_hz"], m["mode_type"].as_str().unwrap());
    }
    let path = std::env::temp_dir().join(format!("epicyclic-own-modes-{}.csv", std::process::id()));
    std::fs::write(&path, text).unwrap();
    path
}
