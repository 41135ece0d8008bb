//! Nothing that the pages point at may be missing: relative links, images and anchors of the Markdown pages,
//! paths that pages, program and data files quote, and ids of checks that pages quote. Comments fit on a screen.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// Folders whose files are quoted by their path from the root of the repository.
const DATA: [&str; 6] = ["docs", "kept", "reference", "checks", "scenes", "studies"];

/// Most characters of a line of comment.
const WIDEST: usize = 120;

/// Pages quote program files as well.
const PROGRAM: [&str; 16] = [
    "examples",
    "remake",
    "benches",
    "dynamics",
    "experiments",
    "fe_contact",
    "gearset",
    "lapack_route",
    "lumped",
    "scene",
    "schemas",
    "snapshots",
    "src",
    "tests",
    "validation",
    ".ci",
];

fn root() -> PathBuf {
    let root = std::env::var("CARGO_MANIFEST_DIR").expect("CARGO_MANIFEST_DIR is set");
    PathBuf::from(root)
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Files under `folder` whose name ends in `.extension`, in order.
fn files(folder: &Path, extension: &str, is_deep: bool) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() && is_deep {
            found.extend(files(&path, extension, true));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// README, CONTRIBUTING, CHANGELOG and the pages in `docs`.
fn pages(root: &Path) -> Vec<PathBuf> {
    let mut pages = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|n| root.join(n)).to_vec();
    pages.extend(files(&root.join("docs"), "md", false));
    pages
}

/// Lines of a page with their numbers from 1 that are not in code blocks, fenced or indented.
fn prose(text: &str) -> Vec<(usize, &str)> {
    let (mut is_fenced, mut is_indented, mut was_blank) = (false, false, true);
    let mut lines = Vec::new();
    for (number, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            is_fenced = !is_fenced;
            continue;
        }
        let is_blank = line.trim().is_empty();
        is_indented = line.starts_with("    ") && (was_blank || is_indented);
        was_blank = is_blank;
        if !is_fenced && !is_indented && !is_blank {
            lines.push((number + 1, line));
        }
    }
    lines
}

/// A line without its inline code, and that code.
fn split_code(line: &str) -> (String, Vec<&str>) {
    let (mut rest, mut code) = (String::new(), Vec::new());
    for (i, part) in line.split('`').enumerate() {
        match i % 2 {
            0 => rest.push_str(part),
            // Keeps the text on either side apart.
            _ => {
                rest.push('`');
                code.push(part);
            }
        }
    }
    (rest, code)
}

/// Targets of `[text](target)`, `[name]: target`, `src="target"` and `href="target"`.
fn targets(line: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (opening, closing) in [("](", ')'), ("src=\"", '"'), ("href=\"", '"')] {
        for part in line.split(opening).skip(1) {
            let target = part.split(closing).next().unwrap_or("");
            // A title may follow the target.
            found.extend(target.split_whitespace().next().map(String::from));
        }
    }
    let named = line.split_once("]: ").filter(|(name, _)| name.starts_with('['));
    found.extend(named.and_then(|(_, target)| target.split_whitespace().next()).map(String::from));
    found
}

/// Anchors of a page's headings as GitHub makes them.
fn anchors(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for (_, line) in prose(text) {
        let title = line.trim_start_matches('#');
        let depth = line.len() - title.len();
        if !(1..=6).contains(&depth) || !title.starts_with(' ') {
            continue;
        }
        let kept = title.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let plain: String = kept.collect::<String>().to_lowercase().replace(' ', "-");
        let is_same = |a: &&String| {
            let number = a.strip_prefix(&plain).and_then(|rest| rest.strip_prefix('-'));
            **a == plain || number.is_some_and(|n| n.parse::<usize>().is_ok())
        };
        match found.iter().filter(is_same).count() {
            0 => found.push(plain),
            n => found.push(format!("{plain}-{n}")),
        }
    }
    found
}

