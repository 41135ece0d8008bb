//! `validate --recorded DIR --report DIR`: four files about the results of others.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::harness::{keeps_to_schema, run};

const STATUSES: [(&str, &str); 4] =
    [("passed", "pass"), ("missed", "miss"), ("failed", "fail"), ("of_another_kind", "other_kind")];

/// The results of a model that are kept as an example.
fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/results").join(name)
}

/// Files of a report by name.
fn read(folder: &Path) -> HashMap<String, String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries
        .map(|e| {
            let name = e.file_name().into_string().unwrap();
            (name, std::fs::read_to_string(e.path()).unwrap())
        })
        .collect()
}

/// Exit code, text, and the files of the report on a results folder.
fn report(results: &Path, more: &[&str]) -> (u8, String, HashMap<String, String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report");
    let arguments =
        ["validate", "--recorded", results.to_str().unwrap(), "--report", path.to_str().unwrap()];
    let (code, out, err) = run(&[&arguments, more].concat());
    assert_eq!(err, "");
    (code, out.replace(path.to_str().unwrap(), "REPORT"), read(&path))
}

/// Values of an attribute in all elements of a name.
fn attribute<'x>(text: &'x str, element: &str, name: &str) -> Vec<&'x str> {
    let (open, name) = (format!("<{element} "), format!(" {name}=\""));
    let elements = text.split(open.as_str()).skip(1).map(|rest| &rest[..rest.find('>').unwrap()]);
    let value = |tag: &'x str| {
        // The first attribute has no space left before it.
        let front = tag.find(&name).map(|at| at + name.len());
        let start = front.or_else(|| tag.strip_prefix(&name[1..]).map(|_| name.len() - 1))?;
        Some(&tag[start..][..tag[start..].find('"')?])
    };
    elements.filter_map(value).collect()
}

