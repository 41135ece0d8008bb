//! Scenes along which no branch is followed: refused by their keys, before anything is computed.

use crate::harness::{coarse, json, run, scene};

/// A pair with these tables instead of its own.
fn pair(folder: &std::path::Path, name: &str, tables: &str) -> String {
    let text = std::fs::read_to_string(scene("pair_50_50.toml")).unwrap();
    let mut table: toml::Table = text.parse().unwrap();
    for (key, own) in tables.parse::<toml::Table>().unwrap() {
        table.insert(key, own);
    }
    let path = folder.join(name);
    std::fs::write(&path, toml::to_string(&table).unwrap()).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Without damping periodic motions are not isolated: no branch exists over any parameter but a damping itself.
#[test]
fn scenes_without_damping_have_no_branches() {
    let folder = tempfile::tempdir().unwrap();
    let none = "[damping]\nmass_proportional_per_s = 0\nstiffness_proportional_s = 0\n";
    let bearings = format!("{none}bearing_s = 1e-5\n");
    let (bare, in_bearings) =
        (pair(folder.path(), "bare.toml", none), pair(folder.path(), "bearings.toml", &bearings));
    for file in [&bare, &in_bearings] {
        for over in [
            "--speeds-rpm 2000:2100",
            "--over damping --damping-factors 0.5:1 --rpm 3000",
            "--over torque --torques-nm 100:150 --rpm 3000",
            "--over sun.inertia_kg_m2 --from 7e-3 --to 8e-3 --rpm 3000",
            // Of a pair whose rotations are both free the bearings do not move.
            "--over damping.bearing_s --from 1e-6 --to 1e-5 --rpm 3000",
        ] {
            let line = format!("branches {file} {over}");
            let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
            assert_eq!((code, out.as_str()), (2, ""), "{line}");
            let words = [
                "`damping.mass_proportional_per_s`",
                "`damping.stiffness_proportional_s`",
                "isolated",
            ];
            assert!(words.iter().all(|word| err.contains(word)), "{line}: {err}");
            assert_eq!(err.lines().filter(|l| l.starts_with("error")).count(), 1, "{err}");
        }
    }
    let over =
        "--over damping.mass_proportional_per_s --from 1000 --to 1300 --rpm 3000 --max-points 2";
    let line = format!("branches {bare} {over} --format json");
    let found = json(&line.split(' ').collect::<Vec<_>>());
    assert!(!found["branches"][0]["points"].as_array().unwrap().is_empty());
    let checked = json(&["scene", "check", &bare, "--format", "json"]);
    let verbs = checked["verbs"].as_array().unwrap();
    let own = verbs.iter().find(|v| v["verb"] == "branches (mesh_law)").unwrap();
    assert_eq!(own["lacks"][0]["key"], "damping.mass_proportional_per_s");
}

/// Exact kinematics have no derivative: the key is named before anything is computed, `scene check` knows it, and the
/// lumped model, whose meshes are tabulated, has one all the same.
#[test]
fn exact_kinematics_have_no_branches() {
    let folder = tempfile::tempdir().unwrap();
    let tables = "[dynamics]\nfidelity = \"quasi_static\"\nkinematics = \"exact\"\n";
    let file = pair(folder.path(), "exact.toml", tables);
    let (code, out, err) = run(&["branches", &file, "--speeds-rpm", "2000:2100"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("`dynamics.kinematics`") && err.contains("about_mean"), "{err}");
    let checked = json(&["scene", "check", &file, "--format", "json"]);
    let verbs = checked["verbs"].as_array().unwrap();
    let lacking = |verb: &str| {
        let own = verbs.iter().find(|v| v["verb"] == verb).unwrap_or_else(|| panic!("{verb}"));
        own["lacks"].as_array().unwrap().iter().any(|lack| lack["key"] == "dynamics.kinematics")
    };
    assert!(lacking("branches (quasi_static)") && !lacking("sweep (quasi_static)"));
    // The scene could not name these fidelities beside exact kinematics.
    for verb in ["sweep (mesh_law)", "sweep (modal)", "sweep (full)", "branches (modal)"] {
        assert!(lacking(verb), "{verb}");
    }
    let set = coarse(folder.path(), "oh58_4p.toml");
    let text = std::fs::read_to_string(&set).unwrap();
    std::fs::write(&set, text + "[dynamics]\nkinematics = \"exact\"\n").unwrap();
    let line = format!(
        "branches {set} --speeds-rpm 2500:2510 --model lumped --max-points 2 --format json"
    );
    let found = json(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(found["branches"][0]["points"].as_array().unwrap().len(), 2);
}

/// A support so soft that the pair has no equilibrium on it: the key, its values and the remedy stand in the message.
#[test]
fn values_of_a_key_without_a_motion_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let tables = "[dynamics]\nfidelity = \"mesh_law\"\n[fe_contact]\nflank_elements = 8\n";
    let file = pair(folder.path(), "soft.toml", tables);
    let line =
        format!("branches {file} --over planet.torsional_n_per_m --from 1e3 --to 1e4 --rpm 3000");
    let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!((code, out.as_str()), (2, ""), "{err}");
    let words =
        ["--over", "planet.torsional_n_per_m from 1000.0 to 10000.0", "take stiffer values"];
    assert!(words.iter().all(|word| err.contains(word)), "{err}");
}

/// Maps of planets are refused for a gear pair by its kind.
#[test]
fn maps_of_planets_need_a_planetary_set() {
    let file = scene("pair_50_50.toml");
    for map in ["linear-kinematics", "mode-types", "spacing"] {
        let (code, out, err) = run(&["stability", map, "--scene", &file]);
        assert_eq!((code, out.as_str()), (2, ""), "{map}");
        assert!(err.contains("`kind`") && err.contains("\"planetary\" is needed"), "{map}: {err}");
    }
}
