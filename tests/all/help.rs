//! Help against what the verbs do: the formats and figures that it lists are those that a verb has, and no others.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use crate::harness::{coarse, run, scene};
use crate::results_command::results_folder;
use crate::study_command::small;

/// A text without the escape sequences of its colours.
fn plain(text: &str) -> String {
    let of = |part: &str| {
        let escaped = part.strip_prefix('[').and_then(|rest| rest.split_once('m'));
        escaped.map_or(part, |(_, text)| text).to_owned()
    };
    text.split('\u{1b}').map(of).collect()
}

/// Exit code, stdout and stderr; arguments here have no spaces of their own.
fn ran(line: &str) -> (u8, String, String) {
    let (code, out, err) = run(&line.split(' ').collect::<Vec<_>>());
    (code, plain(&out), plain(&err))
}

fn good(line: &str) -> String {
    let (code, out, err) = ran(line);
    assert_eq!(code, 0, "{line}: {err}");
    out
}

fn help(verb: &str) -> String {
    good(format!("{verb} --help").trim_start())
}

/// Every verb that the help of the command lists, those of `scene` and `results` with their own names.
fn verbs() -> Vec<String> {
    let listed = |text: &str| -> Vec<String> {
        let (_, list) = text.split_once("Commands:\n").unwrap();
        let list = list.split("\n\n").next().unwrap();
        let names = list.lines().filter(|l| l.starts_with("  ") && !l.starts_with("   "));
        let names = names.map(|l| l.split_whitespace().next().unwrap().to_owned());
        names.filter(|name| name != "help").collect()
    };
    let mut all = listed(&help(""));
    for verb in ["scene", "results"] {
        all.retain(|name| name != verb);
        all.extend(listed(&help(verb)).into_iter().map(|name| format!("{verb} {name}")));
    }
    all
}

/// What the help says of an option: from its name to the next option.
fn about(help: &str, option: &str) -> Option<String> {
    let (_, rest) = help.split_once(&format!("      {option} "))?;
    let end = ["\n      --", "\n  -h"].iter().filter_map(|next| rest.find(next)).min();
    let text = &rest[..end.unwrap_or(rest.len())];
    Some(text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// A short run of each verb that prints a result.
fn short(verb: &str, plain: &str) -> Option<String> {
    let pair = scene("oh58_sun_planet_pair.toml");
    let modes = Path::new(plain).with_file_name("modes.csv");
    std::fs::write(&modes, "frequency_hz\n770\n").unwrap();
    Some(match verb {
        "validate" => "validate --only table1.".to_owned(),
        "modes" | "rules" | "mesh" | "scene check" => format!("{verb} {plain}"),
        "static" => format!("static {pair} --normal-force-n 1e4 --positions 2"),
        "impulse" => format!("impulse {plain} --duration-ms 10"),
        "sweep" => format!(
            "sweep {plain} --speeds-rpm 800:810:10 --model lumped --tolerance 1e-3 --between-cycles 0"
        ),
        "branches" => format!("branches {plain} --speeds-rpm 990:1000 --model lumped"),
        "stability" => "stability explicit-step".to_owned(),
        "compare" => format!("compare {} --scene {plain} --tolerance-percent 100", modes.display()),
        "study" => {
            format!("study {} --rounds 3", small(Path::new(plain).parent().unwrap()).display())
        }
        "results check" => {
            format!("results check {}", results_folder(Path::new(plain).parent().unwrap()))
        }
        "snapshot" => {
            let results = results_folder(Path::new(plain).parent().unwrap());
            good(&format!("snapshot {results}"));
            format!("snapshot {results} --check")
        }
        "scene new" | "scene schema" | "results new" | "dataset" => return None,
        other => panic!("`{other}` is a new verb: give it a short run here"),
    })
}

/// A format that help does not list is refused; text and JSON are in `every_verb_keeps_to_its_formats`, CSV in
/// `a_row_of_csv_is_what_help_says`.
#[test]
fn every_verb_has_the_formats_of_its_help() {
    let folder = tempfile::tempdir().unwrap();
    let plain = coarse(folder.path(), "oh58_4p.toml");
    let all = verbs();
    assert!(all.len() >= 12, "{all:?}");
    let mut with_csv = BTreeSet::new();
    let mut rows = String::new();
    for verb in &all {
        let format = about(&help(verb), "--format");
        let line = short(verb, &plain);
        assert_eq!(format.is_some(), line.is_some(), "{verb}");
        let (Some(format), Some(line)) = (format, line) else { continue };
        assert!(format.contains("- text: ") && format.contains("- json: "), "{verb}: {format}");
        for name in ["csv", "yaml"] {
            if format.contains(&format!("- {name}: ")) {
                continue;
            }
            let (code, out, err) = ran(&format!("{line} --format {name}"));
            assert_eq!((code, out.as_str()), (2, ""), "{line} --format {name}");
            assert!(err.contains(&format!("invalid value '{name}'")), "{err}");
        }
        if let Some((_, csv)) = format.split_once("- csv: ") {
            with_csv.insert(verb.clone());
            rows = csv.to_owned();
        }
    }
    // What a row is, the help says for the verbs that have CSV and for no others.
    let named: BTreeSet<String> = rows.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    assert_eq!(named, with_csv, "{rows}");
}

/// Number of rows of a table.
fn rows(line: &str) -> usize {
    let table = good(&format!("{line} --format csv"));
    csv::Reader::from_reader(table.as_bytes()).records().map(Result::unwrap).count()
}

fn json(line: &str) -> Value {
    serde_json::from_str(&good(&format!("{line} --format json"))).unwrap()
}

fn list<'a>(value: &'a Value, key: &str) -> &'a Vec<Value> {
    value[key].as_array().unwrap_or_else(|| panic!("{key}: {value}"))
}

