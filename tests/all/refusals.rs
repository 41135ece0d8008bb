//! Values of arguments that no gear set has, and places that cannot be written: one message that names the argument,
//! exit code 2, and no work before.

use std::path::Path;

use serde_json::Value;

use crate::harness::{coarse, json, run, scene};

/// A torque, force or approach on the command line is judged as the scene's own torque is: beyond a module of
/// deflection it is refused, with the largest that is allowed, and from a quarter of one it is warned of.
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

/// Under a load so small that rounding shows in the deflections, numbers would be wrong without a word: below a
/// millionth of a module it is refused, with the least that is allowed.
#[test]
fn loads_too_small_to_be_told_from_rounding_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let with_torque = |name: &str, torque: &str| {
        let text = std::fs::read_to_string(scene(name)).unwrap();
        let other = |l: &str| {
            if l.starts_with("torque_nm") { format!("torque_nm = {torque}") } else { l.to_owned() }
        };
        let path = folder.path().join(name);
        std::fs::write(&path, text.lines().map(|l| other(l) + "\n").collect::<String>()).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    let turning = scene("pair_50_50.toml");
    let [faint, faint_pair] = ["oh58_4p.toml", "pair_50_50.toml"].map(|n| with_torque(n, "1e-9"));
    for (line, named) in [
        (format!("static {set} --sun-torque-nm 1e-300"), "--sun-torque-nm"),
        (format!("static {set} --sun-torque-nm 500,-1e-6"), "--sun-torque-nm"),
        (format!("impulse {set} --sun-torque-nm 1e-300"), "--sun-torque-nm"),
        (format!("impulse {turning} --sun-torque-nm 1e-9"), "--sun-torque-nm"),
        (format!("sweep {set} --speeds-rpm 800:900:10 --sun-torque-nm 1e-300"), "--sun-torque-nm"),
        (format!("branches {set} --speeds-rpm 800:900 --sun-torque-nm 1e-9"), "--sun-torque-nm"),
        (format!("branches {set} --over torque --torques-nm 1e-9:900"), "--torques-nm"),
        (format!("branches {set} --over torque --torques-nm -900:-1e-9"), "--torques-nm"),
        (format!("static {pair} --normal-force-n 1e-300"), "--normal-force-n"),
        (format!("static {pair} --approach-um 1e-300"), "--approach-um"),
        (format!("static {faint}"), "`operation.torque_nm`"),
        (format!("impulse {faint}"), "`operation.torque_nm`"),
        (format!("sweep {faint} --speeds-rpm 800:900:10"), "`operation.torque_nm`"),
        (format!("sweep {faint_pair} --speeds-rpm 800:900:10"), "`operation.torque_nm`"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        let words = [named, "allowed is a magnitude above", "of the module", "rounding"];
        assert!(words.iter().all(|word| err.contains(word)), "{line}: {err}");
    }
}

/// A contact's compliance falls in proportion to the logarithm of its load, so that over loads in equal ratios the
/// compliances of a mesh are evenly spaced: down to the least torque that is accepted, where rounding would show first.
#[test]
fn the_least_torque_that_is_accepted_is_computed_to_three_digits() {
    let folder = tempfile::tempdir().unwrap();
    let set = coarse(folder.path(), "oh58_4p.toml");
    let refusal = run(&["static", &set, "--sun-torque-nm", "1e-9"]).2;
    let (_, least) = refusal.split_once("magnitude above ").unwrap();
    let least: f64 = least.split(' ').next().unwrap().parse().unwrap();
    let torques = [1.01, 10.1, 101.0].map(|factor| factor * least);
    let list = torques.map(|torque| format!("{torque:e}")).join(",");
    let line = format!("static {set} --positions 1 --format json --sun-torque-nm {list}");
    let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(code, 0, "{err}");
    let result: Value = serde_json::from_str(&out).unwrap();
    let cycles = result["torques"].as_array().unwrap();
    for mesh in 0..8 {
        let compliance = |cycle: &Value| {
            1.0 / cycle["meshes"][mesh]["mean_secant_stiffness_n_per_m"].as_f64().unwrap()
        };
        let [light, middle, heavy] = [0, 1, 2].map(|i| compliance(&cycles[i]));
        assert!(light > 1.01 * middle && middle > 1.01 * heavy, "{light} {middle} {heavy}");
        let off = (light - 2.0 * middle + heavy) / middle;
        assert!(off.abs() < 2e-3, "mesh {mesh}: {off:e}");
    }
}

/// A load of another size on a gear pair with moving shafts is refused as on a set.
#[test]
fn loads_of_turning_pairs_are_of_a_size() {
    let pair = scene("pair_50_50.toml");
    for line in [
        format!("impulse {pair} --sun-torque-nm 1e7"),
        format!("sweep {pair} --speeds-rpm 800:900:10 --sun-torque-nm 1e300"),
        format!("branches {pair} --speeds-rpm 800:900 --sun-torque-nm -1e7"),
        format!("branches {pair} --over torque --torques-nm 10:1e7"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains("allowed is a magnitude below"), "{line}: {err}");
    }
}

/// Counts of nothing, steps that lead nowhere, and factors that print as 0.
#[test]
fn counts_of_nothing_are_refused_by_their_argument() {
    let (set, pair) = (scene("oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    let deck = format!("static {pair} --approach-um 20 --export-inp deck.inp");
    for (line, argument, allowed) in [
        (format!("sweep {set} --harmonics 0"), "--harmonics", "from 1 to 10"),
        (format!("rules {set} --harmonics 0"), "--harmonics", "from 1 to 1000"),
        (format!("static {set} --positions 0"), "--positions", "from 1 to 100000"),
        (format!("sweep {set} --most-cycles 0"), "--most-cycles", "from 2 to 1000000"),
        (format!("sweep {set} --speeds-rpm 800:900:0"), "--speeds-rpm", "above 0"),
        (format!("sweep {set} --speeds-rpm 800:900:1e-300"), "--speeds-rpm", "1e302 speeds"),
        (format!("sweep {set} --tolerance 0"), "--tolerance", "1e-12 to 0.1"),
        (format!("sweep {set} --tolerance -1"), "--tolerance", "1e-12 to 0.1"),
        (
            format!("branches {set} --speeds-rpm 800:900 --max-points 0"),
            "--max-points",
            "from 2 to 100000",
        ),
        (
            format!("branches {set} --speeds-rpm 800:900 --damping-factor 1e-300"),
            "--damping-factor",
            "1e-6 to 100",
        ),
        (
            format!("branches {set} --over damping --damping-factors 1e-300:1"),
            "--damping-factors",
            "1e-6 to 100",
        ),
        (
            format!("compare modes.csv --scene {set} --tolerance-percent 0"),
            "--tolerance-percent",
            "above 0",
        ),
        (format!("{deck} --export-per-half-width 0"), "--export-per-half-width", "1 to 100"),
        (format!("{deck} --export-flank-elements 0"), "--export-flank-elements", "from 3 to 64"),
        (format!("impulse {set} --duration-ms 0"), "--duration-ms", "at least"),
        (format!("impulse {set} --step-us 1e-300"), "--duration-ms", "100000 steps"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains(argument) && err.contains(allowed), "{line}: {err}");
        assert!(!err.contains("0 % off") && err.len() < 300, "{line}: {err}");
    }
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

/// Whole numbers are refused with what is allowed, whatever else is given.
#[test]
fn whole_numbers_are_refused_with_what_is_allowed() {
    let set = scene("oh58_4p.toml");
    for (line, argument, allowed) in [
        (format!("sweep {set} --harmonics=-1"), "--harmonics", "from 1 to 10"),
        (format!("sweep {set} --harmonics 1e9"), "--harmonics", "from 1 to 10"),
        (format!("sweep {set} --refine 1e9"), "--refine", "from 0 to 1000"),
        (format!("sweep {set} --most-cycles 1e9"), "--most-cycles", "from 2 to 1000000"),
        (format!("sweep {set} --between-cycles 1.5"), "--between-cycles", "from 0 to 10000"),
        ("study studies/first.toml --rounds 1e9".to_owned(), "--rounds", "from 3 to 999"),
    ] {
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        let words = [argument, allowed, "a whole number"];
        assert!(words.iter().all(|word| err.contains(word)), "{line}: {err}");
    }
    let line = format!("sweep {set} --speeds-rpm 800:900:50 --method marching --whole-cycles");
    let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!((code, out.as_str()), (2, ""), "{line}");
    assert!(err.contains("--whole-cycles") && err.contains("--method shooting"), "{err}");
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

/// `fidelity = "auto"` answers within its tolerance or not at all, and other verbs do not take it for a fidelity.
#[test]
fn settings_that_meet_no_tolerance_are_refused_with_their_estimates() {
    let folder = tempfile::tempdir().unwrap();
    let with = |tolerance: &str| {
        let text = std::fs::read_to_string(scene("oh58_4p.toml")).unwrap();
        let keys = format!(
            "\n[dynamics]\nfidelity = \"auto\"\nquantity = \"natural_frequency\"\nmode_type = \"rotational\"\n\
             mode_number = 1\ntolerance_percent = {tolerance}\n"
        );
        let path = folder.path().join("auto.toml");
        std::fs::write(&path, text + &keys).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (code, out, err) = run(&["modes", &with("0.001")]);
    assert_eq!((code, out.as_str()), (2, ""), "{err}");
    for words in [
        "`dynamics.fidelity`",
        "lumped with parameters in closed form: estimated error",
        "quasi_static, 6 flank",
        "allow a larger",
    ] {
        assert!(err.contains(words), "{words}: {err}");
    }
    // No estimate covers gyroscopic terms.
    let turning = with("1\ngyroscopic = \"on\"");
    let (code, out, err) = run(&["modes", &turning]);
    assert_eq!((code, out.as_str()), (2, ""), "{err}");
    assert!(err.contains("`dynamics.gyroscopic`: it is \"on\": \"off\" is needed"), "{err}");
    for line in [
        "sweep @scene --speeds-rpm 800:900:10",
        "impulse @scene",
        "branches @scene --speeds-rpm 800:900",
    ] {
        let line = line.replace("@scene", &with("1"));
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}");
        assert!(err.contains("`dynamics.fidelity`: \"auto\""), "{line}: {err}");
    }
    for (tolerance, model) in [("1", "lumped"), ("0.2", "quasi_static")] {
        let (code, out, err) = run(&["modes", &with(tolerance), "--format", "json"]);
        assert_eq!(code, 0, "{err}");
        let found: Value = serde_json::from_str(&out).unwrap();
        let auto = &found["auto"];
        assert_eq!(auto["settings"]["model"], model);
        let allowed: f64 = tolerance.parse().unwrap();
        assert!(auto["estimated_error_percent"].as_f64().unwrap() <= allowed);
        let hz = auto["value"].as_f64().unwrap();
        // docs/fe_dynamics.md: 1152.3 Hz by linearisation at 1130 N·m.
        assert!((100.0 * (hz / 1152.3 - 1.0)).abs() < allowed, "{hz}");
        // The modes of the set that was chosen are listed, the answer among them.
        let listed = found["modes"].as_array().unwrap();
        assert_eq!(listed.is_empty(), model != "lumped");
        let is_answer = |mode: &Value| mode["frequency_hz"].as_f64() == Some(hz);
        assert_eq!(listed.iter().filter(|mode| is_answer(mode)).count(), listed.len().min(1));
    }
}

/// `fidelity = "auto"` for a transmission error at rest and for an amplitude: the choice stands with the result,
/// arguments that it decides are refused, and so is a quantity that the verb does not give.
#[test]
fn settings_are_chosen_for_transmission_errors_and_amplitudes() {
    let folder = tempfile::tempdir().unwrap();
    let rest = "quantity = \"transmission_error\"\ntolerance_percent = 20\n";
    let rest = with_auto(folder.path(), "rest.toml", rest);
    let motion = with_auto(folder.path(), "motion.toml", MOTION);
    let cases = [
        ("static @rest --positions 28", "--positions"),
        ("static @rest --solver lemke", "--solver"),
        ("static @rest --sun-torque-nm 500,1000", "--sun-torque-nm"),
        ("modes @rest", "`static` gives"),
        ("sweep @rest --speeds-rpm 800:900:10", "`static` gives"),
        ("modes @motion", "`sweep` gives"),
        ("branches @motion --speeds-rpm 800:900", "`sweep` gives"),
        ("sweep @motion --speeds-rpm 800:900:10 --model lumped", "--model"),
        ("sweep @motion --speeds-rpm 800:900:10 --refine 3", "--refine"),
        ("sweep @motion --speeds-rpm 800:900:10 --both-ways", "--both-ways"),
        ("sweep @motion --speeds-rpm 800:900:10 --out O", "--out"),
        ("sweep @motion --speeds-rpm 800:900:10 --harmonics 6", "--harmonics"),
    ];
    for (line, words) in cases {
        let line = line.replace("@rest", &rest).replace("@motion", &motion);
        let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!((code, out.as_str()), (2, ""), "{line}: {err}");
        assert!(err.contains(words) && !err.contains("unexpected argument"), "{line}: {err}");
        // The number of steps is chosen: nothing is said of the scene's own.
        assert!(!err.contains("steps in a") && !err.contains("steps_per_cycle"), "{line}: {err}");
    }
    let found = chosen(&format!("static {rest} --format json"));
    let cycle = &found["torques"][0];
    let of_the_cycle = cycle["transmission_error_peak_to_peak_um"].as_f64().unwrap();
    let value = found["auto"]["value"].as_f64().unwrap();
    assert!((of_the_cycle / value - 1.0).abs() < 1e-9, "{of_the_cycle}");
    let positions = cycle["positions"].as_array().unwrap().len() as u64;
    assert_eq!(found["auto"]["settings"]["positions"], positions);
    let (code, text, err) = run(&["static", &rest]);
    assert!(code == 0 && text.contains("chosen: "), "{err}");
}

/// A sweep takes the settings that are chosen for an amplitude.
#[test]
#[ignore = "long: .ci/full runs it"]
fn a_sweep_has_the_settings_chosen_for_an_amplitude() {
    let folder = tempfile::tempdir().unwrap();
    let motion = with_auto(folder.path(), "motion.toml", MOTION);
    let found = chosen(&format!("sweep {motion} --speeds-rpm 800:840:40 --format json"));
    assert_eq!(found["steps_per_cycle"], found["auto"]["settings"]["steps_per_cycle"]);
    assert_eq!(found["points"].as_array().unwrap().len(), 2);
}

/// The result of a call with `fidelity = "auto"` that succeeds.
fn chosen(line: &str) -> Value {
    let found = json(&line.split(' ').collect::<Vec<_>>());
    let auto = &found["auto"];
    let number = |key: &str| auto[key].as_f64().unwrap();
    assert!(number("value") > 0.0 && auto["unit"] == "µm", "{auto}");
    assert!(number("estimated_error_percent") <= number("tolerance_percent"), "{auto}");
    found
}

const MOTION: &str =
    "quantity = \"amplitude\"\nresponse = \"sun_translation\"\ntolerance_percent = 40\n";

/// OH-58 with four planets and settings to be chosen.
fn with_auto(folder: &Path, name: &str, keys: &str) -> String {
    let text = std::fs::read_to_string(scene("oh58_4p.toml")).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, format!("{text}\n[dynamics]\nfidelity = \"auto\"\n{keys}")).unwrap();
    path.to_str().unwrap().to_owned()
}