/// That every element is closed in order, every attribute is quoted, and every `&` begins an entity.
fn assert_well_formed(text: &str) {
    let mut open = Vec::new();
    for part in text.split('<').skip(1) {
        let (tag, content) = part.split_once('>').unwrap_or_else(|| panic!("no end: {part}"));
        assert!(!content.contains('>') || tag.starts_with('!'), "bare >: {part}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "{part}");
        } else if !tag.starts_with(['!', '?']) && !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap());
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        for entity in part.split('&').skip(1) {
            let name = entity.split_once(';').map(|(name, _)| name);
            let is_known = |n: &str| ["amp", "lt", "gt", "quot"].contains(&n) || n.starts_with('#');
            assert!(name.is_some_and(is_known), "{entity}");
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn four_files_agree_with_the_verdict_and_nothing_else_is_written() {
    let measured: &[&str] = &["--as", "measured"];
    for (name, more, code) in [("right", &[][..], 0), ("wrong", &[][..], 1), ("wrong", measured, 0)]
    {
        let (exit, out, files) = report(&example(name), more);
        assert_eq!(exit, code, "{out}");
        assert!(out.ends_with("report in REPORT\n"), "{out}");
        let mut names: Vec<&str> = files.keys().map(String::as_str).collect();
        names.sort_unstable();
        assert_eq!(names, ["junit.xml", "verdict.html", "verdict.json", "verdict.md"]);

        let verdict: Value = serde_json::from_str(&files["verdict.json"]).unwrap();
        keeps_to_schema("validate_recorded", &verdict);
        let checks = verdict["checks"].as_array().unwrap();
        let count = |status| checks.iter().filter(|c| c["status"] == status).count();
        // None is left out where there is none.
        let counted = |key| verdict[key].as_u64().unwrap_or(0) as usize;
        for (key, status) in STATUSES {
            assert_eq!(counted(key), count(status), "{name}, {key}");
        }
        let [passed, missed, failed, other] = STATUSES.map(|(key, _)| counted(key));
        let counts =
            format!("{passed} passed, {missed} missed, {failed} failed, {other} of another kind");
        assert!(out.contains(&counts) && files["verdict.md"].contains(&counts), "{out}");

        let not_asked = verdict["not_asked"].as_array().unwrap().len();
        let junit = &files["junit.xml"];
        assert_eq!(junit.matches("<testcase ").count(), checks.len() + not_asked);
        assert_eq!(junit.matches("<failure ").count(), failed);
        assert_eq!(junit.matches("<skipped ").count(), missed + other + not_asked);
        for (attribute_name, expected) in [
            ("tests", checks.len() + not_asked),
            ("failures", failed),
            ("skipped", missed + other + not_asked),
        ] {
            let numbers = |element| -> usize {
                attribute(junit, element, attribute_name)
                    .iter()
                    .map(|n| n.parse::<usize>().unwrap())
                    .sum()
            };
            assert_eq!(numbers("testsuites"), expected, "{attribute_name}");
            assert_eq!(numbers("testsuite"), expected, "{attribute_name}");
        }
        let mut suites = attribute(junit, "testsuite", "name");
        let all = suites.len();
        suites.sort_unstable();
        suites.dedup();
        assert_eq!(suites.len(), all, "one test suite a name");

        let html = &files["verdict.html"];
        for check in checks {
            let id = check["id"].as_str().unwrap();
            assert!(html.contains(&format!("<tr id=\"{id}\"")), "{id}");
            assert!(files["verdict.md"].contains(&format!("| `{id}` |")), "{id}");
            assert!(junit.contains(&format!("name=\"{id}: ")), "{id}");
        }
        assert!(html.len() < 200_000, "{} bytes", html.len());
        let is_nothing_judged = html.contains("Nothing was judged");
        assert_eq!(is_nothing_judged, more == measured, "{name} {more:?}");
    }
}

#[test]
fn the_page_needs_no_script_and_no_network() {
    let (_, _, files) = report(&example("wrong"), &[]);
    let html = &files["verdict.html"];
    for loads in
        ["<script", "<link", "<img", "<iframe", "src=", "url(", "@import", "http:", "https:"]
    {
        assert!(!html.contains(loads), "{loads}");
    }
    for words in ["prefers-color-scheme: dark", "@media print", "<svg ", "epicyclic 0."] {
        assert!(html.contains(words), "{words}");
    }
    let targets: Vec<&str> =
        html.split("href=\"").skip(1).map(|t| &t[..t.find('"').unwrap()]).collect();
    assert!(!targets.is_empty());
    for target in targets {
        let place = format!("id=\"{}\"", target.strip_prefix('#').unwrap());
        assert!(html.contains(&place), "{target}");
    }
}

/// Every number of a report that is judged is of the reference or of the tables: a model of this project would give
/// four digits more than the tables have.
#[test]
fn values_are_those_of_the_tables() {
    let (_, _, files) = report(&example("wrong"), &["--only", "lin_parker_1999"]);
    let table = std::fs::read_to_string(example("wrong").join("modes.csv")).unwrap();
    let frequencies: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    let verdict: Value = serde_json::from_str(&files["verdict.json"]).unwrap();
    let mut count = 0;
    for check in verdict["checks"].as_array().unwrap().iter().filter(|c| c["unit"] == "Hz") {
        let actual = check["actual"].as_f64().unwrap();
        assert!(frequencies.contains(&actual), "{check}");
        count += 1;
    }
    assert!(count > 10, "{count} frequencies");
    assert_eq!(verdict["about"]["only"][0], "lin_parker_1999");
    for name in ["verdict.md", "verdict.html"] {
        assert!(files[name].contains("Only checks whose ids start with"), "{name}");
    }
}

#[test]
fn a_program_may_be_called_anything() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(example("right").join("modes.csv"), folder.path().join("modes.csv")).unwrap();
    let manifest = "format = 1\nkind = \"lumped\"\nprogram = 'a<b> & \"c\" | `d` </title><script>'\nversion = \"\\u0007\"\n";
    std::fs::write(folder.path().join("results.toml"), manifest).unwrap();
    let (code, _, files) = report(folder.path(), &[]);
    assert_eq!(code, 0);
    assert_well_formed(&files["junit.xml"]);
    let name = "a&lt;b&gt; &amp; &quot;c&quot; | `d` &lt;/title&gt;&lt;script&gt;";
    assert!(files["junit.xml"].contains(&format!("name=\"program\" value=\"{name}\"")));
    assert!(files["verdict.html"].contains(&format!("<title>Verdict on {name} \u{fffd}</title>")));
    assert!(!files["verdict.html"].contains("<script"));
    let heading = files["verdict.md"].lines().next().unwrap();
    assert_eq!(
        heading,
        "# Verdict on a&lt;b&gt; &amp; \"c\" \\| \\`d\\` &lt;/title&gt;&lt;script&gt;  "
    );
    for name in ["right", "wrong"] {
        assert_well_formed(&report(&example(name), &[]).2["junit.xml"]);
    }
}

#[test]
fn files_are_named_with_their_hashes_and_an_accepted_miss_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let accepted = folder.path().join("accepted.toml");
    let (_, _, files) = report(&example("wrong"), &[]);
    let verdict: Value = serde_json::from_str(&files["verdict.json"]).unwrap();
    let is_published = |c: &&Value| c["status"] == "fail" && c["actual"].is_f64();
    let failed = verdict["checks"].as_array().unwrap().iter().find(is_published).unwrap();
    let entry = format!(
        "[[miss]]\nid = {}\nvalue = {}\ntolerance = 0.1\nanalysis = \"a <soft> ring\"\n",
        failed["id"], failed["actual"]
    );
    std::fs::write(&accepted, entry).unwrap();
    let (_, _, files) = report(&example("wrong"), &["--accept", accepted.to_str().unwrap()]);
    let judged: Value = serde_json::from_str(&files["verdict.json"]).unwrap();
    assert_eq!(judged["failed"].as_u64().unwrap() + 1, verdict["failed"].as_u64().unwrap());
    let accepted = format!("accepted by the author at {} ± 0.1", failed["actual"]);
    for name in ["verdict.md", "verdict.html", "junit.xml"] {
        for words in ["a &lt;soft&gt; ring", &accepted] {
            assert!(files[name].contains(words), "{words}: {name}");
        }
    }
    assert!(files["junit.xml"].contains("<skipped message=\"accepted miss: "));
    let read: Vec<&str> = judged["about"]["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|file| file["name"].as_str().unwrap())
        .collect();
    assert_eq!(read[..2], ["results.toml", "modes.csv"]);
    assert_eq!(read.last(), Some(&"accepted.toml"));
    assert!(read.contains(&"matrices/oh58_4p.K.csv"), "{read:?}");
    for file in judged["about"]["files"].as_array().unwrap() {
        let hash = file["sha256"].as_str().unwrap();
        assert_eq!(hash.len(), 64);
        for name in ["verdict.md", "verdict.html"] {
            assert!(files[name].contains(hash), "{name}");
        }
    }
}

#[test]
fn scenes_stand_in_the_report_with_their_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "scene,frequency_hz,mode_type,multiplicity\nlin_parker_1999_4p,727.27,,2\noh58_4p,770.611,translational,1\n";
    std::fs::write(folder.path().join("modes.csv"), rows).unwrap();
    std::fs::write(folder.path().join("rules.csv"), "scene,harmonic,excites\noh58_4p,1,none\n")
        .unwrap();
    let (_, _, files) = report(folder.path(), &[]);
    let verdict: Value = serde_json::from_str(&files["verdict.json"]).unwrap();
    let scenes = verdict["about"]["scenes"].as_array().unwrap();
    let ids: Vec<&Value> = scenes.iter().map(|scene| &scene["id"]).collect();
    assert_eq!(ids, ["lin_parker_1999_4p", "oh58_4p"]);
    assert_eq!(
        (&scenes[0]["types_given"], &scenes[1]["types_given"]),
        (&false.into(), &true.into())
    );
    let mass =
        scenes[0]["parameters"].as_array().unwrap().iter().find(|p| p["name"] == "mass").unwrap();
    assert_eq!(mass["values"], serde_json::json!([5.43, 2.35, 0.4, 0.66]));
    let html = &files["verdict.html"];
    for words in [
        "<td>mass, kg</td><td class=\"number\">5.43</td><td class=\"number\">2.35</td>",
        "<td>teeth</td><td class=\"number\">–</td><td class=\"number\">99</td><td class=\"number\">27</td>",
        "types are not given for every row, multiplicities given",
        "Held: rotation of the carrier, ring",
        scenes[0]["sha256"].as_str().unwrap(),
    ] {
        assert!(html.contains(words), "{words}: {html}");
    }
    for (only, words) in [
        ("rules,lumped_model.oh58_4p", "1 of 2 judged checks disagrees with a reference"),
        ("rules", "1 of 1 judged check disagrees with a reference"),
        ("lumped_model.oh58_4p", "The one judged check agrees with its reference"),
    ] {
        let markdown = &report(folder.path(), &["--only", only]).2["verdict.md"];
        assert!(markdown.contains(words), "{words}: {markdown}");
    }
}

