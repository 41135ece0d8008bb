//! Reads a TOML document key by key, collecting every fault instead of stopping at the first.
//!
//! `serde`'s derived readers stop at the first fault; a scene is judged whole, so the spanned
//! document of the `toml` crate is walked here and the plain scene types are filled from it.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

use serde::de::DeserializeOwned;
use serde::de::IntoDeserializer;
use serde::de::value::Error;
use strsim::levenshtein;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::keys::{KEYS, KeyKind, Presence, SceneKey, is_within, without_indices};
use crate::read::digits::half_unit;
use crate::read::fault::{Fault, printable};
use crate::read::nearest::nearest;
use crate::read::remarks::{Chosen, Remarks};
use crate::read::scope::out_of_scope;
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
    /// Keys that unknown ones mean.
    meant: RefCell<Vec<String>>,
    /// What reading decides and notices beside faults.
    pub(crate) remarks: RefCell<Remarks>,
    /// Whether the numbers are exact, as those of a program are, whatever digits they are written with.
    pub(crate) is_exact: bool,
    /// Every key that was asked for.
    #[cfg(test)]
    pub(crate) asked: RefCell<std::collections::BTreeSet<String>>,
}

impl<'s> Document<'s> {
    pub(crate) fn new(text: &'s str) -> Self {
        Self {
            text,
            faults: RefCell::default(),
            spans: RefCell::default(),
            unread: RefCell::default(),
            meant: RefCell::default(),
            remarks: RefCell::default(),
            is_exact: false,
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
                why: match has_decimal_comma(line_at(self.text, span.start).1) {
                    true => "decimals are written with a point: 10.5".into(),
                    false => error.message().trim().replace('\n', "; "),
                },
                span,
            });
        }
        table.into_inner()
    }

    /// Key and text of the line that holds byte `at`.
    fn key_of_line(&self, at: usize) -> (String, String) {
        let (start, line) = line_at(self.text, at);
        let line = line.trim();
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

    /// Full dotted paths of the keys and tables of the file.
    pub(crate) fn keys(&self) -> Vec<String> {
        self.spans.borrow().keys().cloned().collect()
    }

    /// The value of a key as the file holds it; empty where it does not.
    pub(crate) fn written(&self, key: &str) -> String {
        self.spans
            .borrow()
            .get(key)
            .map_or(String::new(), |span| self.text[span.clone()].to_owned())
    }

    /// All faults in the order of the file, and the remarks.
    pub(crate) fn into_findings(self) -> (Vec<Fault>, Remarks) {
        let mut faults = self.faults.into_inner();
        // A key that stands under another name is one fault, not also an absent one.
        let meant = self.meant.into_inner();
        let is_meant = |f: &Fault| meant.iter().any(|meant| is_within(&f.key, meant));
        faults.retain(|f| f.value != "absent" || !is_meant(f));
        faults.sort_by_key(|f| f.span.start);
        for fault in &mut faults {
            for text in [&mut fault.key, &mut fault.value, &mut fault.allowed, &mut fault.why] {
                *text = printable(text);
            }
        }
        (faults, self.remarks.into_inner())
    }
}

/// One table of the document, read by the list of keys. Every key asked for counts as known; when the table is
/// dropped, the others are refused. A value that is absent or at fault is the default of the list, or NaN where there
/// is none: a scene with faults is never given away.
pub(crate) struct Section<'d, 's> {
    pub(crate) document: &'d Document<'s>,
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

    /// Full dotted path of a key of this table.
    fn full(&self, key: &str) -> String {
        full_path(&self.path, key)
    }

    /// Whether this table holds `key` (without making the key known).
    pub(crate) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Whether this table holds a table `key`.
    pub(crate) fn has_table(&self, key: &str) -> bool {
        self.entries.get(key).is_some_and(|(_, value)| value.get_ref().is_table())
    }

    /// Whether this table holds `key`, or may hold it on a line that cannot be read.
    pub(crate) fn may_hold(&self, key: &str) -> bool {
        self.document.may_hold(&self.full(key))
    }

    /// Whether the value of a key of this table, of any key below it or of this table is at fault or unknown.
    pub(crate) fn is_doubtful(&self, key: &str) -> bool {
        self.document.is_doubtful(&self.full(key))
    }

    /// Adds a fault about one key of this table.
    pub(crate) fn fault(&self, key: &str, allowed: impl Into<String>, why: impl Into<String>) {
        self.document.fault(&self.full(key), allowed, why);
    }

    /// Makes a key known without reading it.
    pub(crate) fn skip(&self, key: &'static str) {
        self.known.borrow_mut().push(key);
    }

    /// Refuses a key if it is there.
    pub(crate) fn refuse(&self, key: &'static str, why: &str) {
        self.refuse_as(key, "nothing here", why);
    }

    /// Refuses a key if it is there, and says what is allowed.
    pub(crate) fn refuse_as(&self, key: &'static str, allowed: &str, why: &str) {
        self.skip(key);
        if self.has(key) {
            self.fault(key, allowed, why);
        }
    }

