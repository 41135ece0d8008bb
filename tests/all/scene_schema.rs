//! The JSON schema of scene files and the page of their keys.

use std::path::Path;

use scene::{SceneKind, template};
use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Faults the schema finds in a scene file.
fn faults(text: &str) -> Vec<String> {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    assert_eq!(epicyclic::run(["epicyclic", "scene", "schema"], &mut out, &mut err), 0);
    let schema: Value = serde_json::from_slice(&out).unwrap();
    let scene: toml::Table = text.parse().unwrap();
    let scene = serde_json::to_value(scene).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    validator.iter_errors(&scene).map(|e| format!("{}: {e}", e.instance_path())).collect()
}

#[test]
fn it_admits_every_shipped_scene_and_the_templates() {
    let mut count = 0;
    for entry in std::fs::read_dir(root().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        let found = faults(&std::fs::read_to_string(&path).unwrap());
        assert!(found.is_empty(), "{}: {found:?}", path.display());
        count += 1;
    }
    assert!(count >= 14);
    for kind in [SceneKind::Planetary, SceneKind::GearPair] {
        assert!(faults(template(kind)).is_empty());
        assert!(template(kind).starts_with("#:schema ./scene.schema.json\n"));
    }
}

#[test]
fn it_refuses_misspelt_keys_wrong_types_and_values_and_missing_keys() {
    let cases = [
        ("speed_rpm = 1600", "speed_rmp = 1600", "speed_rmp"),
        ("speed_rpm = 1600", "speed_rpm = \"fast\"", "/operation/speed_rpm"),
        ("count = 4", "count = 4.5", "/planets/count"),
        ("count = 4", "count = 65", "/planets/count"),
        ("motion = \"held\"", "motion = \"hold\"", "/ring/motion"),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.5", "/material/poisson_ratio"),
        ("face_width_mm = 25.4", "", "face_width_mm"),
        ("tip_diameter_mm = 84.07", "tip_diameter_mm = 0.0", "/geometry/sun/tip_diameter_mm"),
        ("title = \"A planetary set\"", "title = \"\\u001b[2J\"", "/title"),
    ];
    for (from, to, words) in cases {
        let text = template(SceneKind::Planetary);
        assert!(text.contains(from));
        let found = faults(&text.replacen(from, to, 1));
        assert!(found.iter().any(|fault| fault.contains(words)), "{from}: {found:?}");
    }
}

#[test]
fn the_page_of_keys_is_the_list() {
    let path = root().join("docs/scene_keys.md");
    let page = scene::scene_key_page();
    if std::env::var("INSTA_UPDATE").is_ok_and(|v| v == "always") {
        std::fs::write(&path, &page).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == page, "docs/scene_keys.md is stale: regenerate the snapshots");
}