/// `a/b/../c` as `a/c`; `None` if the path leaves the folder it starts from.
fn straight(path: &Path) -> Option<PathBuf> {
    let mut straight = PathBuf::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => straight.push(name),
            Component::ParentDir if straight.pop() => {}
            Component::CurDir => {}
            _ => return None,
        }
    }
    Some(straight)
}

/// What is wrong with a link of `page` (path from the root).
fn fault_of_link(root: &Path, page: &Path, target: &str) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (path, anchor) = target.split_once('#').map_or((target, None), |(p, a)| (p, Some(a)));
    let file = match path {
        "" => page.to_path_buf(),
        _ => match straight(&page.parent().unwrap_or(Path::new("")).join(path)) {
            Some(file) => file,
            None => return Some(format!("{target}: not a path within the repository")),
        },
    };
    if !root.join(&file).exists() {
        return Some(format!("{target}: no such file"));
    }
    let anchor = anchor?;
    let is_there = anchors(&read(&root.join(&file))).iter().any(|a| a == anchor);
    (!is_there).then(|| format!("{target}: no such heading in {}", file.display()))
}

fn is_in_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || "_-".contains(c)
}

/// Paths in `text` that start with one of `folders`, each with its line; `{a,b}` is written out, other
/// braces, which stand for something that the program puts in, become `*`.
fn quoted(text: &str, folders: &[&str]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        for folder in folders {
            for (at, _) in line.match_indices(folder) {
                let before = line[..at].chars().next_back();
                let rest = &line[at + folder.len()..];
                if before.is_some_and(|c| is_in_name(c) || "./".contains(c))
                    || !rest.starts_with('/')
                {
                    continue;
                }
                let is_path = |c: char| is_in_name(c) || "./*{},".contains(c);
                let end = rest.find(|c| !is_path(c)).unwrap_or(rest.len());
                let path = format!("{folder}{}", rest[..end].trim_end_matches(['.', ',']));
                found.extend(written_out(&path).into_iter().map(|p| (number + 1, p)));
            }
        }
    }
    found
}

fn written_out(path: &str) -> Vec<String> {
    let braces = path.split_once('{').and_then(|(a, rest)| {
        let (inside, b) = rest.split_once('}')?;
        Some((a, inside, b))
    });
    match braces {
        None => vec![path.to_owned()],
        Some((a, inside, b)) if inside.contains(',') => {
            inside.split(',').flat_map(|x| written_out(&format!("{a}{x}{b}"))).collect()
        }
        Some((a, _, b)) => written_out(&format!("{a}*{b}")),
    }
}

/// Whether `name` is `pattern`, in which each `*` stands for any characters.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, tail)) => name.strip_prefix(head).is_some_and(|rest| {
            let ends = rest.char_indices().map(|(i, _)| i).chain([rest.len()]);
            ends.into_iter().any(|i| matches(tail, &rest[i..]))
        }),
    }
}

fn exists(root: &Path, path: &str) -> bool {
    let Some((folder, name)) = path.rsplit_once('/') else { return root.join(path).exists() };
    if !name.contains('*') {
        return root.join(path).exists();
    }
    let Ok(entries) = fs::read_dir(root.join(folder)) else { return false };
    let mut names = entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned());
    names.any(|n| matches(name, &n))
}

/// `path/to/file.rs::name` in backticks: the file defines or declares `name`.
fn fault_of_item(root: &Path, code: &str) -> Option<String> {
    let (file, item) = code.split_once(".rs::")?;
    let path = root.join(format!("{file}.rs"));
    if !path.exists() {
        return Some(format!("{code}: no such file"));
    }
    let text = read(&path);
    let name = item.rsplit("::").next().unwrap_or(item);
    let is_there = ["fn", "struct", "enum", "trait", "const", "mod"].iter().any(|word| {
        let found = format!("{word} {name}");
        let mut places = text.match_indices(&found);
        places.any(|(at, _)| !text[at + found.len()..].starts_with(is_in_name))
    });
    (!is_there).then(|| format!("{code}: nothing of that name in the file"))
}