    /// The declaration of a key, which is known from here on.
    fn declared(&self, key: &'static str) -> Option<&'static SceneKey> {
        self.known.borrow_mut().push(key);
        let path = without_indices(&self.full(key));
        let declared = KEYS.iter().find(|declared| declared.path == path);
        debug_assert!(declared.is_some(), "{path} is not in the list of keys");
        #[cfg(test)]
        self.document.asked.borrow_mut().insert(path);
        declared
    }

    /// Reports a key that must be there and is not.
    pub(crate) fn demand(&self, key: &'static str) {
        let why = self.declared(key).map_or("", SceneKey::reason);
        self.demand_because(key, why);
    }

    /// Reports a key that must be there for a reason and is not.
    pub(crate) fn demand_because(&self, key: &'static str, why: &str) {
        if let Some(declared) = self.declared(key).filter(|_| !self.has(key)) {
            self.fault(key, declared.kind.words(), why);
        }
    }

    /// The value of a key as `read` understands it; a fault if it is there and not understood, or must be there.
    fn value<T>(
        &self,
        key: &'static str,
        read: impl Fn(KeyKind, &'d DeValue<'s>) -> Option<T>,
    ) -> Option<T> {
        let declared = self.declared(key)?;
        if declared.presence == Presence::Required {
            self.demand(key);
        }
        let (_, value) = self.entries.get(key)?;
        let found = read(declared.kind, value.get_ref());
        if found.is_none() {
            self.fault(key, declared.kind.words(), declared.reason());
        }
        found
    }

    /// A number in SI units, if the key is there and admissible.
    pub(crate) fn optional(&self, key: &'static str) -> Option<f64> {
        Some(self.declared(key)?.to_si(self.in_its_unit(key)?))
    }

    /// A number in the unit of the key, if it is there and admissible.
    pub(crate) fn in_its_unit(&self, key: &'static str) -> Option<f64> {
        let x = self.value(key, |kind, value| {
            as_f64(value).filter(|x| matches!(kind, KeyKind::Number(bound) if bound.admits(*x)))
        })?;
        let declared = self.declared(key)?;
        if x.abs() > LARGEST || (x != 0.0 && x.abs() < SMALLEST) {
            let allowed = format!("a magnitude between {SMALLEST:e} and {LARGEST:e}");
            let why = format!("{}; anything beyond is a slip of unit", declared.reason());
            self.fault(key, allowed, why);
            return None;
        }
        Some(x)
    }

    /// Half a unit of the last digit with which a number is written, in SI units; 0 where it is exact or absent.
    pub(crate) fn half_unit(&self, key: &'static str) -> f64 {
        let path = self.full(key);
        let spans = self.document.spans.borrow();
        let Some(span) = spans.get(&path).filter(|_| !self.document.is_exact) else { return 0.0 };
        let half = half_unit(&self.document.text[span.clone()]);
        self.declared(key).map_or(0.0, |declared| declared.to_si(half))
    }

    /// The same of each number of a list, in the unit of the key.
    pub(crate) fn half_units(&self, key: &'static str) -> Vec<f64> {
        let half = |number: &Spanned<DeValue<'_>>| match self.document.is_exact {
            true => 0.0,
            false => half_unit(&self.document.text[number.span()]),
        };
        let list = self.entries.get(key).and_then(|(_, value)| value.get_ref().as_array());
        list.into_iter().flatten().map(half).collect()
    }

    /// Notes what is chosen for a key that is left out: its value in the unit of the key, and why.
    pub(crate) fn choose(&self, key: &str, value: String, why: &str) {
        let chosen = Chosen { key: self.full(key), value, why: why.to_owned() };
        self.document.remarks.borrow_mut().chosen.push(chosen);
    }

    /// A number in SI units, or its default.
    pub(crate) fn number(&self, key: &'static str) -> f64 {
        self.optional(key).or_else(|| self.declared(key)?.default_si()).unwrap_or(f64::NAN)
    }

    /// A whole number, or its default.
    pub(crate) fn integer<T: TryFrom<i64>>(&self, key: &'static str) -> Option<T> {
        let given = self.value(key, |kind, value| {
            let KeyKind::Integer(low, high) = kind else { return None };
            as_i64(value).filter(|i| (low..=high).contains(i))
        });
        given.or_else(|| self.declared(key)?.default()?.parse().ok())?.try_into().ok()
    }

    /// A string of one line without control characters, or its default.
    pub(crate) fn string(&self, key: &'static str) -> Option<String> {
        let declared = self.declared(key)?;
        let default = declared.default().map(str::to_owned);
        let Some((_, value)) = self.entries.get(key) else { return default };
        let text = value.get_ref().as_str();
        let why = match text.map(|text| text.chars().find(|c| c.is_control())) {
            Some(None) => return text.map(str::to_owned),
            Some(Some(found)) => {
                let code = u32::from(found);
                format!("it holds the control character U+{code:04X}, and is shown as it stands")
            }
            None => "it is shown as it stands".to_owned(),
        };
        self.fault(key, declared.kind.words(), why);
        default
    }

