//! What a practitioner's scene gets from the command: loads by keys, refusals of what would change nothing, few
//! warnings, tables that a spreadsheet does not compute.

use std::path::Path;

use crate::harness::{coarse, run, scene};

/// A copy of a text in a folder.
fn file(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// T/r_b of the key and the same force as an argument are one load, of any sign of the torque.
#[test]
fn the_torque_of_a_pair_loads_it_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let path = coarse(folder.path(), "pair_50_50.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let torque = 150.0;
    let (code, by_key, err) = run(&["static", &path, "--positions", "2", "--format", "json"]);
    assert_eq!(code, 0, "{err}");
    let result: serde_json::Value = serde_json::from_str(&by_key).unwrap();
    let geometry = scene::Scene::from_toml(&text).unwrap().tooth_geometry().unwrap();
    let force = torque / geometry.sun.unwrap().base_radius;
    assert_eq!(result["normal_force_n"].as_f64().unwrap(), force);
    let given = format!("{force:?}");
    let arguments =
        ["static", &path, "--positions", "2", "--normal-force-n", &given, "--format", "json"];
    assert_eq!(run(&arguments).1, by_key);
    let braked = file(
        folder.path(),
        "braked.toml",
        &text.replace("torque_nm = 150.0", "torque_nm = -150.0"),
    );
    assert_eq!(run(&["static", &braked, "--positions", "2", "--format", "json"]).1, by_key);
    let none =
        file(folder.path(), "none.toml", &text.replace("torque_nm = 150.0", "torque_nm = 0.0"));
    let (code, _, err) = run(&["static", &none, "--positions", "2"]);
    assert!(
        code == 2 && err.contains("operation.torque_nm") && err.contains("--normal-force-n"),
        "{err}"
    );
}

/// A planet of three times the mass, a mesh softened by a crack: refused by key where all planets are meshed alike.
#[test]
fn planets_that_differ_are_refused_where_they_would_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("oh58_4p.toml")).unwrap();
    let with = |line: &str| {
        file(
            folder.path(),
            "one.toml",
            &format!("{text}\n[[planet_override]]\nplanet = 1\n{line}\n"),
        )
    };
    for verb in [
        &["static"] as &[&str],
        &["impulse"],
        &["sweep"],
        &["branches", "--speeds-rpm", "900:1000"],
    ] {
        let path = with("mass_kg = 2.0");
        let (code, out, err) = run(&[verb, &[path.as_str()] as &[&str]].concat());
        assert_eq!((code, out.as_str()), (2, ""), "{verb:?}");
        assert!(err.contains("`planet_override.0.mass_kg`"), "{verb:?}: {err}");
    }
}

/// One heavier planet is one line; of two frequencies that coincide none says "heavier by 0".
#[test]
fn unequal_planets_are_one_warning() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("five_planets.toml")).unwrap();
    let path = file(
        folder.path(),
        "one.toml",
        &format!("{text}\n[[planet_override]]\nplanet = 1\nmass_kg = 0.665\n"),
    );
    let (code, _, err) = run(&["modes", &path]);
    assert_eq!(code, 0, "{err}");
    let of_types: Vec<&str> =
        err.lines().filter(|line| line.contains("mixed") || line.contains("heavier")).collect();
    assert!(of_types.len() <= 2 && err.matches("listed as mixed").count() == 1, "{err}");
    let (_, _, err) = run(&["modes", &scene("coinciding_modes.toml")]);
    assert!(err.contains("lie so close") && !err.contains("0.0e0"), "{err}");
}

