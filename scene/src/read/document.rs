//! Reads a TOML document key by key, collecting every fault instead of stopping at the first.
//!
//! `serde`'s derived readers stop at the first fault; a scene is judged whole, so the spanned
//! document of the `toml` crate is walked here and the plain scene types are filled from it.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

use strsim::levenshtein;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::keys::bound::Bound;
use crate::read::fault::{Fault, printable};
use crate::read::unread::{Unread, unfinished_above};

/// Magnitudes beyond these are slips of unit or exponent, and would overflow when squared.
const LARGEST: f64 = 1e30;
const SMALLEST: f64 = 1e-30;

/// The source text, where every key stands in it, and the faults found so far.
pub(crate) struct Document<'s> {
    text: &'s str,
    faults: RefCell<Vec<Fault>>,
    spans: RefCell<BTreeMap<String, Range<usize>>>,
    /// What errors of syntax leave unknown.
    unread: RefCell<Unread>,
    /// Every key that was asked for, with what it may hold.
    #[cfg(test)]
    pub(crate) asked: RefCell<BTreeMap<String, std::collections::BTreeSet<String>>>,
}

impl<'s> Document<'s> {
    pub(crate) fn new(text: &'s str) -> Self {
        Self {
            text,
            faults: RefCell::default(),
            spans: RefCell::default(),
            unread: RefCell::default(),
            #[cfg(test)]
            asked: RefCell::default(),
        }
    }

    /// Parses the text; errors of syntax become faults that name the key of their line. What such a line was
    /// to say stays unknown: nothing that follows from its absence is reported.
    pub(crate) fn parse(&self) -> DeTable<'s> {
        let (table, mut errors) = DeTable::parse_recoverable(self.text);
        errors.sort_by_key(|error| error.span().map_or(0, |span| span.start));
        for error in errors {
            let mut span = error.span().unwrap_or(0..0);
            if let Some(line) = unfinished_above(self.text, span.start) {
                span = line;
            }
            let (key, value) = self.key_of_line(span.start);
            // The parser reports what follows from an error as errors of their own.
            if self.unread.borrow().covers(span.start) {
                continue;
            }
            self.unread.borrow_mut().add(self.text, span.start, error.message());
            self.faults.borrow_mut().push(Fault {
                key,
                value,
                allowed: "TOML 1.0 syntax, each key once".into(),
                why: error.message().trim().replace('\n', "; "),
                span,
            });
        }
        table.into_inner()
    }

    /// Key and text of the line that holds byte `at`.
    fn key_of_line(&self, at: usize) -> (String, String) {
        let at = (0..=at.min(self.text.len())).rev().find(|&i| self.text.is_char_boundary(i));
        let at = at.unwrap_or(0);
        let start = self.text[..at].rfind('\n').map_or(0, |i| i + 1);
        let line = self.text[start..].lines().next().unwrap_or("").trim();
        let number = self.text[..start].matches('\n').count() + 1;
        let key = line.split(['=', '#']).next().unwrap_or("").trim();
        let key = key.trim_matches(['[', ']']).trim();
        if key.is_empty() {
            (format!("line {number}"), format!("`{line}`"))
        } else {
            (key.to_owned(), format!("`{line}` (line {number})"))
        }
    }

    /// Adds a fault about `key`: about its value if the file has it, else about the nearest table.
    pub(crate) fn fault(&self, key: &str, allowed: impl Into<String>, why: impl Into<String>) {
        let spans = self.spans.borrow();
        let unread = self.unread.borrow();
        let (span, value) = match spans.get(key) {
            Some(span) if unread.covers(span.start) || unread.is_line_of(key) => return,
            Some(span) => (span.clone(), self.text[span.clone()].trim().to_owned()),
            None if unread.may_hold(key) => return,
            None => (self.nearest_span(&spans, key), "absent".to_owned()),
        };
        let value = match value.char_indices().nth(60) {
            Some((cut, _)) => format!("{}…", value[..cut].replace('\n', " ")),
            None => value.replace('\n', " "),
        };
        let allowed = allowed.into();
        let why = why.into();
        let mut faults = self.faults.borrow_mut();
        if !faults.iter().any(|f| f.key == key && f.why == why) {
            faults.push(Fault { key: key.to_owned(), value, allowed, why, span });
        }
    }

    fn nearest_span(&self, spans: &BTreeMap<String, Range<usize>>, key: &str) -> Range<usize> {
        let mut path = key;
        while let Some((parent, _)) = path.rsplit_once('.') {
            if let Some(span) = spans.get(parent) {
                let end = self.text[span.start..].find('\n').map_or(span.end, |i| span.start + i);
                return span.start..end.min(span.end).max(span.start);
            }
            path = parent;
        }
        0..0
    }

    /// Whether the value of `key`, of any key below it or of a table it is in is at fault or unknown.
    pub(crate) fn is_doubtful(&self, key: &str) -> bool {
        let is_at_fault = |found: &str| is_within(found, key) || is_within(key, found);
        self.unread.borrow().may_hold(key)
            || self.faults.borrow().iter().any(|f| is_at_fault(&f.key))
    }

    /// Whether the file holds `key`, or may hold it on a line that cannot be read.
    pub(crate) fn may_hold(&self, key: &str) -> bool {
        self.has(key) || self.unread.borrow().may_hold(key)
    }

    /// Whether the file holds `key`.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.spans.borrow().contains_key(key)
    }

    /// All faults in the order of the file.
    pub(crate) fn into_faults(self) -> Vec<Fault> {
        let mut faults = self.faults.into_inner();
        faults.sort_by_key(|f| f.span.start);
        for fault in &mut faults {
            for text in [&mut fault.key, &mut fault.value, &mut fault.allowed, &mut fault.why] {
                *text = printable(text);
            }
        }
        faults
    }
}

