//! The verb `impulse`: what it refuses, and its tables and figures.

use std::path::Path;

use crate::harness::{json, run, scene};

#[test]
fn impulse_refuses_what_makes_no_sense_with_one_message() {
    let (pair, set) = (scene("oh58_sun_planet_pair.toml"), scene("oh58_4p.toml"));
    let lumped = scene("lin_parker_1999_3p.toml");
    let cases: [(&[&str], &str); 16] = [
        (&["impulse", &pair], "`operation.torque_nm` is absent"),
        (&["impulse", &lumped], "[geometry] is absent"),
        (
            &["impulse", &set, "--sun-torque-nm", "0"],
            "argument --sun-torque-nm: 0 N·m: allowed is a finite torque other than 0 N·m",
        ),
        (&["impulse", &set, "--sun-torque-nm", "-0"], "nothing touches"),
        (&["impulse", &set, "--sun-torque-nm", "nan"], "finite torque"),
        (&["impulse", &set, "--sun-torque-nm", "inf"], "finite torque"),
        (&["impulse", &set, "--sun-torque-nm", "1e9"], "--sun-torque-nm"),
        (&["impulse", &set, "--step-us", "0"], "step above 0"),
        (&["impulse", &set, "--step-us", "-5"], "step above 0"),
        (&["impulse", &set, "--step-us", "60"], "has 8 steps"),
        (&["impulse", &set, "--duration-ms", "5"], "at least 9.12 ms"),
        (&["impulse", &set, "--duration-ms", "nan"], "--duration-ms"),
        (&["impulse", &set, "--duration-ms", "1e9"], "100000 steps"),
        (&["impulse", &set, "--position", "2"], "from 0 to 1"),
        (&["impulse", &set, "--band", "--format", "csv"], "--band"),
        (&["impulse", "nowhere.toml"], "nowhere.toml"),
    ];
    for (arguments, words) in cases {
        let (code, out, err) = run(arguments);
        assert_eq!(code, 2, "{arguments:?}");
        assert!(out.is_empty() && err.contains(words), "{arguments:?}: {err}");
    }
    // Fidelity `full` has no linearisation of small order, from which a band could be computed.
    let folder = tempfile::tempdir().unwrap();
    let path = with_fidelity(folder.path(), "oh58_3p.toml", "fidelity = \"full\"");
    let (code, _, err) = run(&["impulse", &path, "--band"]);
    assert!(code == 2 && err.contains("`dynamics.fidelity` = \"full\""), "{err}");
}

/// A scene of the repository at another fidelity, with coarse meshes.
fn with_fidelity(folder: &Path, name: &str, fidelity: &str) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    let path = folder.join(name);
    let coarse = "[fe_contact]\nflank_elements = 6\nelement = \"linear\"";
    std::fs::write(&path, format!("{text}\n{coarse}\n\n[dynamics]\n{fidelity}\n")).unwrap();
    path.display().to_string()
}

/// The contract of the modal test: both routes agree within 0.1 %, all tables and figures are written.
#[test]
fn impulse_as_text_csv_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let figures = folder.path().join("figures").display().to_string();
    let set = scene("oh58_3p.toml");
    let short = ["impulse", &set, "--sun-torque-nm", "-1130", "--duration-ms", "20"];
    let with = |more: &[&str]| {
        let (code, out, err) = run(&[&short[..], more].concat());
        assert_eq!(code, 0, "{err}");
        out
    };
    let text = with(&["--band", "--figures", &figures]);
    for words in ["-1130 N·m", "quasi_static", "sun torque", "-565, -1130, -1695 N·m", "84 of 84"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    for (name, words) in [
        ("spectrum", "force pulse on the carrier"),
        ("stabilisation", "not stable"),
        ("mode_shapes", "rotational"),
        ("band", "565 N"),
    ] {
        let path = folder.path().join(format!("figures/{name}.svg"));
        let svg = std::fs::read_to_string(path).unwrap();
        assert!(svg.contains("<svg") && svg.contains(words) && !svg.contains("NaN"), "{name}");
    }
    let csv = with(&["--format", "csv"]);
    let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|l| l.split(',').collect()).collect();
    let (inside, outside): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row[10] == "true");
    assert_eq!((inside.len(), outside.len()), (8, 6));
    for row in inside {
        let apart: f64 = row[8].parse().unwrap();
        assert!(row.len() == 11 && apart.abs() < 0.1, "{row:?}");
    }
    // Modes outside the band are linearised alone.
    for row in outside {
        let frequency: f64 = row[6].parse().unwrap();
        assert!(row.len() == 11 && frequency > 3000.0 && row[1].is_empty(), "{row:?}");
    }
    assert!(text.contains("outside this band"), "{text}");
}

/// Fidelity `full`: as many modes are identified, and the columns of the linearised set are empty.
#[test]
#[ignore = "long: .ci/full runs it"]
fn impulse_without_a_small_linearisation() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_fidelity(folder.path(), "oh58_3p.toml", "fidelity = \"full\"");
    let (code, text, err) = run(&[
        "impulse",
        &path,
        "--sun-torque-nm",
        "1130",
        "--step-us",
        "40",
        "--duration-ms",
        "12",
    ]);
    assert_eq!(code, 0, "{err}");
    assert!(text.contains("fidelity: full") && text.contains("no small linearisation"), "{text}");
    let rows: Vec<&str> = text.lines().filter(|l| l.contains("ational ")).collect();
    let empty = |row: &&&str| row.matches('–').count() >= 4;
    assert!(rows.iter().filter(empty).count() == 8, "{text}");
}

/// Five planets have pairs of modes 7e-4 apart: every pole is one mode, at its own frequency, beside the
/// linearised mode that it is nearest to.
#[test]
fn impulse_tells_close_modes_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_fidelity(folder.path(), "five_planets.toml", "fidelity = \"quasi_static\"");
    let found = json(&["impulse", &path, "--format", "json"]);
    let mut last = 0.0;
    let modes = found["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 10);
    for mode in modes {
        let hz = mode["identified"]["frequency_hz"].as_f64().unwrap();
        let off = mode["difference_percent"].as_f64().unwrap();
        assert!(hz > 1.0002 * last, "{hz} follows {last}");
        // Steps lower a frequency by less than 0.04 %.
        assert!((-0.04..=0.0).contains(&off), "{hz}: {off} %");
        last = hz;
    }
}