/// A title that a spreadsheet would compute stands as text in the table.
#[test]
fn a_title_is_no_formula() {
    let folder = tempfile::tempdir().unwrap();
    let path = coarse(folder.path(), "oh58_4p.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let title = text.lines().find(|line| line.starts_with("title")).unwrap();
    let path = file(folder.path(), "formula.toml", &text.replace(title, "title = \"=1+1\""));
    let sweep = [
        "--speeds-rpm",
        "2000:2000:1",
        "--model",
        "lumped",
        "--tolerance",
        "1e-3",
        "--format",
        "csv",
    ];
    let (code, out, err) = run(&[&["sweep", path.as_str()] as &[&str], &sweep].concat());
    assert_eq!(code, 0, "{err}");
    assert!(out.lines().nth(1).unwrap().starts_with("'=1+1,"), "{out}");
    assert!(
        out.lines().skip(1).all(|line| line.split(',').nth(2).unwrap().parse::<f64>().is_ok()),
        "{out}"
    );
}

/// Mesh cycles of more than 2 GiB are refused before anything is computed, and the refusal says what fits.
#[test]
fn large_mesh_cycles_need_to_be_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let set = scene("oh58_4p.toml");
    let with = |table: &str, line: &str| {
        let text = std::fs::read_to_string(&set).unwrap();
        file(folder.path(), "large.toml", &format!("{text}\n[{table}]\n{line}\n"))
    };
    // 24 pairs of 40 × 40 cells are 307 kB a position: 2 GiB hold 6990.
    let (code, _, err) = run(&["static", &set, "--positions", "20000"]);
    assert!(code == 2 && err.contains("5.7 GiB") && err.contains("6990 positions"), "{err}");
    let cells = with("fe_contact", "contact_cells = 400");
    let (code, _, err) = run(&["static", &cells]);
    assert!(code == 2 && err.contains("282 cells") && err.contains("--large"), "{err}");
    let steps = with("dynamics", "steps_per_cycle = 10000");
    for verb in [&["sweep"] as &[&str], &["branches", "--speeds-rpm", "900:1000"]] {
        let (code, _, err) = run(&[verb, &[steps.as_str()] as &[&str]].concat());
        assert!(
            code == 2 && err.contains("`dynamics.steps_per_cycle`") && err.contains("--large"),
            "{err}"
        );
    }
}

/// Runs of more than a day are refused before anything is computed, and the refusal says what fits.
#[test]
fn runs_of_more_than_a_day_need_to_be_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let set = scene("oh58_4p.toml");
    let torques = vec!["1000"; 5000].join(",");
    let speeds = ["--speeds-rpm", "500:2500:0.1", "--random-starts", "99"];
    for (line, dial) in [
        (
            [
                &["static", &set, "--positions", "6000", "--sun-torque-nm"],
                &[torques.as_str()] as &[&str],
            ],
            "positions",
        ),
        ([&["sweep", &set], &speeds as &[&str]], "random starts"),
    ] {
        let (code, out, err) = run(&line.concat());
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(
            err.contains(" h on one core") && err.contains("24 h") && err.contains("--large"),
            "{err}"
        );
        assert!(err.contains(&format!("{dial} (")), "{dial}: {err}");
    }
    // A fault that is found after the limits: with the argument they are not in its way.
    let taken = folder.path().join("taken");
    std::fs::create_dir(&taken).unwrap();
    std::fs::write(taken.join("sweep.csv"), "").unwrap();
    let out = ["--large", "--out", taken.to_str().unwrap()];
    let (code, _, err) = run(&[&["sweep", &set] as &[&str], &speeds, &out].concat());
    assert!(code == 2 && !err.contains("24 h") && err.contains("taken"), "{err}");
}

/// Bodies of more than 2 GiB are refused, and every verb that makes them takes the argument that allows them.
#[test]
fn large_bodies_need_to_be_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("oh58_4p.toml")).unwrap();
    let text = format!("{text}\n[fe_contact]\nflank_elements = 64\n");
    let fine = file(folder.path(), "fine.toml", &text);
    for verb in [
        &["mesh"] as &[&str],
        &["static"],
        &["impulse"],
        &["sweep"],
        &["branches", "--speeds-rpm", "900:1000"],
    ] {
        let (code, _, err) = run(&[verb, &[fine.as_str()] as &[&str]].concat());
        let is_told = err.contains("`fe_contact.flank_elements`") && err.contains("--large");
        assert!(code == 2 && is_told, "{verb:?}: {err}");
        let (code, out, _) = run(&[verb[0], "--help"]);
        assert!(code == 0 && out.contains("--large"), "{verb:?}: {out}");
    }
    let (code, out, err) = run(&["scene", "check", &fine]);
    assert!(code == 0 && out.contains("or argument --large"), "{out}{err}");
}
