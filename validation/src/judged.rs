//! A declared check before its values are compared.

use crate::check::{Check, Subject, Tolerance, Value};
use crate::registry::CheckEntry;

/// A check with its declaration, source and note.
#[derive(Debug, Clone)]
pub struct Judged<'a> {
    entry: &'a CheckEntry,
    /// Range of (printed − ours)/ours that open parameters explain, percent.
    band_percent: Option<[f64; 2]>,
    id: &'a str,
    title: &'a str,
    source: String,
    note: Option<String>,
}

impl<'a> Judged<'a> {
    /// With the source that the registry gives, if any.
    pub(crate) fn new(
        entry: &'a CheckEntry,
        band_percent: Option<[f64; 2]>,
        id: &'a str,
        title: &'a str,
    ) -> Self {
        let source = entry.source.clone().unwrap_or_default();
        Self { entry, band_percent, id, title, source, note: None }
    }

    /// Where the expected value comes from.
    pub fn source(self, source: impl Into<String>) -> Self {
        Self { source: source.into(), ..self }
    }

    /// A remark for people; nothing is judged by it.
    pub fn note(self, note: impl Into<String>) -> Self {
        Self { note: Some(note.into()), ..self }
    }

    fn subject(&self) -> Subject<'_> {
        let CheckEntry { kind, unit, .. } = self.entry;
        Subject { id: self.id, title: self.title, kind: *kind, source: &self.source, unit }
    }

    fn noted(&self, check: Check) -> Check {
        Check { note: self.note.clone(), ..check }
    }

    /// A number against a number, within the declared tolerance. Where a band of open parameters widens it,
    /// the printed value p and ours f agree if, with h the tolerance without the band,
    ///
    /// ```text
    /// f (1 + lower/100) − h ≤ p ≤ f (1 + upper/100) + h
    /// ```
    pub fn number(self, expected: f64, actual: f64) -> Check {
        let mut tolerance = self.entry.tolerance(expected);
        // Of a value that is not there no band follows.
        if let Some([lower, upper]) = self.band_percent.filter(|_| actual.is_finite()) {
            let half = tolerance.absolute;
            let range = [-0.01 * upper * actual - half, half - 0.01 * lower * actual];
            tolerance.absolute = range[0].abs().max(range[1].abs());
            tolerance.band = Some(range);
        }
        self.noted(Check::number(self.subject(), expected, actual, tolerance))
    }

    /// The same, or not run where the profile left the number out.
    pub fn number_if_run(self, expected: f64, actual: Option<f64>) -> Check {
        match actual {
            Some(actual) => self.number(expected, actual),
            None => {
                let tolerance = self.entry.tolerance(expected);
                self.noted(Check::not_run(self.subject(), expected, tolerance))
            }
        }
    }

    /// A number that must not exceed the tolerance.
    pub fn at_most(self, actual: f64) -> Check {
        self.number(0.0, actual)
    }

    /// A number that must not exceed a limit other than the declared one.
    pub(crate) fn at_most_within(self, actual: f64, limit: f64, reason: &str) -> Check {
        let tolerance = Tolerance { absolute: limit, band: None, reason: reason.to_owned() };
        self.noted(Check::number(self.subject(), 0.0, actual, tolerance))
    }

    /// The same, or not run.
    pub fn at_most_if_run(self, actual: Option<f64>) -> Check {
        self.number_if_run(0.0, actual)
    }

    /// Words, lists or counts, which must be equal.
    pub fn equal(self, expected: impl Into<Value>, actual: impl Into<Value>) -> Check {
        self.noted(Check::equal(self.subject(), expected, actual))
    }

    /// The same, or not run.
    pub fn equal_if_run<V: Into<Value>>(self, expected: V, actual: Option<V>) -> Check {
        match actual {
            Some(actual) => self.equal(expected, actual),
            None => {
                let tolerance = self.entry.tolerance(0.0);
                self.noted(Check::not_run(self.subject(), expected, tolerance))
            }
        }
    }
}
