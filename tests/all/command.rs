//! The command as a user meets it: results on stdout, one clear message and exit code 2 for bad
//! input, JSON that keeps to its schema.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::harness::{coarse, csv_of_own_modes, json, keeps_to_schema, run, scene};
use crate::results_command::results_folder;

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

/// Every verb in every way that changes what it prints: schema, whether it has CSV, arguments.
fn every_verb(folder: &Path) -> Vec<(&'static str, Vec<String>)> {
    let own = csv_of_own_modes().to_str().unwrap().to_owned();
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    let plain = coarse(folder, "oh58_4p.toml");
    let words = |line: &str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    vec![
        ("validate", words("validate --only table1.")),
        ("validate_controls", words("validate --controls --only fe.hertz")),
        ("mesh", words(&format!("mesh {plain}"))),
        ("static_set", words(&format!("static {plain} --positions 2"))),
        ("static_set", words(&format!("static {plain} --positions 1 --sun-torque-nm 500,-900"))),
        ("static_pair", words(&format!("static {pair} --normal-force-n 1e4 --positions 2"))),
        ("static_approach", words(&format!("static {pair} --approach-um 20 --phase 0.7"))),
        ("impulse", words(&format!("impulse {plain} --duration-ms 10"))),
        ("impulse", words(&format!("impulse {pair} --sun-torque-nm 300 --duration-ms 10 --band"))),
        (
            "branches",
            words(&format!("branches {plain} --speeds-rpm 990:1000 --model lumped --switch")),
        ),
        (
            "branches",
            words(&format!(
                "branches {plain} --over torque --torques-nm 1100:1130 --rpm 990 --model lumped"
            )),
        ),
        (
            "branches",
            words(&format!(
                "branches {plain} --over damping.bearing_s --from 2e-6 --to 2.2e-6 --rpm 990 --model lumped"
            )),
        ),
        ("stability", words("stability explicit-step")),
        ("stability", words("stability integrators")),
        ("stability", words(&format!("stability mode-types --scene {set}"))),
        ("stability_list", words("stability")),
        ("modes", words(&format!("modes {set}"))),
        ("modes", words(&format!("modes {set} --carrier-speeds-rpm 0,535.7"))),
        ("modes", words(&format!("modes {}", scene("lin_parker_1999_3p.toml")))),
        ("rules", words(&format!("rules {set}"))),
        ("scene_check", words(&format!("scene check {set}"))),
        ("scene_check", words(&format!("scene check {pair}"))),
        ("scene_check", words(&format!("scene check {}", scene("lin_parker_1999_4p.toml")))),
        ("results_check", words(&format!("results check {}", results_folder(folder)))),
        ("compare", words(&format!("compare {own} --scene {set}"))),
    ]
}

#[test]
fn every_verb_keeps_to_its_formats() {
    let folder = tempfile::tempdir().unwrap();
    for (name, arguments) in every_verb(folder.path()) {
        let of = |format: &str| {
            let mut all: Vec<&str> = arguments.iter().map(String::as_str).collect();
            all.extend(["--format", format]);
            let (code, out, err) = run(&all);
            assert_eq!(code, 0, "{all:?}: {err}");
            out
        };
        let result: Value = serde_json::from_str(&of("json")).unwrap();
        keeps_to_schema(name, &result);
        let text = of("text");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        let plain = anstream::adapter::strip_str(&text).to_string();
        let widest = plain.lines().max_by_key(|line| line.chars().count()).unwrap_or_default();
        assert!(widest.chars().count() <= 100, "{arguments:?}: {widest}");
        // A band over the mesh cycle has no place in the table of modes.
        if !arguments.contains(&"--band".to_owned()) {
            let table = of("csv");
            let mut reader = csv::Reader::from_reader(table.as_bytes());
            assert!(reader.headers().unwrap().len() > 2, "{table}");
            // Rows of another length are errors.
            let rows = reader.records().collect::<Result<Vec<_>, _>>().unwrap();
            assert!(!rows.is_empty() && !table.contains("NaN"), "{table}");
        }
    }
}

/// A reader that goes away after some bytes.
struct Closing(usize);

impl std::io::Write for Closing {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.0 == 0 {
            return Err(std::io::ErrorKind::BrokenPipe.into());
        }
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        Ok(taken)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        if self.0 == 0 { Err(std::io::ErrorKind::BrokenPipe.into()) } else { Ok(()) }
    }
}

