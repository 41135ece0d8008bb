//! The verb `sweep` as people run it: interrupted, with folders of other results, with bad input.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

const BINARY: &str = env!("CARGO_BIN_EXE_epicyclic");

/// A coarse scene, so that a point takes a moment.
fn coarse(folder: &Path) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("scenes/oh58_4p.toml")).unwrap();
    assert!(!text.contains("[fe_contact]") && !text.contains("[dynamics]"));
    let path = folder.join("coarse.toml");
    let added = "\n[fe_contact]\nflank_elements = 6\n\n[dynamics]\nsteps_per_cycle = 56\n";
    std::fs::write(&path, text + added).unwrap();
    path
}

fn sweep(scene: &Path, out: &Path) -> Command {
    refined(scene, out, "3")
}

/// A sweep with a number of further speeds about each peak.
fn refined(scene: &Path, out: &Path, refine: &str) -> Command {
    let mut command = Command::new(BINARY);
    let range = ["--speeds-rpm", "1200:2400:100", "--sun-torque-nm", "1130", "--tolerance", "1e-4"];
    command.arg("sweep").arg(scene).args(range).args(["--refine", refine, "--between-cycles", "0"]);
    command.arg("--out").arg(out).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn results(out: &Path) -> [Vec<u8>; 2] {
    ["sweep.csv", "sweep.json"].map(|name| std::fs::read(out.join(name)).unwrap())
}

#[test]
fn one_speed_is_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let scene = scene.to_str().unwrap();
    let of = |speeds: &str| {
        let line = ["sweep", scene, "--speeds-rpm", speeds, "--between-cycles", "0"];
        crate::harness::run(&[&line[..], &["--format", "csv"]].concat())
    };
    let (code, one, err) = of("1200");
    assert_eq!(code, 0, "{err}");
    assert_eq!(one, of("1200:1200:10").1);
    assert!(of("12 00").2.contains("one speed, or three numbers as FROM:TO:STEP"));
}

#[test]
fn killed_twenty_times_or_on_one_thread_the_bytes_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let whole = folder.path().join("whole");
    assert!(sweep(&scene, &whole).status().unwrap().success());
    let expected = results(&whole);
    assert!(expected[0].len() > 100_000);

    let one = folder.path().join("one");
    assert!(sweep(&scene, &one).env("RAYON_NUM_THREADS", "1").status().unwrap().success());
    assert_eq!(results(&one), expected);

    let broken = folder.path().join("broken");
    let mut random = 0x9e37_79b9_7f4a_7c15u64;
    let mut kept = 0;
    for _ in 0..20 {
        let mut child = sweep(&scene, &broken).spawn().unwrap();
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        std::thread::sleep(Duration::from_millis(100 + (random >> 33) % 500));
        child.kill().unwrap();
        child.wait().unwrap();
        let now = points(&broken.join("points"));
        assert!(now >= kept, "points were lost: {now} after {kept}");
        kept = now;
    }
    assert!(sweep(&scene, &broken).status().unwrap().success());
    assert_eq!(results(&broken), expected);
}

/// Finished points in a folder.
fn points(folder: &Path) -> usize {
    let Ok(chains) = std::fs::read_dir(folder) else { return 0 };
    let of = |chain: std::fs::DirEntry| {
        let files = std::fs::read_dir(chain.path()).unwrap().flatten();
        files.filter(|f| f.path().extension().is_some_and(|e| e == "json")).count()
    };
    chains.flatten().map(of).sum()
}

fn refused(arguments: &[&str]) -> String {
    let output = Command::new(BINARY).args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(!text.contains("panicked"), "{text}");
    text
}

