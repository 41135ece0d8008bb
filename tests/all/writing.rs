//! Results that cannot be saved: refused before anything is computed where that can be known, and shown in any case.

use std::path::Path;

use crate::harness::{coarse, run, scene};

/// Where results are to go is looked at before they are computed: what was computed would be shown.
#[test]
fn folders_that_cannot_be_made_are_refused_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file.toml");
    std::fs::write(&file, "kept").unwrap();
    let file = file.to_str().unwrap();
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/first.toml");
    let (set, pair, study) = (scene("oh58_4p.toml"), scene("pair_50_50.toml"), study.display());
    for below in ["", "/below"] {
        for line in [
            format!("stability integrators --out {file}{below}"),
            format!("stability transients --out {file}{below}"),
            format!("study {study} --out {file}{below}"),
            format!("branches {pair} --speeds-rpm 2000:2100 --figures {file}{below}"),
            format!("sweep {pair} --speeds-rpm 2000:2100:50 --figures {file}{below}"),
            format!("impulse {set} --figures {file}{below}"),
            format!("validate --only table3. --report {file}{below}"),
        ] {
            let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
            assert_eq!((code, out.as_str()), (2, ""), "{line}");
            let is_named =
                err.contains(file) && err.lines().filter(|l| l.contains(file)).count() == 1;
            assert!(is_named, "{line}: {err}");
            assert_eq!(std::fs::read_to_string(file).unwrap(), "kept");
        }
    }
}

/// A folder in place of a file that is to be written is found before, where the name of the file is known; the folder
/// of results holds nothing else then.
#[test]
fn folders_in_place_of_results_are_refused_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["integrators.json", "integrators.csv"] {
        let own = folder.path().join(format!("for_{name}"));
        std::fs::create_dir_all(own.join(name)).unwrap();
        let (code, out, err) = run(&["stability", "integrators", "--out", own.to_str().unwrap()]);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(err.contains(name) && err.contains("cannot write"), "{err}");
        assert_eq!(std::fs::read_dir(&own).unwrap().count(), 1);
    }
}

/// Where saving fails after all, here by a folder in place of a figure, the result is on standard output all the same.
#[cfg(feature = "charts")]
#[test]
fn what_cannot_be_saved_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let set = coarse(folder.path(), "oh58_4p.toml");
    let (pair, turning) = (scene("oh58_sun_planet_pair.toml"), scene("pair_50_50.toml"));
    for (number, (line, argument)) in [
        ("stability integrators".to_owned(), "--out"),
        (format!("static {pair} --normal-force-n 1e4 --positions 3"), "--figures"),
        (format!("static {set} --positions 2"), "--figures"),
        (format!("sweep {turning} --speeds-rpm 2000:2050:50"), "--figures"),
    ]
    .into_iter()
    .enumerate()
    {
        let [good, bad] =
            ["good", "bad"].map(|name| folder.path().join(format!("{name}_{number}")));
        let into = |folder: &Path| {
            let mut words: Vec<&str> = line.split(' ').collect();
            words.extend([argument, folder.to_str().unwrap()]);
            run(&words)
        };
        let (code, shown, err) = into(&good);
        assert_eq!(code, 0, "{line}: {err}");
        let names = std::fs::read_dir(&good).unwrap().map(|e| e.unwrap().file_name());
        let names: Vec<String> = names.map(|n| n.to_str().unwrap().to_owned()).collect();
        let svg = names.iter().find(|name| name.ends_with(".svg")).unwrap();
        assert!(names.iter().all(|name| !name.ends_with(".part")), "{names:?}");
        std::fs::create_dir_all(bad.join(svg)).unwrap();
        let (code, out, err) = into(&bad);
        assert_eq!(code, 2, "{line}");
        assert_eq!(out, shown, "{line}");
        assert!(err.contains(svg) && err.contains("cannot write"), "{line}: {err}");
    }
}
