//! `modes` and `compare` of sets with parameters in closed form.

use serde_json::Value;

use super::harness::{run, scene, sentences};

/// A shipped scene without its table `[lumped]`.
fn bare(name: &str) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    let (head, tail) = text.split_once("\n[lumped]").unwrap();
    format!("{head}\n{}", tail.find("\n[").map_or("", |end| &tail[end..]))
}

/// Frequencies (Hz), each as often as it occurs, with their stated errors (percent) where they have a bound.
fn frequencies(text: &str) -> (Value, Vec<(f64, Option<f64>)>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set.toml");
    std::fs::write(&path, text).unwrap();
    let (code, out, err) = run(&["modes", path.to_str().unwrap(), "--format", "json"]);
    assert_eq!(code, 0, "{err}");
    let found: Value = serde_json::from_str(&out).unwrap();
    let of = |mode: &Value| {
        let own =
            (mode["frequency_hz"].as_f64().unwrap(), mode["stated_error"]["percent"].as_f64());
        vec![own; mode["multiplicity"].as_u64().unwrap() as usize]
    };
    let all = found["modes"].as_array().unwrap().iter().flat_map(of).collect();
    (found, all)
}

#[test]
fn parameters_follow_from_the_geometry_without_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set.toml");
    let path = path.to_str().unwrap();
    let shown = |text: &str| {
        std::fs::write(path, text).unwrap();
        run(&["modes", path])
    };
    let text = bare("oh58_4p.toml");
    let (code, out, err) = shown(&text);
    assert_eq!((code, err.as_str()), (0, ""));
    let words = "lumped model, parameters from the geometry in closed form";
    assert!(sentences(&out).contains(words), "{out}");
    assert_eq!(shown(&format!("{text}\n[lumped]\nfrom = \"geometry\"\n")), (code, out, err));
    // Numbers are taken as they are, and state no error.
    let (given, frequencies) =
        frequencies(&std::fs::read_to_string(scene("oh58_4p.toml")).unwrap());
    assert!(given.get("parameters").is_none());
    assert!(frequencies.iter().all(|(_, stated)| stated.is_none()));
    std::fs::write(
        path,
        format!("{text}\n[lumped]\nfrom = \"geometry\"\nmass_kg = {{ sun = 1 }}\n"),
    )
    .unwrap();
    let (code, _, err) = run(&["modes", path]);
    assert_eq!((code, err.matches("lumped.mass_kg").count()), (2, 1), "{err}");
}

/// A pasted table leaves what its comment says, and little of the frequencies that bearings govern: most of it is the
/// flexibility between seats, which no table holds.
#[test]
fn a_pasted_table_leaves_what_it_says() {
    for name in ["oh58_4p.toml", "oh58_3p.toml", "five_planets.toml"] {
        let (code, table, err) = run(&["modes", &scene(name), "--parameters"]);
        assert_eq!(code, 0, "{err}");
        let of = |words: &str| -> f64 {
            let (_, tail) = table.split_once(words).unwrap();
            tail.split_whitespace().next().unwrap().parse().unwrap()
        };
        let (bearing, left) = (of("planet.bearing_n_per_m = "), of("stated error are within "));
        let text = bare(name);
        let (head, tail) = text.split_once("\n[planet]\nbearing_n_per_m = ").unwrap();
        let end = tail.find(|c: char| c.is_whitespace()).unwrap();
        let pasted =
            format!("{head}\n[planet]\nbearing_n_per_m = {bearing:e}{}\n{table}", &tail[end..]);
        let ((found, own), (_, other)) = (frequencies(&text), frequencies(&pasted));
        assert_eq!(found["parameters"]["mass_kg"].as_object().unwrap().len(), 3);
        assert_eq!(own.len(), other.len());
        for ((hz, stated), (pasted_hz, given)) in own.into_iter().zip(other) {
            assert!(given.is_none());
            let Some(stated) = stated else { continue };
            let off = 100.0 * (pasted_hz / hz - 1.0).abs();
            assert!(off < left + 0.01, "{name}: {hz} {pasted_hz}");
            assert!(hz > 5000.0 || off < 0.6, "{name}: {hz} {pasted_hz} {stated}");
        }
    }
}

#[test]
fn what_has_no_closed_form_says_why_and_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set.toml");
    let path = path.to_str().unwrap();
    let text = bare("oh58_4p.toml");
    let factor = "\n[fe_contact]\nflexibility_factor = { sun_planet = 1.1 }\n";
    for (text, words) in [
        (text.clone() + factor, "`fe_contact.flexibility_factor` is not 1; give `lumped.mass_kg`"),
        (text.replace("torque_nm = ", "torque_nm = 0 # "), "`operation.torque_nm`: "),
        (text.replace("[geometry.carrier]", "[strange]"), "strange"),
    ] {
        std::fs::write(path, text).unwrap();
        for arguments in [vec!["modes", path], vec!["modes", path, "--parameters"]] {
            let (code, out, err) = run(&arguments);
            assert_eq!((code, out.as_str()), (2, ""), "{words}");
            assert!(err.contains(words), "{words}: {err}");
        }
    }
    std::fs::write(path, text).unwrap();
    let (code, _, err) = run(&["modes", path, "--carrier-speeds-rpm", "100"]);
    assert!(code == 2 && err.contains("no gyroscopic terms"), "{err}");
    let (code, _, err) = run(&["modes", &scene("pair_50_50.toml"), "--parameters"]);
    assert!(code == 2 && err.contains("`lumped`"), "{err}");
}

#[test]
fn frequencies_of_others_are_compared_with_closed_forms() {
    let folder = tempfile::tempdir().unwrap();
    let [set, modes] = ["set.toml", "modes.csv"].map(|name| folder.path().join(name));
    std::fs::write(&set, bare("oh58_4p.toml")).unwrap();
    // docs/fe_dynamics.md: by linearisation of FE/contact.
    std::fs::write(&modes, "frequency_hz,mode_type\n1152.3,rotational\n").unwrap();
    let [set, modes] = [&set, &modes].map(|path| path.to_str().unwrap());
    let (_, out, err) = run(&["compare", modes, "--scene", set, "--tolerance-percent", "0.4"]);
    assert!(
        out.starts_with("against the lumped model, parameters from the geometry"),
        "{out}{err}"
    );
    let row = out.lines().find(|line| line.contains("1152.30")).unwrap();
    assert!(row.contains("agrees"), "{row}");
}