#[test]
fn ranges_and_harmonics_that_make_no_sense_are_refused() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/oh58_4p.toml");
    let cases: [(&[&str], &str); 7] = [
        (&["--speeds-rpm", "900:500:10"], "the range is empty"),
        (&["--speeds-rpm=-900:500:10"], "speeds must be finite and above 0"),
        (&["--speeds-rpm", "0:500:10"], "speeds must be finite and above 0"),
        (&["--speeds-rpm", "100:500:0"], "a step of 0 rpm"),
        (&["--speeds-rpm", "100:500"], "FROM:TO:STEP"),
        (&["--harmonics", "8"], "8 harmonics with 140 steps"),
        (&["--sun-torque-nm", "0"], "other than 0"),
    ];
    for (arguments, words) in cases {
        let mut all = vec!["sweep", scene];
        all.extend(arguments);
        let text = refused(&all);
        assert!(text.contains(words), "{arguments:?}: {text}");
    }
    let pair = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/oh58_sun_planet_pair.toml");
    assert!(refused(&["sweep", pair]).contains("`operation"));
    let pair = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/oh58_ring_planet_pair.toml");
    for verb in ["sweep", "branches", "impulse", "modes"] {
        let speeds: &[&str] = if verb == "branches" { &["--speeds-rpm", "1000:1100"] } else { &[] };
        let text = refused(&[&[verb, pair], speeds].concat());
        assert!(text.contains("`mesh`: it is \"ring_planet\""), "{verb}: {text}");
    }
}

#[test]
fn folders_that_hold_other_results_or_cannot_be_written_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let scene = scene.to_str().unwrap();
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let range = ["--speeds-rpm", "1600:1600:10", "--sun-torque-nm", "1130"];
    let run = |out: &str| {
        let mut all = vec!["sweep", scene, "--out", out];
        all.extend(range);
        refused(&all)
    };
    for (manifest, words) in [
        ("{\"format\": 99, \"plan\": {}}", "computed with format 99, not 5"),
        ("nonsense", "its manifest is no JSON"),
        ("{\"format\": 5}", "it is of something else, not of a sweep"),
    ] {
        std::fs::write(out.join("plan.json"), manifest).unwrap();
        let text = run(out.to_str().unwrap());
        assert!(text.contains(words) && text.contains("nothing was changed"), "{text}");
        assert_eq!(std::fs::read_to_string(out.join("plan.json")).unwrap(), manifest);
    }
    // A file in place of the folder represents every path that cannot be written.
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").unwrap();
    assert!(run(file.to_str().unwrap()).contains("is a file: allowed is a folder"));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept");
}

#[cfg(target_os = "linux")]
#[test]
fn a_place_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let text = refused_by(sweep(&scene, Path::new("/proc/self/nowhere")));
    assert!(text.contains("cannot write `/proc/self/nowhere`"), "{text}");
    // A result file that cannot be replaced is found before anything is computed; the finished points stay.
    let out = folder.path().join("out");
    assert!(one_speed(&scene, &out).status().unwrap().success());
    std::fs::remove_file(out.join("sweep.csv")).unwrap();
    std::fs::create_dir_all(out.join("sweep.csv/in_the_way")).unwrap();
    let text = refused_by(one_speed(&scene, &out));
    assert!(text.contains("sweep.csv`: it is a folder"), "{text}");
    assert_eq!(points(&out.join("points")), 1);
    assert!(!out.join("sweep.lock").exists());
}

/// A sweep of one speed.
fn one_speed(scene: &Path, out: &Path) -> Command {
    let mut command = Command::new(BINARY);
    let range = ["--speeds-rpm", "1600:1600:10", "--sun-torque-nm", "1130", "--tolerance", "1e-4"];
    command.arg("sweep").arg(scene).args(range).args(["--between-cycles", "0"]);
    command.arg("--out").arg(out).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// What a command that is refused says.
fn refused_by(mut command: Command) -> String {
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    text
}

/// A scene whose gears cannot be meshed: what is refused with it is refused before any set-up.
fn unmeshable(folder: &Path, scene: &Path) -> PathBuf {
    let text = std::fs::read_to_string(scene).unwrap();
    let changed = text.replace("flank_elements = 6", "flank_elements = 64");
    assert!(changed != text);
    let path = folder.join("unmeshable.toml");
    std::fs::write(&path, changed).unwrap();
    path
}

#[test]
fn files_of_something_else_are_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    for name in ["sweep.csv", "sweep.json", "sweep.parquet", "plan_peaks.json", "points"] {
        let out = folder.path().join(format!("with_{name}"));
        std::fs::create_dir(&out).unwrap();
        std::fs::write(out.join(name), "kept").unwrap();
        let text = refused_by(one_speed(&scene, &out));
        assert!(text.contains(name) && text.contains("nothing was changed"), "{text}");
        assert_eq!(std::fs::read_to_string(out.join(name)).unwrap(), "kept");
        assert_eq!(std::fs::read_dir(&out).unwrap().count(), 1, "something was written");
    }
}

