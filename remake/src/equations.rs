//! Prints `docs/equations.md` from the tags in doc comments: `cargo run --release -p remake -- equations`.
//!
//! A tag stands on the function or type that computes the equation; elsewhere it is quoted as `eq:tag`. Formulas may
//! be on several lines or in a block of code; without a check the last line says "no check of its own".
//!
//! ```text
//! /// `[eq:tag]` The equation.
//! /// Source: a publication with its equation number, "derived here", "definition" or "closed form".
//! /// Checked by: `folder/file.rs::test`, `id.of.a.check`.
//! ```

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use validation::Registry;

/// Crates, folders and files in the order of the page, each with its heading; of those that hold a file the longest
/// counts.
const SECTIONS: [(&str, &str); 18] = [
    ("gearset/", "Geometry and kinematics"),
    ("scene/", "Geometry and kinematics"),
    ("gearset/src/rules.rs", "Excitation"),
    ("lumped/", "Lumped model"),
    ("fe_contact/src/material.rs", "Elements and bodies"),
    ("fe_contact/src/element/", "Elements and bodies"),
    ("fe_contact/src/body/", "Elements and bodies"),
    ("fe_contact/", "Contact"),
    ("gearset/src/iso6336.rs", "Contact"),
    ("fe_contact/src/statics/", "Sets at rest"),
    ("validation/", "Sets at rest"),
    ("fe_contact/src/vibration/", "Motion in time"),
    ("dynamics/src/newmark.rs", "Motion in time"),
    ("dynamics/src/coupled/", "Motion in time"),
    ("dynamics/src/benchmark_subjects/", "Motion in time"),
    ("dynamics/src/stability/", "Motion in time"),
    ("dynamics/", "Modes and harmonics from results"),
    ("experiments/", "Modes and harmonics from results"),
];

/// What stands above the tables.
const HEAD: &str = "# Equations and where they stand

For each governing equation: its tag, its source, the function or type that computes it and the test or check that
verifies it. `grep -rn 'eq:TAG]' --include=*.rs .` finds the line of code. \"Definition\" and \"derived here\" mean that no
publication is cited. \"The paper\" is Parker, Agashe & Vijayakar (2000), J. Mech. Design 122, 304–310. Symbols are in
[glossary.md](glossary.md). Made from the tags in the code by
`cargo run --release -p remake -- equations > docs/equations.md`.
";

pub(crate) fn remake() -> crate::Outcome {
    print!("{}", page(&root(), &sources(&root())?)?);
    Ok(())
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Program files of the crates, by path from the root.
fn sources(root: &Path) -> std::io::Result<BTreeMap<String, String>> {
    let crates = SECTIONS.iter().filter_map(|(start, _)| start.split('/').next());
    let mut folders: Vec<PathBuf> = crates.map(|name| root.join(name).join("src")).collect();
    let mut found = BTreeMap::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name =
                path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            if path.is_dir() {
                folders.push(path);
            } else if name.ends_with(".rs") {
                found.insert(name, fs::read_to_string(&path)?);
            }
        }
    }
    Ok(found)
}

/// The page of the tags in some files, or what is wrong with the tags, a line each.
fn page(root: &Path, sources: &BTreeMap<String, String>) -> Result<String, String> {
    let registry = Registry::load().map_err(|e| e.to_string())?;
    let (mut tags, mut faults) = (BTreeMap::new(), Vec::new());
    let mut rows = vec![String::new(); SECTIONS.len()];
    for (path, text) in sources {
        let lines: Vec<&str> = text.lines().collect();
        let starts = (0..SECTIONS.len()).filter(|i| path.starts_with(SECTIONS[*i].0));
        let section = starts.max_by_key(|i| SECTIONS[*i].0.len()).unwrap_or(0);
        for at in (0..lines.len()).filter(|at| lines[*at].contains("[eq:")) {
            let place = format!("{path}:{}", at + 1);
            let Some([tag, says, source, checks, item]) = equation(&lines, at) else {
                faults.push(format!("{place}: no `[eq:tag]` … Source: … Checked by: … on an item"));
                continue;
            };
            let wrong = wrong_checks(root, &registry, &checks);
            faults.extend(wrong.iter().map(|name| format!("{place}: no test or check {name}")));
            let row = [format!("`eq:{tag}`"), says, source, format!("`{path}{item}`"), checks];
            let row = row.map(|cell| cell.replace('|', "\\|")).join(" | ");
            rows[section] += &format!("| {row} |\n");
            if let Some(other) = tags.insert(tag, place.clone()) {
                faults.push(format!("{place}: the tag stands at {other} too"));
            }
        }
    }
    for (path, text) in sources {
        let quoted = text.split("`eq:").skip(1).filter_map(|rest| rest.split('`').next());
        let dead = quoted.filter(|tag| !tags.contains_key(*tag));
        faults.extend(dead.map(|tag| format!("{path}: no eq:{tag}")));
    }
    let (mut page, mut before) = (HEAD.to_owned(), "");
    for ((_, heading), rows) in SECTIONS.iter().zip(rows) {
        if *heading != before {
            page +=
                &format!("\n## {heading}\n\n| tag | equation | source | where | checked by |\n");
            page += "|---|---|---|---|---|\n";
        }
        (page, before) = (page + &rows, heading);
    }
    if faults.is_empty() { Ok(page) } else { Err(faults.join("\n")) }
}