/// Ids of the kept verdict.
fn ids(root: &Path) -> Vec<String> {
    let text = read(&root.join("snapshots/verdict.snap"));
    let values = text.lines().filter_map(|line| line.trim().strip_prefix("\"id\": \""));
    values.map(|rest| rest.trim_end_matches(['"', ',']).to_owned()).collect()
}

/// What is wrong with `code` if it looks like the id of a check, or the beginning of one: its first word is
/// that of some id, and it has a second one that does not make it a file.
fn fault_of_id(ids: &[String], code: &str) -> Option<String> {
    let (family, rest) = code.split_once('.')?;
    if ["md", "rs", "svg", "toml"].contains(&rest) {
        return None;
    }
    let is_of_family = |id: &String| id.split('.').next() == Some(family);
    let is_word = |c: char| c.is_ascii_alphanumeric() || "_.*".contains(c);
    if !ids.iter().any(is_of_family) || !code.chars().all(is_word) {
        return None;
    }
    // A prefix ends at a dot: `lumped_from_fe` fits `lumped_from_fe.table2.1`, `lumped_from` does not.
    let stem = code.trim_end_matches('.');
    let is_there = ids.iter().any(|id| matches(stem, id) || matches(&format!("{stem}.*"), id));
    (!is_there).then(|| format!("{code}: no check has this id or an id that starts so"))
}

/// All faults of one page, each with its line.
fn faults_of_page(root: &Path, page: &Path, text: &str, ids: &[String]) -> Vec<String> {
    let mut faults = Vec::new();
    for (line, words) in prose(text) {
        let (rest, code) = split_code(words);
        let links = targets(&rest).into_iter().filter_map(|t| fault_of_link(root, page, &t));
        let items = code.iter().filter_map(|c| fault_of_item(root, c));
        let checks = code.iter().filter_map(|c| fault_of_id(ids, c));
        let found = links.chain(items).chain(checks);
        faults.extend(found.map(|fault| format!("{}:{line}: {fault}", page.display())));
    }
    faults
}

/// Quoted paths that do not exist.
fn faults_of_quotes(root: &Path, file: &Path, text: &str, folders: &[&str]) -> Vec<String> {
    let dead = quoted(text, folders).into_iter().filter(|(_, path)| !exists(root, path));
    dead.map(|(line, path)| format!("{}:{line}: {path}: no such file", file.display())).collect()
}

fn from_root(root: &Path, path: &Path) -> PathBuf {
    path.strip_prefix(root).unwrap().to_path_buf()
}