#[test]
fn a_finished_point_that_was_changed_is_refused_and_can_be_removed() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let out = folder.path().join("out");
    assert!(one_speed(&scene, &out).status().unwrap().success());
    let expected = results(&out);
    let point = out.join("points/up_00/0000.json");
    let text = std::fs::read_to_string(&point).unwrap();
    // One digit of the first amplitude.
    let at = text.find("\"amplitude\":").unwrap() + "\"amplitude\":".len();
    let digit = if text.as_bytes()[at] == b'1' { "2" } else { "1" };
    let changed = format!("{}{digit}{}", &text[..at], &text[at + 1..]);
    for bad in [changed.as_str(), &text[..text.len() / 2], "", "{}"] {
        std::fs::write(&point, bad).unwrap();
        let said = refused_by(one_speed(&scene, &out));
        assert!(said.contains("points/up_00/0000.json") && said.contains("remove it"), "{said}");
        assert_eq!(std::fs::read_to_string(&point).unwrap(), bad);
        assert_eq!(results(&out), expected);
    }
    std::fs::remove_file(&point).unwrap();
    assert!(one_speed(&scene, &out).status().unwrap().success());
    assert_eq!(results(&out), expected);
}

#[test]
fn what_differs_from_the_folder_is_said_before_any_set_up() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let out = folder.path().join("out");
    assert!(one_speed(&scene, &out).status().unwrap().success());
    let (expected, manifest) = (results(&out), std::fs::read(out.join("plan.json")).unwrap());
    let bad = unmeshable(folder.path(), &scene);
    // The scene itself is refused where nothing else is.
    let fresh = folder.path().join("fresh");
    assert!(refused_by(one_speed(&bad, &fresh)).contains("unmeshable.toml"));
    assert!(!fresh.join("plan.json").exists() && !fresh.join("sweep.lock").exists());
    let text = refused_by(one_speed(&bad, &out));
    assert!(text.contains("was `flank_elements = 6` and is"), "{text}");
    for (arguments, words) in [
        (["--speeds-rpm", "1500:1600:10"], "of 1 speeds from 1600 to 1600 rpm, not 11 speeds"),
        (["--sun-torque-nm", "1000"], "computed with --sun-torque-nm 1130, not 1000"),
        (["--tolerance", "1e-5"], "--tolerance 0.0001, not 0.00001"),
        (["--most-cycles", "7"], "--most-cycles 2000, not 7"),
        (["--model", "lumped"], "the model (--model) quasi-static, not lumped"),
    ] {
        let mut command = Command::new(BINARY);
        let mut all = vec!["--speeds-rpm", "1600:1600:10", "--sun-torque-nm", "1130"];
        all.extend(["--tolerance", "1e-4", "--between-cycles", "0"]);
        match all.iter().position(|own| *own == arguments[0]) {
            Some(at) => all[at + 1] = arguments[1],
            None => all.extend(arguments),
        }
        command.arg("sweep").arg(&scene).args(all).arg("--out").arg(&out);
        let text = refused_by(command);
        assert!(text.contains(words) && text.contains("plan.json"), "{words}: {text}");
    }
    assert_eq!(results(&out), expected);
    assert_eq!(std::fs::read(out.join("plan.json")).unwrap(), manifest);
    assert_eq!(points(&out.join("points")), 1);
}

#[test]
fn a_second_process_is_told_and_a_dead_one_blocks_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let out = folder.path().join("out");
    let lock = out.join("sweep.lock");
    // Killed while it holds the folder.
    let mut first = sweep(&scene, &out).spawn().unwrap();
    let held = |pid: u32| {
        let text = std::fs::read_to_string(&lock).unwrap_or_default();
        text.trim() == pid.to_string()
    };
    let wait = |pid: u32| {
        let start = std::time::Instant::now();
        while !held(pid) {
            assert!(start.elapsed() < Duration::from_secs(60), "no lock");
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    wait(first.id());
    let text = refused_by(sweep(&scene, &out));
    let holder = format!("process {}", first.id());
    assert!(text.contains("sweep.lock") && text.contains(&holder), "{text}");
    // The first one was not disturbed.
    assert!(held(first.id()));
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(lock.exists());
    assert!(one_speed(&scene, &folder.path().join("other")).status().unwrap().success());
    assert!(sweep(&scene, &out).status().unwrap().success());
    assert!(!lock.exists() && out.join("sweep.csv").exists());
}

#[test]
fn another_number_of_speeds_about_peaks_is_refused_before_any_set_up() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let out = folder.path().join("out");
    assert!(sweep(&scene, &out).status().unwrap().success());
    let expected = results(&out);
    let text = refused_by(refined(&scene, &out, "5"));
    assert!(text.contains("made with --refine 3, not --refine 5"), "{text}");
    assert_eq!(results(&out), expected);
}

