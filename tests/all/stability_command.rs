//! `stability`: what it writes, and what it refuses.

use serde_json::Value;

use super::harness::{json, run, scene};

#[test]
fn stability_maps_that_are_none_are_refused() {
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    let bare = scene("lin_parker_1999_4p.toml");
    for (line, named) in [
        ("stability tongues".to_owned(), "bouncing-bar"),
        (format!("stability bouncing-bar --scene {set}"), "--scene"),
        (format!("stability --scene {set}"), "--scene"),
        ("stability --out out".to_owned(), "--out"),
        (format!("stability parametric --scene {pair}"), "lumped"),
        (format!("stability parametric --scene {bare}"), "teeth"),
        (format!("stability explicit-step --scene {bare}"), "operation"),
        ("stability parametric --scene none.toml".to_owned(), "none.toml"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(named), "{line}: {err}");
    }
}

#[test]
fn a_stability_map_writes_its_table_and_its_figure() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("maps");
    let result =
        json(&["stability", "explicit-step", "--format", "json", "--out", out.to_str().unwrap()]);
    for file in ["explicit-step.json", "explicit-step.csv", "stability_explicit_step.svg"] {
        assert!(out.join(file).metadata().unwrap().len() > 100, "{file}");
    }
    let text = std::fs::read_to_string(out.join("explicit-step.json")).unwrap();
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), result);
    // Observed borders agree with theory within 1 %.
    for border in result["borders"].as_array().unwrap() {
        assert!(border["difference_percent"].as_f64().unwrap().abs() < 1.0, "{border}");
    }
}
