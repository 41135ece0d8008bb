//! `dataset`, `dataset check` and `snapshot` as a user meets them.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::harness::{keeps_to_schema, run};

/// The folder with the data set, written into a folder of its own.
fn written(parent: &Path) -> String {
    let folder = parent.join("values").display().to_string();
    let (code, out, err) = run(&["dataset", &folder]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("certified values (class A)"), "{out}");
    folder
}

/// Every file of a folder with its bytes, by name.
fn bytes(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => files.extend(bytes(&path)),
            false => files.push((path.display().to_string(), fs::read(&path).unwrap())),
        }
    }
    files.sort();
    files
}

#[test]
fn the_same_bytes_on_one_thread_and_on_two() {
    let parent = tempfile::tempdir().unwrap();
    let found = ["1", "2", "2"].map(|threads| {
        let folder = parent.path().join("values");
        let mut command = Command::new(env!("CARGO_BIN_EXE_epicyclic"));
        let done = command.env("RAYON_NUM_THREADS", threads).arg("dataset").arg(&folder).output();
        assert!(done.unwrap().status.success());
        let files = bytes(&folder);
        fs::remove_dir_all(&folder).unwrap();
        files
    });
    assert!(found[0].len() > 30 && found[0] == found[1] && found[1] == found[2]);
    let size: usize = found[0].iter().map(|(_, bytes)| bytes.len()).sum();
    assert!(size < 5_000_000, "{size} bytes");
}

/// Changes one file of a data set, with its hash mended or not, and says what `dataset check` prints.
fn altered(file: &str, change: impl Fn(&str) -> String, mends_hash: bool) -> (u8, String) {
    let parent = tempfile::tempdir().unwrap();
    let folder = written(parent.path());
    let path = Path::new(&folder).join(file);
    let text = fs::read_to_string(&path).unwrap();
    let changed = change(&text);
    assert_ne!(text, changed, "nothing is changed in {file}");
    fs::write(&path, changed).unwrap();
    if mends_hash {
        let list = Command::new("sh")
            .current_dir(&folder)
            .args(["-c", "sha256sum $(cut -c67- SHA256SUMS) > sums && mv sums SHA256SUMS"])
            .status();
        assert!(list.unwrap().success());
    }
    let (code, out, err) = run(&["dataset", "check", &folder]);
    assert_eq!(err, "");
    (code, out)
}

/// The row of an id with one column changed.
fn with_column(text: &str, id: &str, column: usize, change: impl Fn(&str) -> String) -> String {
    let row = |line: &str| match line.starts_with(&format!("{id},")) {
        true => {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            cells[column] = change(&cells[column]);
            cells.join(",")
        }
        false => line.to_owned(),
    };
    text.lines().map(|line| row(line) + "\n").collect()
}

const MODE: &str = "lumped.lin_parker_1999_4p.frequency.rotational.2";
const REST: &str = "fe_contact.oh58_4p.transmission_error.sun.l2.1413nm";
const VALUE: usize = 12;
const UNIT: usize = 13;

#[test]
fn a_whole_copy_is_whole() {
    let parent = tempfile::tempdir().unwrap();
    let (code, out, err) = run(&["dataset", "check", &written(parent.path())]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("nothing altered"), "{out}");
}

#[test]
fn every_alteration_is_named() {
    let times = |factor: f64| move |x: &str| (factor * x.parse::<f64>().unwrap()).to_string();
    type Change = Box<dyn Fn(&str) -> String>;
    let cases: [(&str, &str, Change, &str); 6] = [
        (
            "one altered row",
            "modes.csv",
            Box::new(move |text| with_column(text, MODE, VALUE, times(1.5))),
            MODE,
        ),
        (
            "a shift of twice the uncertainty",
            "mesh_cycle.csv",
            Box::new(|text| {
                let rows = validation::certified::CertifiedValues::shipped();
                let row = rows.row(REST).unwrap();
                let shifted = (row.value + 2.0 * row.uncertainty).to_string();
                with_column(text, REST, VALUE, |_| shifted.clone())
            }),
            "digits agree",
        ),
        (
            "two lost digits",
            "mesh_cycle.csv",
            Box::new(|text| {
                let cut = |x: &str| {
                    format!(
                        "{:e}",
                        format!("{:.1e}", x.parse::<f64>().unwrap()).parse::<f64>().unwrap()
                    )
                };
                with_column(text, REST, VALUE, cut)
            }),
            "digits agree",
        ),
        (
            "a permuted column",
            "geometry.csv",
            Box::new(|text| text.replacen("quantity,scene", "scene,quantity", 1)),
            "columns are `id,scene,quantity",
        ),
        (
            "a dropped planet",
            "geometry.csv",
            Box::new(|text| {
                let kept = |line: &&str| {
                    !line.starts_with("geometry.oh58_4p.")
                        || !line.contains("planet_3") && !line.contains("mesh_3")
                };
                text.lines().filter(kept).map(|line| format!("{line}\n")).collect()
            }),
            "rows are missing, the first `geometry.oh58_4p",
        ),
        (
            "a swapped unit",
            "modes.csv",
            Box::new(|text| with_column(text, MODE, UNIT, |_| "rad/s".to_owned())),
            "the unit is `rad/s`, and that of `frequency` is `Hz`",
        ),
    ];
    for (what, file, change, named) in cases {
        let (code, out) = altered(file, &change, false);
        assert_eq!(code, 1, "{what}: {out}");
        assert!(
            out.contains(named) && out.contains("of which SHA256SUMS has the hash"),
            "{what}: {out}"
        );
        // Hashes made again hide nothing.
        let (code, out) = altered(file, &change, true);
        assert_eq!(code, 1, "{what}: {out}");
        assert!(out.contains(named) && out.contains("is not that of version"), "{what}: {out}");
    }
}