/// A coarse scene (`flank_elements = 8`) with its damping scaled.
fn damped(folder: &Path, factor: f64) -> PathBuf {
    let text = std::fs::read_to_string(coarse(folder)).unwrap();
    assert!(!text.contains("[damping]"));
    let text = text.replace("flank_elements = 6", "flank_elements = 8");
    let path = folder.join("damped.toml");
    let (mass, stiffness) = (142.9 * factor, 2.21e-6 * factor);
    let added = format!(
        "\n[damping]\nmass_proportional_per_s = {mass:e}\nstiffness_proportional_s = {stiffness:e}\n"
    );
    std::fs::write(&path, text + &added).unwrap();
    path
}

/// What a sweep of a scene prints.
fn printed(scene: &Path, torque: &str, arguments: &[&str]) -> String {
    let mut command = Command::new(BINARY);
    command.arg("sweep").arg(scene).args(["--sun-torque-nm", torque, "--between-cycles", "0"]);
    let output = command.args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Point of a sweep of one speed as JSON.
fn point(scene: &Path, torque: &str, speed: &str) -> serde_json::Value {
    let range = format!("{speed}:{speed}:10");
    let limits = ["--tolerance", "1e-3", "--most-cycles", "60", "--format", "json"];
    let text = printed(scene, torque, &[&["--speeds-rpm", &range], &limits[..]].concat());
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["failed"], serde_json::json!([]));
    json["points"][0].clone()
}

/// Amplitudes of a quantity without harmonics, of all meshes.
fn of_meshes(point: &serde_json::Value, coordinate: &str) -> Vec<f64> {
    let lines = point["lines"].as_array().unwrap().iter();
    let own = lines.filter(|line| line["coordinate"] == coordinate);
    own.map(|line| line["amplitude"].as_f64().unwrap()).collect()
}

#[test]
fn under_the_usual_torque_teeth_stay_in_contact() {
    let folder = tempfile::tempdir().unwrap();
    let found = point(&damped(folder.path(), 1.0), "1130", "1600");
    assert_eq!(found["repeats_after"], 1);
    assert_eq!(
        (found["contact_loss"].as_f64(), found["backside_contact"].as_f64()),
        (Some(0.0), Some(0.0))
    );
    let lowest = of_meshes(&found, "lowest_force");
    // An even share of the torque is 8.4 kN on each sun mesh.
    assert!(lowest.len() == 8 && lowest.iter().all(|f| (1e3..9e3).contains(f)), "{lowest:?}");
    assert_eq!(of_meshes(&found, "contact_loss"), [0.0; 8]);
    assert_eq!(of_meshes(&found, "backside_contact"), [0.0; 8]);
    // The distance to grazing is that of the mesh whose lowest force is the least part of its mean.
    let lines = found["lines"].as_array().unwrap().iter();
    let mean = lines.filter(|l| l["coordinate"] == "force" && l["harmonic"] == 0);
    let mean: Vec<f64> = mean.map(|l| l["amplitude"].as_f64().unwrap()).collect();
    assert_eq!(mean.len(), 8);
    let least =
        lowest.iter().zip(&mean).map(|(low, mean)| low / mean).fold(f64::INFINITY, f64::min);
    let margin = found["grazing_margin"].as_f64().unwrap();
    assert!((margin / least - 1.0).abs() < 1e-9 && margin < 1.0, "{margin} {least}");
}

