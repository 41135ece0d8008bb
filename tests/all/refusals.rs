//! Values of arguments that no gear set has, and places that cannot be written: one message that names the argument, exit
//! code 2, and no work before.

use crate::command::{run, scene};

/// A torque, force or approach on the command line is judged as the scene's own torque is: beyond a module of deflection it is
/// refused, with the largest that is allowed, and from a quarter of one it is warned of.
#[test]
fn loads_of_another_size_are_refused_or_warned_of() {
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    for (line, argument) in [
        (format!("static {set} --sun-torque-nm 1e300"), "--sun-torque-nm"),
        (format!("static {set} --sun-torque-nm 500,-1e6"), "--sun-torque-nm"),
        (format!("impulse {set} --sun-torque-nm 1e6"), "--sun-torque-nm"),
        (format!("sweep {set} --speeds-rpm 800:900:10 --sun-torque-nm 1e6"), "--sun-torque-nm"),
        (format!("branches {set} --speeds-rpm 800:900 --sun-torque-nm 1e6"), "--sun-torque-nm"),
        (format!("static {pair} --normal-force-n 1e9"), "--normal-force-n"),
        (format!("static {pair} --approach-um 1e6"), "--approach-um"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        let words = [argument, "allowed is a magnitude below", "of the module"];
        assert!(words.iter().all(|word| err.contains(word)), "{line}: {err}");
    }
    // Module 2.8 mm, 25.4 mm of face: E b/13 gives way by 1 mm under 0.4 MN.
    let (code, _, err) = run(&["static", &pair, "--normal-force-n", "4e5", "--positions", "1"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("warning: --normal-force-n is 400000 N"), "{err}");
    let (_, _, err) = run(&["static", &pair, "--normal-force-n", "1e4", "--positions", "1"]);
    assert!(err.is_empty(), "{err}");
}

#[test]
fn speeds_that_no_shaft_has_are_refused() {
    let set = scene("oh58_4p.toml");
    for (line, argument) in [
        (format!("modes {set} --carrier-speeds-rpm 1e300"), "--carrier-speeds-rpm"),
        (format!("modes {set} --carrier-speeds-rpm nan"), "--carrier-speeds-rpm"),
        (format!("sweep {set} --speeds-rpm 1e-300:1e-300:1"), "--speeds-rpm"),
        (format!("sweep {set} --speeds-rpm 1e8:1e8:1"), "--speeds-rpm"),
        (format!("branches {set} --speeds-rpm 1e-300:900"), "--speeds-rpm"),
        (format!("branches {set} --speeds-rpm 800:1e30"), "--speeds-rpm"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(argument) && err.contains("1e7 rpm"), "{line}: {err}");
        assert!(err.len() < 300, "{line}: {err}");
    }
}

/// Where figures, meshes and decks are to go is looked at before the work whose results they are.
#[test]
fn places_that_cannot_be_written_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").unwrap();
    let (file, folder) = (file.to_str().unwrap(), folder.path().to_str().unwrap());
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    for line in [
        format!("static {set} --figures {file}"),
        format!("static {pair} --normal-force-n 1e4 --figures {file}/below"),
        format!("impulse {set} --figures {file}"),
        format!("sweep {set} --speeds-rpm 800:900:10 --figures {file}"),
        format!("branches {set} --speeds-rpm 800:900 --figures {file}"),
        format!("mesh {set} --vtu {file}"),
        format!("mesh {set} --svg {folder}"),
        format!("mesh {set} --svg {file}/mesh.svg"),
        format!("static {pair} --approach-um 20 --export-inp {folder}"),
        format!("static {pair} --approach-um 20 --export-inp {file}/deck.inp"),
    ] {
        let start = std::time::Instant::now();
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(folder) && err.lines().count() == 1, "{line}: {err}");
        // Meshing alone takes longer than reading the scene by a factor of a hundred.
        println!("{line}: {:.3} s", start.elapsed().as_secs_f64());
        assert_eq!(std::fs::read_to_string(file).unwrap(), "kept");
    }
}

/// A negative number is the value of its argument, which says what is allowed, and no option of its own.
#[test]
fn negative_numbers_are_refused_by_their_argument() {
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    for (line, argument) in [
        (format!("rules {set} --harmonics -1"), "--harmonics"),
        (format!("static {set} --positions -1"), "--positions"),
        (format!("static {pair} --approach-um -3"), "--approach-um"),
        (format!("sweep {set} --speeds-rpm 800:900:10 --harmonics -1"), "--harmonics"),
        (format!("sweep {set} --speeds-rpm 800:900:10 --refine -1"), "--refine"),
        (format!("sweep {set} --speeds-rpm 800:900:10 --most-cycles -1"), "--most-cycles"),
        (format!("branches {set} --speeds-rpm 800:900 --max-points -1"), "--max-points"),
        (format!("compare modes.csv --scene {set} --tolerance-percent -1"), "--tolerance-percent"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(argument) && !err.contains("unexpected argument"), "{line}: {err}");
    }
}