/// A row of CSV is what the help says: the counts are those of the same result as JSON.
#[test]
fn a_row_of_csv_is_what_help_says() {
    let folder = tempfile::tempdir().unwrap();
    let plain = coarse(folder.path(), "oh58_4p.toml");
    let line = short("static", &plain).unwrap();
    let pairs =
        |positions: &Vec<Value>| positions.iter().map(|p| list(p, "pairs").len()).sum::<usize>();
    assert_eq!(rows(&line), pairs(list(&json(&line), "positions")), "{line}");
    let line = format!("static {plain} --positions 2 --sun-torque-nm 500,-900");
    let result = json(&line);
    let positions = list(&result, "torques").iter().flat_map(|torque| list(torque, "positions"));
    let expected: usize = positions.map(|position| pairs(list(position, "meshes"))).sum();
    assert_eq!(rows(&line), expected, "{line}");
    let line = short("impulse", &plain).unwrap();
    let result = json(&line);
    let modes = list(&result, "modes").len() + list(&result, "outside_band").len();
    assert_eq!(rows(&line), modes, "{line}");
    let line = short("stability", &plain).unwrap();
    assert_eq!(rows(&line), list(&json(&line), "borders").len(), "{line}");
    assert_eq!(rows("stability"), list(&json("stability"), "maps").len());
    let line = short("study", &plain).unwrap();
    let result = json(&line);
    let expected: usize =
        list(&result, "quantities").iter().map(|own| list(own, "rows").len()).sum();
    assert_eq!(rows(&line), expected, "{line}");
    for (verb, key) in [("sweep", ["chain", "speed_rpm"]), ("branches", ["branch", "point"])] {
        let line = short(verb, &plain).unwrap();
        let table = good(&format!("{line} --format csv"));
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let header = reader.headers().unwrap().clone();
        let column = |name: &str| header.iter().position(|h| h == name).unwrap();
        let places = [key[0], key[1], "body", "coordinate", "harmonic"].map(column);
        let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        let cells = |places: &[usize]| -> BTreeSet<Vec<String>> {
            records.iter().map(|r| places.iter().map(|p| r[*p].to_owned()).collect()).collect()
        };
        // Each quantity with its harmonics once at every point.
        let [points, quantities] = [&places[..2], &places[2..]].map(|p| cells(p).len());
        assert_eq!(cells(&places).len(), records.len(), "{line}");
        assert_eq!(points * quantities, records.len(), "{line}");
        assert!(points > 1 && cells(&places[4..]).len() == 6, "{line}");
    }
}

/// Names of the figures in a folder, each of which is there as SVG and as PNG.
fn figures(folder: &Path) -> BTreeSet<String> {
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let (svg, png): (Vec<_>, Vec<_>) =
        files.partition(|f| f.extension().is_some_and(|e| e == "svg"));
    let stems = |files: Vec<std::path::PathBuf>| -> BTreeSet<String> {
        files.iter().map(|f| f.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
    };
    let (svg, png) = (stems(svg), stems(png));
    assert_eq!(svg, png, "{}", folder.display());
    svg
}

/// Verbs whose help has `--figures` draw the figures that it names and no others; verbs without it refuse it.
#[test]
fn every_verb_draws_the_figures_of_its_help() {
    let folder = tempfile::tempdir().unwrap();
    let plain = coarse(folder.path(), "oh58_4p.toml");
    let mut drawing = Vec::new();
    for verb in verbs() {
        let Some(line) = short(&verb, &plain) else { continue };
        let Some(text) = about(&help(&verb), "--figures") else {
            let (code, out, err) = ran(&format!("{line} --figures out"));
            assert_eq!((code, out.as_str()), (2, ""), "{verb}");
            assert!(err.contains("unexpected argument '--figures'"), "{verb}: {err}");
            continue;
        };
        assert!(text.contains("SVG, PNG"), "{verb}: {text}");
        let more = match verb.as_str() {
            "static" => vec![format!("static {plain} --positions 4 --sun-torque-nm 500,900")],
            "impulse" => vec![format!("{line} --band")],
            _ => Vec::new(),
        };
        let mut drawn = BTreeSet::new();
        for (i, line) in [line].into_iter().chain(more).enumerate() {
            let at = folder.path().join(format!("{verb}_{i}"));
            good(&format!("{line} --figures {}", at.display()));
            drawn.extend(figures(&at));
        }
        // Names with a `_`, and the words that are a figure's whole name; `harmonics_*` stands for one of each
        // quantity.
        let (_, names) = text.split_once(": ").unwrap();
        let words = names.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '*'));
        let of = |name: &String| match name.starts_with("harmonics_") {
            true => "harmonics_*".to_owned(),
            false => name.clone(),
        };
        let drawn: BTreeSet<String> = drawn.iter().map(of).collect();
        let named: BTreeSet<String> =
            words.filter(|w| w.contains('_') || drawn.contains(*w)).map(str::to_owned).collect();
        assert_eq!(named, drawn, "{verb}: {text}");
        drawing.push(verb);
    }
    assert_eq!(drawing, ["static", "impulse", "sweep", "branches"]);
    let pair = scene("oh58_sun_planet_pair.toml");
    let (code, _, err) = ran(&format!("static {pair} --approach-um 20 --figures out"));
    assert!(code == 2 && err.contains("--figures") && err.contains("--approach-um"), "{err}");
}
