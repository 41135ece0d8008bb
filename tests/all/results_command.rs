//! `results new` and `results check`: folders that are ready to be filled, and what filled ones can be asked.

use std::path::Path;

use crate::harness::{keeps_to_schema, run, scene};

/// A results folder in `parent` with the lowest mode of a set, whose table of the paper a suite asks for.
pub(crate) fn results_folder(parent: &Path) -> String {
    let modes = "scene,frequency_hz,mode_type\noh58_4p_as_published,768.7,translational\n";
    with_modes(parent, modes)
}

fn with_modes(parent: &Path, modes: &str) -> String {
    let folder = parent.join("results");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("modes.csv"), modes).unwrap();
    folder.display().to_string()
}

#[test]
fn a_new_folder_is_complete_and_passes_nothing() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("mine");
    let path = folder.to_str().unwrap();
    let (code, out, err) = run(&["results", "new", "oh58_4p", path]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("oh58_4p_mirrored.toml") && out.contains("fe.sets"), "{out}");
    for line in [["results", "check", path], ["validate", "--recorded", path]] {
        let (code, out, err) = run(&line);
        assert_eq!((code, out.as_str()), (2, ""));
        assert!(err.contains("modes.csv:2: column `frequency_hz` is empty"), "{err}");
    }
    let (code, _, err) = run(&["results", "new", "oh58_3p", path]);
    assert_eq!(code, 2);
    assert!(err.contains("is not empty") && !folder.join("oh58_3p.toml").exists(), "{err}");
}

#[test]
fn scenes_of_new_folders_are_ids_files_or_all() {
    let parent = tempfile::tempdir().unwrap();
    let new = |name: &str, folder: &str| {
        let folder = parent.path().join(folder);
        let (code, out, err) = run(&["results", "new", name, folder.to_str().unwrap()]);
        (code, out, err, folder)
    };
    let (code, _, err, folder) = new("oh85_4p", "misspelt");
    assert_eq!(code, 2);
    assert!(err.contains("SCENE") && err.contains("did you mean `oh58_4p`?"), "{err}");
    assert!(!folder.exists());
    let (code, out, _, folder) = new(&scene("coinciding_modes.toml"), "file");
    assert_eq!(code, 0);
    assert!(out.contains("suites that ask: lumped_model, rules\n"), "{out}");
    let copied = std::fs::read_to_string(folder.join("coinciding_modes.toml")).unwrap();
    assert_eq!(copied, std::fs::read_to_string(scene("coinciding_modes.toml")).unwrap());
    let (code, out, _, folder) = new("all", "all");
    assert_eq!(code, 0);
    assert!(out.contains("lin_parker_1999") && folder.join("five_planets.toml").exists(), "{out}");
    let path = parent.path().join("bare");
    let words =
        ["results", "new", "lin_parker_1999_3p", path.to_str().unwrap(), "--as", "fe_contact"];
    let (code, _, err) = run(&words);
    assert!(code == 2 && err.contains("no suite judges results of kind fe_contact"), "{err}");
    assert!(!path.exists());
    let (code, _, err, _) = new(&scene("none.toml"), "absent");
    assert_eq!(code, 2);
    assert!(err.contains("none.toml"), "{err}");
}

#[test]
fn check_says_what_is_there_and_what_can_be_asked() {
    let parent = tempfile::tempdir().unwrap();
    let folder = results_folder(parent.path());
    let (code, out, err) = run(&["results", "check", &folder]);
    assert_eq!(code, 0, "{err}");
    for words in
        ["oh58_4p_as_published", "table3.lumped", "fe.sets: needs mesh_cycle.csv of oh58_4p"]
    {
        assert!(out.contains(words), "{words}: {out}");
    }
    let (code, json, _) =
        run(&["results", "check", &folder, "--as", "measured", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    keeps_to_schema("results_check", &json);
    assert_eq!((code, &json["kind"]), (0, &"measured".into()));
    assert_eq!(json["tables"][0]["rows"], 1);
    assert!(json["asked"].as_array().unwrap().iter().all(|suite| suite["judged"] == false));
}

#[test]
fn check_ends_with_2_where_nothing_can_be_judged() {
    let parent = tempfile::tempdir().unwrap();
    let twice = "scene,frequency_hz,mode_type\noh58_4p,770,rotational\noh58_4p,770,rotational\n";
    let folder = with_modes(parent.path(), twice);
    let (code, out, err) = run(&["results", "check", &folder]);
    assert_eq!(code, 2);
    assert!(out.contains("modes.csv:2 and") && !out.contains("can be asked"), "{out}");
    assert!(err.contains("one contradiction: no suite judges"), "{err}");
    let untyped = "scene,frequency_hz\noh58_sun_planet_pair,770\n";
    let (code, out, err) = run(&["results", "check", &with_modes(parent.path(), untyped)]);
    assert_eq!(code, 2, "{out}");
    assert!(out.contains("not asked:") && err.contains("no suite can be asked"), "{err}");
}

#[test]
fn check_lists_every_table_and_names_the_teeth_that_rules_need() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("rules.csv", "scene,harmonic,excites\noh58_4p,1,translational\n");
    let (code, out, err) = run(&["results", "check", path]);
    assert_eq!(code, 0, "{err}");
    let line = out.lines().find(|line| line.starts_with("rules.csv")).unwrap();
    assert!(line.contains("oh58_4p") && line.contains('1'), "{line}");
    // Peaks under torques of which no suite asks, beside a table that is judged.
    let peaks = "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude\noh58_4p,0.565,sun,rotation,2,1150,1e-9\n";
    write("torque_peaks.csv", peaks);
    let (code, out, err) = run(&["validate", "--recorded", path]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("torque_peaks.csv: no check uses it; torque needs torque_peaks.csv of"),
        "{out}"
    );
    write("rules.csv", "scene,harmonic,excites\nlin_parker_1999_4p,1,translational\n");
    write(
        "torque_peaks.csv",
        "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude\noh58_4p,565,sun,rotation,2,1150,1e-5\n",
    );
    let (code, out, err) = run(&["results", "check", path]);
    assert_eq!(code, 2, "{err}");
    for words in [
        "rules: needs numbers of teeth in the scene lin_parker_1999_4p",
        "torque_peaks.csv  oh58_4p",
    ] {
        assert!(out.contains(words), "{words}: {out}");
    }
}

#[test]
fn matrices_are_listed_and_a_wrong_one_says_where() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("matrices");
    std::fs::create_dir(&folder).unwrap();
    let row =
        |i: usize| (0..17).map(|j| if i == j { "1e8" } else { "0" }).collect::<Vec<_>>().join(";");
    let rows: Vec<String> = (0..17).map(row).collect();
    std::fs::write(folder.join("oh58_4p.K.csv"), rows.join("\n")).unwrap();
    let path = parent.path().to_str().unwrap();
    let (code, out, err) = run(&["results", "check", path]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("matrices/oh58_4p.K.csv"), "{out}");
    let (code, out, _) = run(&["validate", "--recorded", path]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("lumped_model.oh58_4p.stiffness: largest at "), "{out}");
    std::fs::rename(folder.join("oh58_4p.K.csv"), folder.join("oh58_4p.C.csv")).unwrap();
    let (code, _, err) = run(&["validate", "--recorded", path]);
    assert_eq!(code, 2);
    assert!(err.contains("oh58_4p.C.csv: no matrix is called so: allowed is M or K"), "{err}");
}