/// Tag, equation, source, checks and item of the comment with a tag in the line `at`.
fn equation(lines: &[&str], at: usize) -> Option<[String; 5]> {
    let doc = |line: &&str| {
        let line = line.trim_start();
        line.strip_prefix("///")
            .or_else(|| line.strip_prefix("//!"))
            .map(|words| words.trim().to_owned())
    };
    let mut words: Vec<String> = lines[at..].iter().map_while(doc).collect();
    let last = words.iter().position(|line| line.starts_with("Checked by:"))?;
    let end = words[last..].iter().position(String::is_empty).map_or(words.len(), |end| last + end);
    words.truncate(end);
    words.retain(|line| !line.starts_with("```"));
    let all = words.join(" ").split_whitespace().collect::<Vec<_>>().join(" ");
    let (tag, rest) = all.strip_prefix("`[eq:")?.split_once("]` ")?;
    let (says, rest) = rest.split_once(" Source: ")?;
    let (source, checks) = rest.split_once(" Checked by: ")?;
    let is_tag = tag.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    let item = item(lines, at).filter(|_| is_tag && !rest.contains("[eq:"))?;
    Some(
        [tag, says, source, checks, &item]
            .map(|part| part.trim_end_matches(['.', ',', ';']).to_owned()),
    )
}

/// `::Type::method`, `::function` or `::Type` that the comment at a line belongs to; nothing for that of a file.
fn item(lines: &[&str], at: usize) -> Option<String> {
    if lines[at].starts_with("//!") {
        return Some(String::new());
    }
    let name = |word: &str| {
        let end = word.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(word.len());
        format!("::{}", &word[..end])
    };
    let code = lines[at..].iter().filter(|line| !line.trim_start().starts_with(['/', '#']));
    let declared = code.take(9).find_map(|line| {
        let mut words = line.split_whitespace();
        words.find(|w| ["fn", "struct", "enum", "trait", "const", "type"].contains(w))?;
        words.next().map(name)
    })?;
    // The type of `impl<T> Trait for Type<T, U> {` is the last word that is no parameter.
    let head = lines[..at].iter().rev().find(|line| line.starts_with("impl"));
    let is_type =
        |w: &&str| w.starts_with(char::is_uppercase) && (w.contains('<') || !w.ends_with('>'));
    let head = head.filter(|_| lines[at].starts_with(' '));
    let owner = head.and_then(|line| line.split_whitespace().rev().find(is_type));
    Some(owner.map(name).unwrap_or_default() + &declared)
}

/// Tests and ids in backticks that do not exist; all of the text if it names none and does not say so.
fn wrong_checks<'c>(root: &Path, registry: &Registry, checks: &'c str) -> Vec<&'c str> {
    if !checks.contains('`') && !checks.starts_with("no check of its own") {
        return vec![checks];
    }
    let is_there = |named: &str| match named.split_once(".rs") {
        Some((file, test)) => {
            let text = fs::read_to_string(root.join(format!("{file}.rs"))).ok();
            let test = test.strip_prefix("::").map_or(String::new(), |name| format!("fn {name}("));
            text.is_some_and(|text| text.contains(&test))
        }
        None => {
            let mut entries = registry.suite.iter().flat_map(|suite| &suite.check);
            let stem = format!("{named}.");
            registry.check(named).is_ok() || entries.any(|check| check.ids.starts_with(&stem))
        }
    };
    checks.split('`').skip(1).step_by(2).filter(|named| !is_there(named)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_that_of_the_tags() {
        let page =
            page(&root(), &sources(&root()).unwrap()).unwrap_or_else(|faults| panic!("{faults}"));
        let kept = fs::read_to_string(root().join("docs/equations.md")).unwrap();
        assert!(
            page == kept,
            "docs/equations.md is stale: cargo run --release -p remake -- equations"
        );
    }

    /// Each kind of fault is found, and nothing in what is sound.
    #[test]
    fn faults_of_tags_are_found() {
        let read = |comment: &str, item: &str| {
            let lines: String = comment.lines().map(|l| format!("    /// {l}\n")).collect();
            let text = format!("impl<T> A for B<T> {{\n{lines}    {item}\n}}");
            page(&root(), &BTreeMap::from([("lumped/src/x.rs".to_owned(), text)]))
        };
        let sound = "`[eq:a-1]` x = y,\n```text\n|z|\n```\nSource: definition.\nChecked by: `fe.sets`, `remake/src/main.rs::main`.";
        let row = "| `eq:a-1` | x = y, \\|z\\| | definition | `lumped/src/x.rs::B::c` | `fe.sets`, `remake/src/main.rs::main` |";
        assert!(read(sound, "pub(crate) fn c(&self) {}").unwrap().contains(row));
        for (old, new, fault) in [
            ("Source:", "From:", "on an item"),
            ("Checked by:", "Seen by:", "on an item"),
            ("a-1", "A", "on an item"),
            ("fe.sets", "fe.sots", "check fe.sots"),
            ("::main", "::man", "check remake/src/main.rs::man"),
            ("main.rs", "man.rs", "check remake/src/man.rs::main"),
            ("`fe.sets`, `remake/src/main.rs::main`", "the eye", "check the eye"),
            ("x = y", "x = `eq:b`", "no eq:b"),
            ("main`.", "main`.\n\n`[eq:a-1]` z\nSource: x\nChecked by: no check of its own", "too"),
        ] {
            let faults = read(&sound.replace(old, new), "fn c() {}").unwrap_err();
            assert!(faults.contains(fault) && faults.lines().count() == 1, "{new}: {faults}");
        }
        assert!(read(sound, "let x = 1;").unwrap_err().contains("on an item"));
    }
}
