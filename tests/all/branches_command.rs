//! The verb `branches` with a folder: interrupted, repeated, and refused.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::harness::run;

/// The gear pair of the catalogue with coarse elements, whose branch at twice its damping has two folds.
fn coarse(folder: &Path) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("scenes/pair_50_50.toml")).unwrap();
    assert!(!text.contains("[fe_contact]") && !text.contains("[dynamics]"));
    let path = folder.join("coarse.toml");
    let added = "\n[fe_contact]\nflank_elements = 8\n\n[dynamics]\nfidelity = \"mesh_law\"\nsteps_per_cycle = 70\n";
    std::fs::write(&path, text + added).unwrap();
    path
}

fn words(scene: &Path, out: &Path) -> Vec<String> {
    let (scene, out) = (scene.display(), out.display());
    let line = format!(
        "branches {scene} --speeds-rpm 3700:4200 --start 4000 --damping-factor 2 --switch --format csv --out {out}"
    );
    line.split_whitespace().map(str::to_owned).collect()
}

fn branches(scene: &Path, out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_epicyclic"));
    command.args(words(scene, out)).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn results(out: &Path) -> [Vec<u8>; 2] {
    ["branches.csv", "branches.json"].map(|name| std::fs::read(out.join(name)).unwrap())
}

/// Files of finished steps below a folder, with when they were written.
fn steps(folder: &Path) -> Vec<(PathBuf, std::time::SystemTime)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut found = Vec::new();
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            found.extend(steps(&path));
        } else if path.extension().is_some_and(|e| e == "json") {
            found.push((path.clone(), path.metadata().unwrap().modified().unwrap()));
        }
    }
    found.sort();
    found
}

/// Killed every few steps, on one thread or on two, the results have the same bytes, and no finished
/// step is lost or taken again; complete, the same command takes no step at all, with or without the steps' files.
#[test]
fn branches_killed_every_few_steps_or_on_one_thread_have_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = coarse(folder.path());
    let whole = folder.path().join("whole");
    assert!(branches(&scene, &whole).env("RAYON_NUM_THREADS", "2").status().unwrap().success());
    let expected = results(&whole);
    assert!(expected[0].len() > 100_000);
    let text = String::from_utf8(expected[0].clone()).unwrap();
    assert!(text.contains(",fold,"), "the branch has no fold");

    let one = folder.path().join("one");
    assert!(branches(&scene, &one).env("RAYON_NUM_THREADS", "1").status().unwrap().success());
    assert_eq!(results(&one), expected);

    let broken = folder.path().join("broken");
    let (mut kept, mut interruptions) = (Vec::new(), 0);
    loop {
        let mut child = branches(&scene, &broken).spawn().unwrap();
        // Killed some steps later, at no particular moment within a step.
        let enough = kept.len() + 3 + 7 * interruptions % 12;
        let ended = loop {
            if steps(&broken.join("steps")).len() >= enough {
                child.kill().unwrap();
                break false;
            }
            if child.try_wait().unwrap().is_some() {
                break true;
            }
            std::thread::sleep(Duration::from_millis(1));
        };
        assert!(child.wait().unwrap().success() || !ended);
        let now = steps(&broken.join("steps"));
        assert!(kept.iter().all(|old| now.contains(old)), "a step was lost or taken again");
        kept = now;
        if broken.join("steps/whole/0000.json").exists() {
            break;
        }
        interruptions += 1;
    }
    println!("{interruptions} interruptions, {} steps", kept.len());
    assert!(interruptions >= 5);
    assert!(branches(&scene, &broken).status().unwrap().success());
    assert_eq!(results(&broken), expected);

    // Finished: nothing is computed, so that steps that are away stay away.
    let before = steps(&broken.join("steps"));
    assert!(branches(&scene, &broken).status().unwrap().success());
    assert_eq!(steps(&broken.join("steps")), before);
    std::fs::remove_dir_all(broken.join("steps/tables_0")).unwrap();
    assert!(branches(&scene, &broken).status().unwrap().success());
    assert_eq!(steps(&broken.join("steps")).len(), 1);
    assert_eq!(results(&broken), expected);

    // Cut off after any step, deterministically: the last third of the steps and the result are away.
    let cut = folder.path().join("cut");
    assert!(branches(&scene, &cut).status().unwrap().success());
    let all: Vec<PathBuf> = steps(&cut.join("steps")).into_iter().map(|(path, _)| path).collect();
    let upwards: Vec<&PathBuf> =
        all.iter().filter(|p| p.components().any(|c| c.as_os_str() == "up")).collect();
    assert!(upwards.len() > 3, "{upwards:?}");
    for path in &upwards[upwards.len() / 3..] {
        std::fs::remove_file(path).unwrap();
    }
    std::fs::remove_dir_all(cut.join("steps/whole")).unwrap();
    assert!(branches(&scene, &cut).status().unwrap().success());
    assert_eq!(results(&cut), expected);
}

/// A folder of another scene or setting, of a sweep, or of a step that was changed is refused with a message that says
/// what differs, and stays as it is.
#[test]
fn folders_of_something_else_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (coarse(folder.path()), folder.path().join("out"));
    let line = |range: &str, more: &str| {
        let (scene, out) = (scene.display(), out.display());
        let line = format!("branches {scene} --speeds-rpm {range} --out {out} {more}");
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    let call = |words: Vec<String>| run(&words.iter().map(String::as_str).collect::<Vec<_>>());
    let (code, first, err) = call(line("1000:1010", ""));
    assert_eq!(code, 0, "{err}");
    let before = (results(&out), steps(&out));
    for (range, more, said) in [
        ("1000:1020", "", "a range 1000:1010, not 1000:1020"),
        ("1000:1010", "--start 1000", "--start 1010, not 1000"),
        ("1000:1010", "--damping-factor 2", "--damping-factor 1, not 2"),
        ("1000:1010", "--max-points 9", "--max-points 500, not 9"),
        ("1000:1010", "--switch", "--switch no, not yes"),
    ] {
        let (code, _, err) = call(line(range, more));
        assert_eq!(code, 2, "{err}");
        assert!(err.contains(said) && err.contains("--out"), "{said}: {err}");
    }
    let sweep: Vec<String> =
        format!("sweep {} --speeds-rpm 1000:1010:10 --out {}", scene.display(), out.display())
            .split(' ')
            .map(str::to_owned)
            .collect();
    let (code, _, err) = call(sweep);
    assert!(code == 2 && err.contains("it is of something else, not of a sweep"), "{err}");
    assert_eq!((results(&out), steps(&out)), before);
    // The same again, from the folder.
    let (code, again, err) = call(line("1000:1010", ""));
    assert_eq!((code, again), (0, first), "{err}");

    // A result that was changed is not believed.
    let whole = out.join("steps/whole/0000.json");
    let text = std::fs::read_to_string(&whole).unwrap();
    std::fs::write(&whole, text.replacen("\"is_stable\":true", "\"is_stable\":false", 1)).unwrap();
    let (code, _, err) = call(line("1000:1010", ""));
    assert!(code == 2 && err.contains("checksum") && err.contains("0000.json"), "{err}");
    // Another scene.
    let text = std::fs::read_to_string(&scene).unwrap();
    std::fs::write(&scene, text.replace("steps_per_cycle = 70", "steps_per_cycle = 60")).unwrap();
    let (code, _, err) = call(line("1000:1010", ""));
    assert!(code == 2 && err.contains("steps_per_cycle = 70"), "{err}");
}