#[test]
fn pages_point_at_what_is_there() {
    let root = root();
    let ids = ids(&root);
    assert!(ids.len() > 100, "snapshots/verdict.snap has only {} ids", ids.len());
    let mut faults = Vec::new();
    for path in pages(&root) {
        let (page, text) = (from_root(&root, &path), read(&path));
        faults.extend(faults_of_page(&root, &page, &text, &ids));
        // The changelog may name files that no longer exist.
        if page != Path::new("CHANGELOG.md") {
            let folders: Vec<&str> = DATA.iter().chain(&PROGRAM).copied().collect();
            faults.extend(faults_of_quotes(&root, &page, &text, &folders));
        }
    }
    assert!(faults.is_empty(), "{} dead:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn program_and_data_quote_files_that_are_there() {
    let root = root();
    let mut list = Vec::new();
    for folder in ["validation", "experiments", "src"] {
        list.extend(files(&root.join(folder), "rs", true));
    }
    for folder in ["checks", "kept"] {
        list.extend(files(&root.join(folder), "toml", false));
    }
    assert!(list.len() > 50, "only {} files were found", list.len());
    let faults: Vec<String> = list
        .iter()
        .flat_map(|path| faults_of_quotes(&root, &from_root(&root, path), &read(path), &DATA))
        .collect();
    assert!(faults.is_empty(), "{} dead:\n{}", faults.len(), faults.join("\n"));
}

/// Every kind of fault is found in a page made for it, and nothing else.
#[test]
fn dead_links_are_found() {
    let root = root();
    let known = ["lumped_from_fe.table2.1".to_owned(), "sweep.peaks.four".to_owned()];
    let faults = |text: &str| faults_of_page(&root, Path::new("docs/page.md"), text, &known).len();
    for sound in [
        "[physics](physics.md), [licence](../LICENSE-MIT), [host](https://example.org/none)",
        "[choices](physics.md#geometry) ![cost](cost.svg \"a title\")",
        "`[text](none.md)` and u = 2 k[1] (d)",
        "```text\n[text](none.md)\n```",
        "text\n\n    [text](none.md)\n",
        "`lumped_from_fe.`, `lumped_from_fe`, `sweep.*.four`, `fe contact`, `fe.rs`",
        "`tests/links.rs::dead_links_are_found`",
    ] {
        assert_eq!(faults(sound), 0, "{sound}");
    }
    for dead in [
        "[text](none.md)",
        "- item\n  [text](none.md)",
        "![picture](none.svg)",
        "[text](physics.md#none)",
        "[text](#none)",
        "[text](../../elsewhere.md)",
        "[text](/docs/physics.md)",
        "<img src=\"none.svg\">",
        "[name]: none.md",
        "`sweep.fe`",
        "`sweep.none.*`",
        "`tests/links.rs::dead_links_are`",
        "`tests/none.rs::dead_links_are_found`",
    ] {
        assert_eq!(faults(dead), 1, "{dead}");
    }
    let quotes = |text: &str| faults_of_quotes(&root, Path::new("x.rs"), text, &DATA).len();
    assert_eq!(quotes("see docs/physics.md, `scenes/oh58_{3p,4p}.toml`, scenes/{name}.toml."), 0);
    assert_eq!(quotes("kept/ and ../../docs/none.md and scenes/oh58_*.toml"), 0);
    assert_eq!(quotes("docs/none.md and `scenes/oh58_{3p,9p}.toml` and kept/no*.toml"), 3);
}

#[test]
fn headings_have_the_anchors_that_github_gives_them() {
    let page = "# A `b` c: d, e\n\n## Same\n\n## Same\n\n```\n# none\n```\n### β and F/δ\n";
    assert_eq!(anchors(page), ["a-b-c-d-e", "same", "same-1", "β-and-fδ"]);
}

/// Lines of comment that are too long and neither rows of a table nor in a block of code.
fn long_comments(text: &str) -> Vec<usize> {
    let mut is_fenced = false;
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            is_fenced = false;
            continue;
        };
        let words = comment.trim_start_matches(['/', '!']).trim_start();
        if words.starts_with("```") {
            is_fenced = !is_fenced;
        } else if !is_fenced && !words.starts_with('|') && line.chars().count() > WIDEST {
            found.push(number + 1);
        }
    }
    found
}

#[test]
fn comments_fit_on_a_screen() {
    let root = root();
    let mut faults = Vec::new();
    for folder in PROGRAM.iter().filter(|f| ![".ci", "schemas", "snapshots"].contains(*f)) {
        for path in files(&root.join(folder), "rs", true) {
            let name = from_root(&root, &path);
            // What crates outside the workspace build is not ours.
            if name.components().any(|part| part.as_os_str() == "target") {
                continue;
            }
            let long = long_comments(&read(&path)).into_iter();
            faults.extend(long.map(|line| format!("{}:{line}", name.display())));
        }
    }
    assert!(faults.is_empty(), "comments above {WIDEST} characters:\n{}", faults.join("\n"));
}

#[test]
fn long_comments_are_found() {
    let wide = "x".repeat(WIDEST);
    let text = format!(
        "// {wide}\nlet a = \"{wide}\";\n    /// {wide}\n/// | {wide} |\n//! ```\n//! {wide}\n//! ```\n"
    );
    assert_eq!(long_comments(&text), [1, 3]);
}