    /// One of the words of the list, or the default.
    pub(crate) fn word(&self, key: &'static str) -> Option<&'static str> {
        let given = self.value(key, |kind, value| {
            let KeyKind::Choice(words) = kind else { return None };
            words.iter().find(|word| Some(**word) == value.as_str()).copied()
        });
        given.or_else(|| self.declared(key)?.default())
    }

    /// What the word given, or the default, names.
    pub(crate) fn choice<T: DeserializeOwned>(&self, key: &'static str) -> Option<T> {
        let word = self.word(key)?;
        T::deserialize(IntoDeserializer::<Error>::into_deserializer(word)).ok()
    }

    /// A list of numbers.
    pub(crate) fn numbers(&self, key: &'static str) -> Option<Vec<f64>> {
        let one = |v: &Spanned<DeValue<'_>>| as_f64(v.get_ref()).filter(|x| x.abs() < LARGEST);
        self.value(key, |_, value| value.as_array()?.iter().map(one).collect())
    }

    /// A list of whole numbers.
    pub(crate) fn integers(&self, key: &'static str) -> Option<Vec<i64>> {
        let one = |v: &Spanned<DeValue<'_>>| as_i64(v.get_ref()).filter(|i| i.abs() < 1_000_000);
        self.value(key, |_, value| value.as_array()?.iter().map(one).collect())
    }

    /// A table of its own, if it is there.
    pub(crate) fn section(&self, key: &'static str) -> Option<Self> {
        self.declared(key)?;
        let (_, value) = self.entries.get(key)?;
        match value.get_ref() {
            DeValue::Table(table) => Some(Section::new(self.document, &self.full(key), table)),
            _ => {
                self.fault(key, format!("a table: [{}]", self.full(key)), "it holds several keys");
                None
            }
        }
    }

    /// A table of its own; without a key if it is not there.
    pub(crate) fn table(&self, key: &'static str) -> Self {
        self.section(key).unwrap_or_else(|| Self {
            document: self.document,
            path: self.full(key),
            entries: BTreeMap::new(),
            known: RefCell::default(),
        })
    }

    /// The tables of an array of tables (`[[key]]`).
    pub(crate) fn sections(&self, key: &'static str) -> Vec<Self> {
        self.declared(key);
        let Some((_, value)) = self.entries.get(key) else { return Vec::new() };
        let one = |(i, v): (usize, &'d Spanned<DeValue<'s>>)| match v.get_ref() {
            DeValue::Table(t) => {
                Some(Section::new(self.document, &format!("{}.{i}", self.full(key)), t))
            }
            _ => None,
        };
        let array = value.get_ref().as_array();
        let tables = array.and_then(|array| array.iter().enumerate().map(one).collect());
        tables.unwrap_or_else(|| {
            self.fault(key, format!("tables: [[{}]]", self.full(key)), "one table each");
            Vec::new()
        })
    }
}

impl Drop for Section<'_, '_> {
    /// Refuses every key that was never asked for.
    fn drop(&mut self) {
        let known = self.known.get_mut();
        let mut allowed = known.clone();
        allowed.sort_unstable();
        allowed.dedup();
        for (key, (span, _)) in &self.entries {
            if known.iter().any(|k| k == key) || self.document.unread.borrow().covers(span.start) {
                continue;
            }
            let numbers = self
                .entries
                .iter()
                .filter_map(|(key, (_, value))| Some((key.as_str(), as_f64(value.get_ref())?)));
            let hint = nearest(key, known);
            if let Some((meant, _)) = hint {
                self.document.meant.borrow_mut().push(full_path(&self.path, meant));
            }
            // A letter off a long key is a slip, whatever else the word may mean.
            let is_slip = hint.is_some_and(|(k, _)| levenshtein(k, key) <= key.len() / 6)
                || self.path == "damping" && key == "beta";
            if let Some((why, instead)) = out_of_scope(key, &numbers.collect()).filter(|_| !is_slip)
            {
                self.document.faults.borrow_mut().push(Fault {
                    key: full_path(&self.path, key),
                    value: "out of scope".into(),
                    allowed: instead,
                    why: why.into(),
                    span: span.clone(),
                });
                continue;
            }
            let hint = hint.map_or_else(
                || "unknown key".to_owned(),
                |(k, difference)| format!("unknown key; did you mean `{k}`{difference}?"),
            );
            let shown = if key.is_empty() { "\"\"" } else { key.as_str() };
            self.document.faults.borrow_mut().push(Fault {
                key: full_path(&self.path, shown),
                value: "not a key of a scene".into(),
                allowed: allowed.join(", "),
                why: hint,
                span: span.clone(),
            });
        }
    }
}

/// Where the line that holds byte `at` begins, and its text.
fn line_at(text: &str, at: usize) -> (usize, &str) {
    let at = (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
    let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    (start, text[start..].lines().next().unwrap_or(""))
}

/// Whether a line gives a key a number with a decimal comma, and nothing else.
fn has_decimal_comma(line: &str) -> bool {
    let value = line.split('#').next().and_then(|code| code.split_once('=')).map(|(_, v)| v.trim());
    value.and_then(|value| value.split_once(',')).is_some_and(|(whole, decimals)| {
        let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        is_number(whole.trim_start_matches('-')) && is_number(decimals)
    })
}

fn full_path(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
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
