//! What errors of syntax leave unknown of a scene file: keys whose line cannot be read, and text behind an
//! error that may belong to another key or table than the parser takes it for.

use std::ops::Range;

use crate::keys::without_indices;

/// Keys and stretches of text of which nothing is known.
#[derive(Debug, Default)]
pub(crate) struct Unread {
    /// Full dotted paths of keys and tables; the empty path is the whole file.
    paths: Vec<String>,
    /// Byte ranges.
    ranges: Vec<Range<usize>>,
}

impl Unread {
    /// Notes an error of syntax at byte `at`, with the parser's message.
    pub(crate) fn add(&mut self, text: &str, at: usize, message: &str) {
        if message.contains("duplicate") {
            return; // The first of the two is read.
        }
        let start = text[..floor(text, at)].rfind('\n').map_or(0, |i| i + 1);
        let line = text[start..].lines().next().unwrap_or("");
        let code = line.split('#').next().unwrap_or("").trim();
        let table = table_of(text, start);
        let next_table = next_table(text, start + line.len());
        if code.starts_with('[') {
            // Keys below a broken header fall to the table above it.
            self.paths.push(code.trim_matches(['[', ']', ' ']).to_owned());
            self.ranges.push(start..next_table);
            return;
        }
        if !is_balanced(code) || !code.contains('=') {
            // What follows may be part of an unfinished string, list or table; after a key without a value the
            // parser reads nothing more.
            self.paths.push(String::new());
            self.ranges.push(start..text.len());
            return;
        }
        self.ranges.push(start..start + line.len());
        let key = code.split('=').next().unwrap_or("");
        self.paths.push(joined(&table, key));
    }

    /// Whether byte `at` lies in text of which nothing is known.
    pub(crate) fn covers(&self, at: usize) -> bool {
        self.ranges.iter().any(|range| range.contains(&at))
    }

    /// Whether the line of `key` itself cannot be read; the parser may put something in its place.
    pub(crate) fn is_line_of(&self, key: &str) -> bool {
        self.paths.iter().any(|path| path == key)
    }

    /// Whether an unreadable line may have given `key`, a key below it or the table it is in.
    pub(crate) fn may_hold(&self, key: &str) -> bool {
        let is_above = |a: &str, b: &str| {
            a.is_empty() || b.strip_prefix(a).is_some_and(|r| r.is_empty() || r.starts_with('.'))
        };
        let key = without_indices(key);
        self.paths.iter().any(|path| is_above(path, &key) || is_above(&key, path))
    }
}

/// The line, as a byte range, whose list or table is unfinished when the line of byte `at` begins; only the nearest
/// line with code is looked at.
pub(crate) fn unfinished_above(text: &str, at: usize) -> Option<Range<usize>> {
    let mut end = text[..floor(text, at)].rfind('\n')?;
    loop {
        let start = text[..end].rfind('\n').map_or(0, |i| i + 1);
        let line = &text[start..end];
        let code = line.split('#').next().unwrap_or("").trim();
        if !code.is_empty() {
            return (code.contains('=') && !is_balanced(code)).then_some(start..end);
        }
        end = start.checked_sub(1)?;
    }
}

/// The last place at or before byte `at` where a character begins.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

/// Path of the table in which the line that starts at byte `start` stands.
fn table_of(text: &str, start: usize) -> String {
    let mut headers = text[..start].lines().map(str::trim).filter(|line| line.starts_with('['));
    headers.next_back().map_or(String::new(), |header| {
        let header = header.split('#').next().unwrap_or("").trim();
        header.trim_matches(['[', ']', ' ']).to_owned()
    })
}

/// Where the next table starts after byte `from`, or the end of the text.
fn next_table(text: &str, from: usize) -> usize {
    let from = floor(text, from);
    text[from..].find("\n[").map_or(text.len(), |i| from + i + 1)
}

fn joined(table: &str, key: &str) -> String {
    let key = key.trim().trim_matches(['"', '\'']);
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}

/// Whether every bracket and quote of a line is closed on it.
fn is_balanced(code: &str) -> bool {
    let count = |c: char| code.matches(c).count();
    let is_even = |c: char| count(c) % 2 == 0;
    count('[') == count(']') && count('{') == count('}') && is_even('"') && is_even('\'')
}