#[test]
fn what_is_no_data_set_ends_with_2() {
    let parent = tempfile::tempdir().unwrap();
    let path = |name: &str| parent.path().join(name).display().to_string();
    fs::write(path("file"), "x").unwrap();
    for (line, words) in [
        (vec!["dataset", "check"], "DIR"),
        (vec!["dataset"], "DIR"),
        (vec!["dataset", "check", &path("absent")], "is no folder"),
        (vec!["dataset", "check", &path("file")], "is no folder"),
        (vec!["dataset", parent.path().to_str().unwrap()], "is not empty"),
        (vec!["snapshot", &path("absent")], "absent"),
    ] {
        let (code, out, err) = run(&line);
        assert_eq!((code, out.as_str()), (2, ""), "{line:?}: {err}");
        assert!(err.contains(words), "{line:?}: {err}");
    }
    // An empty folder is a data set of which everything is missing.
    fs::create_dir(path("empty")).unwrap();
    let (code, out, _) = run(&["dataset", "check", &path("empty")]);
    assert!(code == 1 && out.contains("SHA256SUMS: cannot be read"), "{out}");
}

#[cfg(feature = "parquet")]
#[test]
fn sweeps_stand_in_parquet_too() {
    let parent = tempfile::tempdir().unwrap();
    let folder = written(parent.path());
    let path = Path::new(&folder).join("steady_states.parquet");
    let sums = fs::read_to_string(Path::new(&folder).join("SHA256SUMS")).unwrap();
    assert!(sums.ends_with("  steady_states.parquet\n"), "{sums}");
    fs::write(&path, "PAR1").unwrap();
    let (code, out, _) = run(&["dataset", "check", &folder]);
    assert!(code == 1 && out.starts_with("steady_states.parquet: is not the file"), "{out}");
    fs::remove_file(&path).unwrap();
    let (code, out, _) = run(&["dataset", "check", &folder]);
    assert!(code == 1 && out.starts_with("steady_states.parquet: cannot be read"), "{out}");
}

/// A results folder with the two frequencies of rotation of the published set of four planets.
fn results(parent: &Path, hz: [f64; 2]) -> String {
    let folder = parent.join("mine");
    fs::create_dir_all(&folder).unwrap();
    let rows = hz.map(|hz| format!("lin_parker_1999_4p,{hz},rotational\n")).concat();
    fs::write(folder.join("results.toml"), "format = 1\nkind = \"lumped\"\nprogram = \"mine\"\n")
        .unwrap();
    fs::write(folder.join("modes.csv"), format!("scene,frequency_hz,mode_type\n{rows}")).unwrap();
    folder.display().to_string()
}