/// A set that is itself again after half a mesh cycle is shot over half of it, which makes forbidden harmonics zero by
/// construction; over whole cycles the same motion is found, and they are results.
#[test]
fn whole_cycles_find_the_motion_of_a_part() {
    let folder = tempfile::tempdir().unwrap();
    let scene = damped(folder.path(), 1.0);
    let of = |more: &[&str]| -> Vec<(String, u64, f64)> {
        let mut all = vec!["--speeds-rpm", "1600:1600:10", "--format", "json"];
        all.extend(more);
        let result: serde_json::Value =
            serde_json::from_str(&printed(&scene, "1130", &all)).unwrap();
        let own = &result["points"][0];
        assert_eq!(own["method"], "shooting");
        let lines = own["lines"].as_array().unwrap().iter();
        let sun = lines.filter(|l| l["part"] == "sun" && l["coordinate"] == "radial");
        sun.map(|l| {
            let harmonic = l["harmonic"].as_u64().unwrap();
            (
                l["coordinate"].as_str().unwrap().to_owned(),
                harmonic,
                l["amplitude"].as_f64().unwrap(),
            )
        })
        .collect()
    };
    let (part, whole) = (of(&[]), of(&["--whole-cycles"]));
    assert!(part.len() == 6 && whole.len() == 6, "{part:?}");
    let largest = part.iter().map(|l| l.2).fold(0.0, f64::max);
    for (a, b) in part.iter().zip(&whole) {
        assert!((a.2 - b.2).abs() < 1e-7 * largest, "{a:?} {b:?}");
    }
    // Two opposed pairs move the sun sideways with odd harmonics only.
    let remainder = |of: &[(String, u64, f64)]| of[2].2.max(of[4].2) / largest;
    assert!(remainder(&part) < 1e-14 && remainder(&whole) > 1e-14, "{part:?} {whole:?}");
}

#[test]
fn under_a_light_torque_with_little_damping_teeth_part() {
    let folder = tempfile::tempdir().unwrap();
    let scene = damped(folder.path(), 0.1);
    let found = point(&scene, "20", "1620");
    let (lowest, loss) = (of_meshes(&found, "lowest_force"), of_meshes(&found, "contact_loss"));
    assert!(lowest.iter().all(|f| (0.0..150.0).contains(f)), "{lowest:?}");
    assert!(
        loss.iter().any(|share| *share > 0.0) && loss.iter().all(|share| *share < 0.5),
        "{loss:?}"
    );
    // A mesh loses contact exactly if its lowest force is 0.
    assert!(
        lowest.iter().zip(&loss).all(|(f, share)| (*f == 0.0) == (*share > 0.0)),
        "{lowest:?} {loss:?}"
    );
    assert_eq!(found["contact_loss"].as_f64(), loss.iter().copied().reduce(f64::max));
    let limits = ["--speeds-rpm", "1620:1620:10", "--tolerance", "1e-3", "--most-cycles", "60"];
    let text = printed(&scene, "20", &limits);
    assert!(text.contains("At 1 of these speeds teeth part"), "{text}");
}

/// Without damping a light load hammers: at 800 and 1600 rpm contact outgrows the largest tables. The sweep goes
/// on, says so, keeps the speed as failed, and resumes to the same bytes.
#[test]
fn a_speed_that_cannot_be_computed_is_kept_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(coarse(folder.path())).unwrap();
    let damping = "\n[damping]\nmass_proportional_per_s = 0.0\nstiffness_proportional_s = 0.0\n";
    let scene = folder.path().join("undamped.toml");
    std::fs::write(&scene, text + damping).unwrap();
    let out = folder.path().join("out");
    let run = || {
        let mut command = Command::new(BINARY);
        command.arg("sweep").arg(&scene).args(["--sun-torque-nm", "0.3", "--between-cycles", "0"]);
        command.args([
            "--speeds-rpm",
            "800:1600:400",
            "--tolerance",
            "1e-3",
            "--most-cycles",
            "200",
        ]);
        let output = command.arg("--out").arg(&out).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let printed = run();
    assert!(printed.contains("2 of 3 speeds could not be computed"), "{printed}");
    assert!(
        printed.contains("1600.0 rpm (up_00)") && printed.contains("the end of its grid"),
        "{printed}"
    );
    let first = results(&out);
    let sidecar: serde_json::Value = serde_json::from_slice(&first[1]).unwrap();
    assert_eq!(sidecar["failed"].as_array().unwrap().len(), 2);
    assert_eq!(sidecar["points"].as_array().unwrap().len(), 1);
    assert!(String::from_utf8_lossy(&first[0]).lines().skip(1).all(|row| row.contains(",1200.0,")));
    // From the stored points, and with the last of them computed anew.
    assert_eq!(run(), printed);
    std::fs::remove_file(out.join("points/up_00/0002.json")).unwrap();
    assert_eq!(run(), printed);
    assert_eq!(results(&out), first);
}