#[test]
fn the_step_summary_of_a_ci_is_appended_to() {
    let folder = tempfile::tempdir().unwrap();
    let summary = folder.path().join("summary.md");
    std::fs::write(&summary, "# Earlier step\n").unwrap();
    let judged = |path: &Path, format: &str| {
        let results = example("right");
        let arguments = ["validate", "--recorded", results.to_str().unwrap(), "--format", format];
        let mut command = Command::new(env!("CARGO_BIN_EXE_epicyclic"));
        let output = command.args(arguments).env("GITHUB_STEP_SUMMARY", path).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
    };
    let (code, out) = judged(&summary, "text");
    assert_eq!(code, 0);
    assert_eq!(
        out.lines().last().unwrap(),
        format!("step summary appended to {}", summary.display())
    );
    let text = std::fs::read_to_string(&summary).unwrap();
    assert!(text.starts_with("# Earlier step\n# Verdict on lumped\\_model.py 1.0\n"), "{text}");
    let (_, json) = judged(&summary, "json");
    serde_json::from_str::<Value>(&json).unwrap();
    let text = std::fs::read_to_string(&summary).unwrap();
    assert_eq!(text.matches("# Verdict on ").count(), 2);
    // Where it cannot be written the verdict is shown all the same.
    let (code, out) = judged(folder.path(), "text");
    assert!(code == 2 && out.contains("0 failed"), "{out}");
    // Empty, as a CI step switches it off.
    assert_eq!(judged(Path::new(""), "text").0, 0);
}

/// `examples/results/make.sh` makes them anew.
#[test]
fn the_kept_examples_are_what_the_command_writes() {
    for name in ["right", "wrong"] {
        let (_, out, files) = report(&example(name), &[]);
        let path = example(name).display().to_string();
        let shown =
            |text: &str| text.replace(&path, name).replace("REPORT", &format!("{name}/report"));
        let kept = read(&example(name).join("report"));
        for (file, text) in files {
            assert_eq!(shown(&text), kept[&file], "{name}/{file}: examples/results/make.sh");
        }
        let kept = std::fs::read_to_string(example(name).join("verdict.txt")).unwrap();
        // The path of the folder may have broken lines elsewhere.
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&shown(&out)), words(&kept), "{name}");
        assert!(kept.lines().count() <= 60, "{name}: {} lines", kept.lines().count());
    }
}