#[test]
fn a_drift_of_one_digit_is_reported_with_its_direction() {
    let parent = tempfile::tempdir().unwrap();
    let first = "lumped.lin_parker_1999_4p.frequency.rotational.";
    let value = |number: usize| {
        let row = validation::certified::CertifiedValues::shipped();
        row.row(&format!("{first}{number}")).unwrap().value
    };
    // The first is rigid-body motion, which the list leaves out.
    let certified = [value(2), value(3)];
    // Right to six digits.
    let stored = certified.map(|hz| hz * (1.0 + 1e-6));
    let folder = results(parent.path(), stored);
    let (code, out, err) = run(&["snapshot", &folder]);
    assert!(code == 0 && out.contains("the data set has 2 of them"), "{out} {err}");
    assert!(out.contains("frequency") && out.contains("6.0"), "{out}");
    let check = ["snapshot", &folder, "--check", "--format", "json"];
    let (code, out, _) = run(&check);
    let same: serde_json::Value = serde_json::from_str(&out).unwrap();
    keeps_to_schema("snapshot_check", &same);
    assert_eq!((code, same["moved"].as_array().unwrap().len()), (0, 0), "{out}");

    for (factor, direction, digits) in
        [(1e-5, "away from the data set", 5.0), (1e-7, "towards the data set", 7.0)]
    {
        let [moved, other] = stored;
        results(parent.path(), [certified[0] * (1.0 + factor), other]);
        let (code, out, _) = run(&["snapshot", &folder, "--check", "--format", "csv"]);
        assert!(code == 1 && out.contains(direction), "{moved}: {out}");
        let (code, out, _) = run(&check);
        let drift: serde_json::Value = serde_json::from_str(&out).unwrap();
        let [moved] = drift["moved"].as_array().unwrap().as_slice() else { panic!("{out}") };
        assert_eq!((code, moved["id"].as_str()), (1, Some(&*format!("{first}2"))));
        let of = |key: &str| moved[key].as_f64().unwrap();
        assert!((of("digits_before") - 6.0).abs() < 0.01, "{out}");
        assert!((of("digits_now") - digits).abs() < 0.01, "{out}");
    }
}

#[test]
fn a_baseline_that_is_none_ends_with_2() {
    let parent = tempfile::tempdir().unwrap();
    let folder = results(parent.path(), [2000.0, 3000.0]);
    let (code, out, err) = run(&["snapshot", &folder, "--check"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("mine.baseline.csv"), "{err}");
    let baseline = parent.path().join("mine.baseline.csv");
    fs::write(&baseline, "id,value\na,1\n").unwrap();
    let (code, out, err) = run(&["snapshot", &folder, "--check"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("is no baseline") && err.contains("epicyclic snapshot RESULTS"), "{err}");
    // A value that is none, another unit, a row twice.
    run(&["snapshot", &folder]);
    let stored = fs::read_to_string(&baseline).unwrap();
    let (head, rows) = stored.split_once('\n').unwrap();
    for (text, fault) in [
        (
            stored.replacen(",2000.0,", ",inf,", 1),
            "line 2: `lumped.lin_parker_1999_4p.frequency.rotational.2`: the value is inf",
        ),
        (stored.replacen(",Hz,", ",kHz,", 1), "the unit is `kHz`, and that of the results `Hz`"),
        (
            format!("{head}\n{rows}{rows}"),
            "line 4: `lumped.lin_parker_1999_4p.frequency.rotational.2`: the row is there twice",
        ),
    ] {
        fs::write(&baseline, text).unwrap();
        let (code, out, err) = run(&["snapshot", &folder, "--check"]);
        assert_eq!((code, out.as_str()), (2, ""));
        assert!(err.contains(fault), "{fault}: {err}");
    }
}

#[test]
fn matrices_stiffness_and_peaks_are_guarded_too() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("mine");
    fs::create_dir_all(folder.join("matrices")).unwrap();
    let mass = |first: &str| {
        let row = |i: usize| {
            (0..17).map(move |j| {
                if i != j {
                    "0"
                } else if i == 0 {
                    first
                } else {
                    "1"
                }
            })
        };
        (0..17).map(|i| row(i).collect::<Vec<_>>().join(",") + "\n").collect::<String>()
    };
    let matrix = folder.join("matrices/oh58_4p.M.csv");
    fs::write(&matrix, mass("1")).unwrap();
    let stiffness = |k: u32| {
        let head = "scene,sun_torque_nm,body,position,stiffness_n_per_m\n".to_owned();
        let row = |n: u32| format!("oh58_4p,1130,sun_mesh_0,{},{}\n", f64::from(n) / 28.0, k + n);
        head + &(0..28).map(row).collect::<String>()
    };
    let table = folder.join("mesh_stiffness.csv");
    fs::write(&table, stiffness(500_000_000)).unwrap();
    let peaks = "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude\noh58_4p,565,sun,rotation,2,1150,1e-5\n";
    fs::write(folder.join("torque_peaks.csv"), peaks).unwrap();
    let path = folder.to_str().unwrap();
    let (code, out, err) = run(&["snapshot", path]);
    assert!(code == 0 && out.contains("stored 46 values"), "{out} {err}");
    fs::write(&matrix, mass("2")).unwrap();
    fs::write(&table, stiffness(600_000_000)).unwrap();
    fs::write(folder.join("torque_peaks.csv"), peaks.replace("1e-5", "2e-5")).unwrap();
    let (code, out, _) = run(&["snapshot", path, "--check"]);
    assert!(code == 1 && out.contains("46 values compared") && out.contains(": 30 moved"), "{out}");
}