/// Whether `key` is `table` or a key below it.
fn is_within(key: &str, table: &str) -> bool {
    key.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// What a string may be.
pub(crate) const TEXT: &str = "a string of one line in quotes, without control characters";
/// What a list of numbers may be.
pub(crate) const NUMBERS: &str = "a list of finite numbers";
/// What a list of whole numbers may be.
pub(crate) const INTEGERS: &str = "a list of whole numbers";
/// What a table is.
pub(crate) const TABLE: &str = "a table";
/// What an array of tables is.
pub(crate) const TABLES: &str = "an array of tables";

/// What a whole number between two limits may be.
pub(crate) fn whole_number(low: i64, high: i64) -> String {
    format!("a whole number from {low} to {high}")
}

/// One table of the document. Every key asked for counts as known; `finish` refuses the others.
pub(crate) struct Section<'d, 's> {
    document: &'d Document<'s>,
    path: String,
    entries: BTreeMap<String, (Range<usize>, &'d Spanned<DeValue<'s>>)>,
    known: RefCell<Vec<&'static str>>,
}

impl<'d, 's> Section<'d, 's> {
    pub(crate) fn new(document: &'d Document<'s>, path: &str, table: &'d DeTable<'s>) -> Self {
        let entries: BTreeMap<_, _> =
            table.iter().map(|(k, v)| (k.get_ref().to_string(), (k.span(), v))).collect();
        let section = Self { document, path: path.to_owned(), entries, known: RefCell::default() };
        for (key, (_, value)) in &section.entries {
            document.spans.borrow_mut().insert(section.full(key), value.span());
        }
        section
    }

    /// Whether the value of a key of this table, of any key below it or of this table is at fault or unknown.
    pub(crate) fn is_doubtful(&self, key: &str) -> bool {
        self.document.is_doubtful(&self.full(key))
    }

    /// Full dotted path of a key of this table.
    pub(crate) fn full(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// The value of a key; `words` say what it may be.
    fn get(&self, key: &'static str, words: &str) -> Option<&'d DeValue<'s>> {
        self.ask(key, words);
        self.entries.get(key).map(|(_, value)| value.get_ref())
    }

    /// Makes a key known without reading it.
    pub(crate) fn skip(&self, key: &'static str) {
        self.known.borrow_mut().push(key);
    }

    fn ask(&self, key: &'static str, words: &str) {
        self.known.borrow_mut().push(key);
        #[cfg(test)]
        {
            let full = self.full(key);
            let steps = full.split('.').filter(|step| step.parse::<usize>().is_err());
            let path = steps.collect::<Vec<_>>().join(".");
            self.document.asked.borrow_mut().entry(path).or_default().insert(words.to_owned());
        }
        #[cfg(not(test))]
        let _ = words;
    }

    /// Whether this table holds `key`, or may hold it on a line that cannot be read.
    pub(crate) fn may_hold(&self, key: &str) -> bool {
        self.has(key) || self.document.may_hold(&self.full(key))
    }

    /// Whether this table holds `key` (without making the key known).
    pub(crate) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Adds a fault about one key of this table.
    pub(crate) fn fault(&self, key: &str, allowed: impl Into<String>, why: impl Into<String>) {
        self.document.fault(&self.full(key), allowed, why);
    }

    /// A number, if the key is there and admissible; otherwise a fault has been noted.
    pub(crate) fn number(&self, key: &'static str, bound: Bound, why: &str) -> Option<f64> {
        let words = bound.words();
        let value = as_f64(self.get(key, &words)?);
        let Some(x) = value else {
            self.fault(key, words, why);
            return None;
        };
        if !bound.admits(x) {
            self.fault(key, bound.words(), why);
            return None;
        }
        if x.abs() > LARGEST || (x != 0.0 && x.abs() < SMALLEST) {
            let allowed = format!("a magnitude between {SMALLEST:e} and {LARGEST:e}");
            self.fault(key, allowed, format!("{why}; anything beyond is a slip of unit"));
            return None;
        }
        Some(x)
    }

    /// A number that must be there.
    pub(crate) fn required(&self, key: &'static str, bound: Bound, why: &str) -> Option<f64> {
        if !self.has(key) {
            self.ask(key, &bound.words());
            self.fault(key, bound.words(), why);
            return None;
        }
        self.number(key, bound, why)
    }

    /// A whole number between two limits (both allowed).
    pub(crate) fn integer(
        &self,
        key: &'static str,
        (low, high): (i64, i64),
        why: &str,
    ) -> Option<i64> {
        let words = whole_number(low, high);
        let value = as_i64(self.get(key, &words)?);
        let value = value.filter(|i| (low..=high).contains(i));
        if value.is_none() {
            self.fault(key, words, why);
        }
        value
    }

    /// A whole number that must be there, between two limits (both allowed).
    pub(crate) fn required_integer(
        &self,
        key: &'static str,
        (low, high): (i64, i64),
        why: &str,
    ) -> Option<i64> {
        if !self.has(key) {
            self.fault(key, whole_number(low, high), why);
        }
        self.integer(key, (low, high), why)
    }

    /// A string of one line without control characters.
    pub(crate) fn string(&self, key: &'static str) -> Option<String> {
        let value = self.get(key, TEXT)?.as_str().map(str::to_owned);
        let Some(value) = value else {
            self.fault(key, TEXT, "it is shown as it stands");
            return None;
        };
        if let Some(found) = value.chars().find(|c| c.is_control()) {
            let code = u32::from(found);
            let why =
                format!("it holds the control character U+{code:04X}, and is shown as it stands");
            self.fault(key, TEXT, why);
            return None;
        }
        Some(value)
    }

    /// One of a fixed list of words.
    pub(crate) fn choice<T: Copy>(
        &self,
        key: &'static str,
        choices: &[(&str, T)],
        why: &str,
    ) -> Option<T> {
        let words: Vec<_> = choices.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        let words = words.join(", ");
        let value = self.get(key, &words)?.as_str();
        let found = choices.iter().find(|(word, _)| Some(*word) == value).map(|c| c.1);
        if found.is_none() {
            self.fault(key, words, why);
        }
        found
    }

    /// A list of numbers.
    pub(crate) fn numbers(&self, key: &'static str, why: &str) -> Option<Vec<f64>> {
        let list = self.get(key, NUMBERS)?.as_array().and_then(|array| {
            array.iter().map(|v| as_f64(v.get_ref()).filter(|x| x.abs() < LARGEST)).collect()
        });
        if list.is_none() {
            self.fault(key, NUMBERS, why);
        }
        list
    }

    /// A list of whole numbers.
    pub(crate) fn integers(&self, key: &'static str, why: &str) -> Option<Vec<i64>> {
        let list = self.get(key, INTEGERS)?.as_array().and_then(|array| {
            let whole = |v: &Spanned<DeValue<'_>>| as_i64(v.get_ref());
            array.iter().map(|v| whole(v).filter(|i| i.abs() < 1_000_000)).collect()
        });
        if list.is_none() {
            self.fault(key, INTEGERS, why);
        }
        list
    }

    /// A table of its own, if it is there.
    pub(crate) fn section(&self, key: &'static str) -> Option<Section<'d, 's>> {
        match self.get(key, TABLE)? {
            DeValue::Table(table) => Some(Section::new(self.document, &self.full(key), table)),
            _ => {
                self.fault(key, format!("a table: [{}]", self.full(key)), "it holds several keys");
                None
            }
        }
    }

    /// The tables of an array of tables (`[[key]]`).
    pub(crate) fn sections(&self, key: &'static str) -> Vec<Section<'d, 's>> {
        let Some(value) = self.get(key, TABLES) else {
            return Vec::new();
        };
        let tables: Option<Vec<_>> = value.as_array().and_then(|array| {
            let one = |(i, v): (usize, &'d Spanned<DeValue<'s>>)| match v.get_ref() {
                DeValue::Table(t) => {
                    Some(Section::new(self.document, &format!("{}.{i}", self.full(key)), t))
                }
                _ => None,
            };
            array.iter().enumerate().map(one).collect()
        });
        tables.unwrap_or_else(|| {
            self.fault(key, format!("tables: [[{}]]", self.full(key)), "one table each");
            Vec::new()
        })
    }

    /// Whether the file holds a key, by its full path, or may hold it on a line that cannot be read.
    pub(crate) fn is_in_document(&self, full: &str) -> bool {
        self.document.may_hold(full)
    }

    /// Refuses every key of this table that was never asked for; nothing is read from it afterwards.
    pub(crate) fn finish(self) {
        self.check_keys();
    }

    /// Refuses every key of this table that was never asked for.
    pub(crate) fn check_keys(&self) {
        let known = self.known.borrow();
        for (key, (span, _)) in &self.entries {
            if known.iter().any(|k| k == key) || self.document.unread.borrow().covers(span.start) {
                continue;
            }
            let nearest = known.iter().min_by_key(|k| levenshtein(k, key));
            let hint = match nearest {
                Some(k) if levenshtein(k, key) <= 1 + key.len() / 3 => {
                    format!("unknown key; did you mean `{k}`?")
                }
                _ => "unknown key".to_owned(),
            };
            let mut allowed: Vec<_> = known.clone();
            allowed.sort_unstable();
            allowed.dedup();
            let shown = if key.is_empty() { "\"\"" } else { key.as_str() };
            self.document.faults.borrow_mut().push(Fault {
                key: self.full(shown),
                value: "not a key of a scene".into(),
                allowed: allowed.join(", "),
                why: hint,
                span: span.clone(),
            });
        }
    }
}

fn as_f64(value: &DeValue<'_>) -> Option<f64> {
    let x: f64 = match value {
        DeValue::Float(x) => x.as_str().replace('_', "").parse().ok()?,
        DeValue::Integer(_) => as_i64(value)? as f64,
        _ => return None,
    };
    x.is_finite().then_some(x)
}

fn as_i64(value: &DeValue<'_>) -> Option<i64> {
    let integer = value.as_integer()?;
    i64::from_str_radix(&integer.as_str().replace('_', ""), integer.radix()).ok()
}