#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let set = scene("oh58_4p.toml");
    let pair = scene("oh58_sun_planet_pair.toml");
    for (line, format) in [
        (format!("modes {set}"), "json"),
        (format!("rules {set}"), "text"),
        (format!("static {pair} --normal-force-n 1e4 --positions 3"), "csv"),
        (format!("static {pair} --approach-um 20"), "csv"),
    ] {
        let words = ["epicyclic"].into_iter().chain(line.split(' ')).chain(["--format", format]);
        let mut err = Vec::new();
        let code = epicyclic::run(words, &mut Closing(50), &mut err);
        assert_eq!((code, err.len()), (0, 0), "{line}: {}", String::from_utf8_lossy(&err));
    }
}

#[test]
fn a_branch_without_speeds_or_start_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let plain = coarse(folder.path(), "oh58_4p.toml");
    let full = folder.path().join("full.toml");
    let text = std::fs::read_to_string(&plain).unwrap() + "[dynamics]\nfidelity = \"full\"\n";
    std::fs::write(&full, text).unwrap();
    let full = full.to_str().unwrap();
    let [pair, ring] = ["oh58_sun_planet_pair.toml", "oh58_ring_planet_pair.toml"].map(scene);
    for (line, named) in [
        (format!("branches {plain}"), "--speeds-rpm"),
        (format!("branches {plain} --speeds-rpm 900"), "FROM:TO"),
        (format!("branches {plain} --speeds-rpm 900:800"), "--speeds-rpm"),
        (format!("branches {plain} --speeds-rpm -900:800"), "--speeds-rpm"),
        (format!("branches {plain} --speeds-rpm 800:900 --start 1000"), "--start"),
        (format!("branches {plain} --speeds-rpm 800:900 --sun-torque-nm 0"), "--sun-torque-nm"),
        (format!("branches {plain} --speeds-rpm 800:900 --damping-factor 0"), "--damping-factor"),
        (format!("branches {plain} --speeds-rpm 800:900 --over torque"), "--speeds-rpm"),
        (format!("branches {plain} --speeds-rpm 800:900 --over noise"), "--over"),
        (format!("branches {plain} --speeds-rpm 800:900 --torques-nm 5:9"), "--torques-nm"),
        (format!("branches {plain} --speeds-rpm 800:900 --rpm 850"), "--rpm"),
        (format!("branches {plain} --over torque"), "--torques-nm"),
        (format!("branches {plain} --over torque --torques-nm -5:9"), "--torques-nm"),
        (format!("branches {plain} --over torque --torques-nm 0:9"), "--torques-nm"),
        (format!("branches {plain} --over torque --torques-nm 5:9 --start 10"), "--start"),
        (format!("branches {plain} --over torque --torques-nm 5:9 --rpm 0"), "--rpm"),
        (
            format!("branches {plain} --over torque --torques-nm 5:9 --sun-torque-nm -7"),
            "--sun-torque-nm",
        ),
        (format!("branches {plain} --over planet.bearing_n_per_m"), "--from"),
        (format!("branches {plain} --over planet.bearing_n_per_m --from 8e7"), "--to"),
        (format!("branches {plain} --over planet.bearing_n_per_m --from 9e7 --to 8e7"), "--from"),
        (format!("branches {plain} --over planet.bearing_n_per_m --from 0 --to 8e7"), "--from"),
        (format!("branches {plain} --over planet.torsional_n_per_m --from 1 --to 2"), "--from"),
        (format!("branches {plain} --over teeth.sun --from 20 --to 30"), "teeth.sun"),
        (
            format!("branches {plain} --over damping.friction --from 1 --to 2"),
            "allowed are damping",
        ),
        (format!("branches {plain} --speeds-rpm 800:900 --from 1"), "--from"),
        (format!("branches {plain} --over damping"), "--damping-factors"),
        (format!("branches {plain} --over damping --damping-factors 0:1"), "--damping-factors"),
        (
            format!("branches {plain} --over damping --damping-factors 0.5:1 --damping-factor 2"),
            "--damping-factor",
        ),
        (format!("branches {pair} --speeds-rpm 800:900"), "`operation`"),
        (format!("branches {ring} --speeds-rpm 800:900"), "`mesh`"),
        (format!("branches {full} --speeds-rpm 800:900"), "dynamics.fidelity"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(named), "{line}: {err}");
    }
}

#[test]
fn modes_whose_types_mean_nothing_are_warned_of() {
    for (name, is_warned) in [("oh58_4p.toml", false), ("coinciding_modes.toml", true)] {
        let (code, _, err) = run(&["modes", &scene(name)]);
        assert_eq!((code, err.contains("lie so close")), (0, is_warned), "{name}: {err}");
    }
}

