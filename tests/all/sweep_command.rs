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
    let mut command = Command::new(BINARY);
    let range = ["--speeds-rpm", "1200:2400:100", "--torque-nm", "1130", "--tolerance", "1e-4"];
    command.arg("sweep").arg(scene).args(range).args(["--refine", "3", "--between-cycles", "0"]);
    command.arg("--out").arg(out).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn results(out: &Path) -> [Vec<u8>; 2] {
    ["sweep.csv", "sweep.json"].map(|name| std::fs::read(out.join(name)).unwrap())
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
        std::thread::sleep(Duration::from_millis(300 + (random >> 33) % 1500));
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
        (&["--torque-nm", "0"], "other than 0"),
    ];
    for (arguments, words) in cases {
        let mut all = vec!["sweep", scene];
        all.extend(arguments);
        let text = refused(&all);
        assert!(text.contains(words), "{arguments:?}: {text}");
    }
    let pair = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/oh58_sun_planet_pair.toml");
    assert!(refused(&["sweep", pair]).contains("gear_pair"));
}

#[test]
fn folders_that_hold_other_results_or_cannot_be_written_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let scene = scene.to_str().unwrap();
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let range = ["--speeds-rpm", "1600:1600:10", "--torque-nm", "1130"];
    let run = |out: &str| {
        let mut all = vec!["sweep", scene, "--out", out];
        all.extend(range);
        refused(&all)
    };
    for (manifest, words) in [
        ("{\"format\": 99}", "format 99 where this program writes 2"),
        ("nonsense", "its manifest is no JSON"),
        ("{\"format\": 2}", "its manifest lacks keys"),
    ] {
        std::fs::write(out.join("plan.json"), manifest).unwrap();
        let text = run(out.to_str().unwrap());
        assert!(text.contains(words) && text.contains("nothing was changed"), "{text}");
        assert_eq!(std::fs::read_to_string(out.join("plan.json")).unwrap(), manifest);
    }
    // A file in place of the folder represents every path that cannot be written.
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").unwrap();
    assert!(run(file.to_str().unwrap()).contains("cannot read"));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept");
}

#[cfg(target_os = "linux")]
#[test]
fn a_place_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let scene = scene.to_str().unwrap();
    let range = ["--speeds-rpm", "1600:1600:10", "--torque-nm", "1130"];
    let mut all = vec!["sweep", scene, "--out", "/proc/self/nowhere"];
    all.extend(range);
    let text = refused(&all);
    assert!(text.contains("cannot write `/proc/self/nowhere/plan.json`"), "{text}");
    // A result file that cannot be replaced is an error; the finished points stay.
    let out = folder.path().join("out");
    std::fs::create_dir_all(out.join("sweep.csv/in_the_way")).unwrap();
    all[3] = out.to_str().unwrap();
    assert!(refused(&all).contains("sweep.csv"));
    assert_eq!(points(&out.join("points")), 1);
}