#[test]
fn options_without_use_are_refused() {
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    for (line, option) in [
        (format!("static {pair} --normal-force-n 1e4 --phase 0.3"), "--phase"),
        (format!("static {pair} --normal-force-n 1e4 --export-inp deck.inp"), "--export-inp"),
        (format!("static {pair} --normal-force-n 1e4 --export-teeth 2"), "--export-teeth"),
        (format!("static {set} --phase 0.3"), "--phase"),
        (format!("static {pair} --approach-um 20 --positions 5"), "--positions"),
        (format!("static {set} --approach-um 20"), "--approach-um"),
        (format!("static {set} --normal-force-n 20"), "--normal-force-n"),
        (format!("static {pair} --sun-torque-nm 20"), "--sun-torque-nm"),
        (format!("impulse {set} --band --format csv"), "--band"),
        (format!("impulse {set} --band-hz 900:400"), "--band-hz"),
        (format!("impulse {set} --band-hz 0:400"), "--band-hz"),
        (format!("modes {set} --details --format json"), "--details"),
        ("validate --details --format json".to_owned(), "--details"),
        ("validate --controls --profile full".to_owned(), "--profile"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(option), "{line}: {err}");
    }
}

#[test]
fn files_without_end_are_refused() {
    let set = scene("oh58_4p.toml");
    for line in ["modes /dev/zero".to_owned(), format!("compare /dev/zero --scene {set}")] {
        let (code, _, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(code, 2, "{err}");
        assert!(err.contains("longer than 1 MB"), "{err}");
    }
}

#[test]
fn scenes_that_do_not_fit_a_verb_are_refused_with_the_key() {
    let cases = [
        (vec!["modes", "oh58_sun_planet_pair.toml"], "[lumped]"),
        (vec!["modes", "oh58_ring_planet_pair.toml"], "mesh"),
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
    let good = |more: &[&str]| {
        let arguments = [&["validate", "--only", "table3."], more].concat();
        let output = Command::new(binary).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        let written = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap());
        assert!(written.iter().all(|text| !text.contains('\u{1b}')), "colour off a terminal");
        written
    };
    let [text, told] = good(&[]);
    assert!(text.contains("\ntable3.lumped ") && text.contains("0 failed"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    // One line per finished suite.
    for suites in ["table2.lumped, table3.lumped: ", "table3.explained: "] {
        assert!(told.lines().any(|line| line.starts_with(suites)), "{told}");
    }
    let [text, _] = good(&["--details"]);
    assert!(text.contains("table3.lumped.6") && text.contains("0 failed"), "{text}");
    let bad = Command::new(binary).args(["modes", "nowhere.toml"]).output().unwrap();
    assert_eq!(bad.status.code(), Some(2));
    assert!(bad.stdout.is_empty());
}

#[test]
fn a_report_that_cannot_be_written_is_one_message() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let path = file.path().to_str().unwrap();
    let (code, out, err) = run(&["validate", "--only", "table1.", "--report", path]);
    assert_eq!((code, out.as_str()), (2, ""), "{err}");
    assert!(err.contains("--report") && err.contains("allowed is a folder"), "{err}");
    assert_eq!(err.lines().count(), 1, "{err}");
}

/// A set whose backside flanks do not press says so.
#[test]
fn static_says_whether_backside_flanks_press() {
    let folder = tempfile::tempdir().unwrap();
    let set = coarse(folder.path(), "oh58_3p.toml");
    let (code, out, err) = run(&["static", &set, "--positions", "2"]);
    assert!(code == 0 && out.lines().any(|l| l == "no backside flank presses"), "{out} {err}");
    let found = json(&["static", &set, "--positions", "2", "--format", "json"]);
    assert_eq!(found["torques"][0]["backside_contact"], 0.0);
}

/// The contract of one mesh: keys, definitions that can be checked, numbers of the right size.
#[test]
fn static_of_one_mesh_as_json() {
    let pair = scene("oh58_sun_planet_pair.toml");
    let arguments =
        ["static", &pair, "--normal-force-n", "10700.67", "--positions", "16", "--format", "json"];
    let result = json(&arguments);
    let number = |key: &str| result[key].as_f64().unwrap();
    let positions = result["positions"].as_array().unwrap();
    assert_eq!(positions.len(), 16);
    let errors: Vec<f64> =
        positions.iter().map(|p| p["transmission_error_um"].as_f64().unwrap()).collect();
    let mean = errors.iter().sum::<f64>() / 16.0;
    assert!((mean - number("transmission_error_mean_um")).abs() < 1e-9);
    let secant = errors.iter().map(|e| 10_700.67 / (e * 1e-6)).sum::<f64>() / 16.0;
    assert!((secant / number("mean_secant_stiffness_n_per_m") - 1.0).abs() < 1e-12);
    assert!(number("mean_tangent_stiffness_n_per_m") > secant);
    let mut loaded = 0;
    for p in positions {
        let pairs = p["pairs"].as_array().unwrap();
        loaded += pairs.len();
        let total: f64 = pairs.iter().map(|l| l["force_n"].as_f64().unwrap()).sum();
        // Moment arms of corner contacts are within 2 % of the base radius.
        assert!((total / 10_700.67 - 1.0).abs() < 0.02);
    }
    let ratio = number("effective_contact_ratio");
    assert!((ratio - loaded as f64 / 16.0).abs() < 1e-12 && ratio > 1.4565);
}

#[test]
fn static_refuses_what_makes_no_sense_with_one_message() {
    let (pair, set) = (scene("oh58_sun_planet_pair.toml"), scene("oh58_4p.toml"));
    let lumped = scene("lin_parker_1999_3p.toml");
    let cases: [(&[&str], &str); 9] = [
        (&["static", &pair], "--normal-force-n"),
        (&["static", &pair, "--normal-force-n", "-5"], "above 0 N"),
        (&["static", &pair, "--sun-torque-nm", "5"], "--normal-force-n"),
        (&["static", &set, "--normal-force-n", "5"], "--sun-torque-nm"),
        (&["static", &set, "--sun-torque-nm", "0"], "other than 0"),
        (&["static", &set, "--sun-torque-nm", "nan"], "finite"),
        (&["static", &set, "--approach-um", "5"], "only a gear pair"),
        (&["static", &lumped], "[geometry] is absent"),
        (&["static", &pair, "--normal-force-n", "5", "--positions", "0"], "--positions"),
    ];
    for (arguments, words) in cases {
        let (code, out, err) = run(arguments);
        assert_eq!(code, 2, "{arguments:?}");
        assert!(out.is_empty() && err.contains(words), "{arguments:?}: {err}");
    }
}

#[test]
fn figures_and_meshes_are_written_where_asked() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let set = scene("oh58_3p.toml");
    let drawn = run(&[
        "static",
        &set,
        "--sun-torque-nm",
        "400,800",
        "--positions",
        "4",
        "--figures",
        &at("figures"),
    ]);
    assert_eq!(drawn.0, 0, "{}", drawn.2);
    for name in ["transmission_error", "load_sharing", "mesh_stiffness", "rms_against_torque"] {
        let text = std::fs::read_to_string(at(&format!("figures/{name}.svg"))).unwrap();
        assert!(text.contains("<svg") && text.contains("<path"), "{name}");
    }
    let meshed = run(&["mesh", &set, "--svg", &at("mesh.svg"), "--vtu", &at("vtu")]);
    assert_eq!(meshed.0, 0, "{}", meshed.2);
    for name in ["sun", "planet", "ring", "carrier"] {
        let text = std::fs::read_to_string(at(&format!("vtu/{name}.vtu"))).unwrap();
        assert!(text.contains("UnstructuredGrid"), "{name}");
    }
    assert!(std::fs::read_to_string(at("mesh.svg")).unwrap().contains("</svg>"));
}

/// PNG files have a font of their own. What it lacks is warned of, and kept in the SVG.
#[test]
fn a_title_that_a_png_cannot_show_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("oh58_sun_planet_pair.toml")).unwrap();
    let old = "title = \"Army OH-58 main rotor reduction, one sun-planet mesh\"";
    let path = folder.path().join("pair.toml");
    let figures = folder.path().join("figures").display().to_string();
    let drawn = |title: &str, more: &[&str]| {
        let coarse = "\n[fe_contact]\nflank_elements = 8\n";
        std::fs::write(&path, text.replace(old, &format!("title = \"{title}\"")) + coarse).unwrap();
        let name = path.to_str().unwrap();
        let own = ["static", name, "--normal-force-n", "3000", "--positions", "2"];
        run(&[&own, more].concat())
    };
    let (code, _, err) = drawn("行星 γ", &["--figures", &figures]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("`title`") && err.contains("(行 星)") && !err.contains("γ"), "{err}");
    let svg = std::fs::read_to_string(format!("{figures}/load_sharing.svg")).unwrap();
    assert!(svg.contains("行星 γ"));
    assert!(!drawn("Pair, γ, é", &["--figures", &figures]).2.contains("`title`"));
    assert!(!drawn("行星", &[]).2.contains("`title`"));
}
