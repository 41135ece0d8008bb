//! What the author of results accepts: rows known to miss, thresholds.

use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::error::ManifestError;
use super::file::line_of;
use crate::check::{Check, ReferenceKind, Status, Tolerance, Value};
use crate::glob::matches;
use crate::reference::Miss;

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

/// Largest tolerance of the author's, percent of the accepted value or of the reference: with more, results of another
/// set would be accepted too.
const MOST_PERCENT: f64 = 20.0;

/// What the author of results accepts.
#[derive(Debug, Clone, Default)]
pub struct Accepted {
    /// Rows that the results are known to miss, each pinned and analysed.
    pub misses: Vec<Miss>,
    /// Tolerances instead of those of the registry.
    pub thresholds: Vec<Threshold>,
}

/// A tolerance of the author's for some rows.
#[derive(Debug, Clone)]
pub struct Threshold {
    /// Id of a check, or a pattern in which `*` stands for any characters.
    pub ids: String,
    /// Largest |yours − reference|, percent of the reference.
    pub percent: f64,
    /// Why so much.
    pub reason: String,
}

/// The file, with the places of what may be refused.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default, rename = "miss")]
    misses: Vec<MissEntry>,
    #[serde(default, rename = "threshold")]
    thresholds: Vec<ThresholdEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MissEntry {
    id: String,
    value: f64,
    tolerance: Spanned<f64>,
    analysis: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ThresholdEntry {
    ids: String,
    percent: Spanned<f64>,
    reason: Spanned<String>,
}

impl From<File> for Accepted {
    fn from(file: File) -> Self {
        let miss = |entry: MissEntry| Miss {
            id: entry.id,
            value: entry.value,
            tolerance: entry.tolerance.into_inner(),
            analysis: entry.analysis.into_inner(),
        };
        let threshold = |entry: ThresholdEntry| Threshold {
            ids: entry.ids,
            percent: entry.percent.into_inner(),
            reason: entry.reason.into_inner(),
        };
        Self {
            misses: file.misses.into_iter().map(miss).collect(),
            thresholds: file.thresholds.into_iter().map(threshold).collect(),
        }
    }
}

impl Accepted {
    /// Reads a TOML file: `[[miss]]` entries with `id` of the check, `value` that the model gives, `tolerance` of it
    /// and `analysis`, why the model is right all the same; `[[threshold]]` entries with `ids`, `percent`, `reason`.
    /// No tolerance may be above 20 % of the value, no threshold above 20 % of the reference.
    ///
    /// # Errors
    /// [`ManifestError`] with file and line of the first fault.
    pub fn read(path: &Path) -> Result<Self, ManifestError> {
        let text = scene::read_text(path, MOST_BYTES)
            .map_err(|source| ManifestError::Unreadable { path: path.to_owned(), source })?;
        let file: File = toml::from_str(&text).map_err(|error| ManifestError::Syntax {
            path: path.to_owned(),
            line: line_of(&text, error.span().map_or(0, |span| span.start)),
            reason: format!(
                "{}: allowed is [[miss]] with id, value, tolerance and analysis, and [[threshold]] with ids, percent \
                 and reason",
                error.message().replace('\n', "; ")
            ),
        })?;
        let fault = |at: usize, key: &str, fault: String| ManifestError::Key {
            path: path.to_owned(),
            line: line_of(&text, at),
            key: key.to_owned(),
            fault,
        };
        let is_empty = |reason: &Spanned<String>| reason.get_ref().trim().is_empty();
        for miss in &file.misses {
            let (start, most) =
                (miss.tolerance.span().start, 0.01 * MOST_PERCENT * miss.value.abs());
            if is_empty(&miss.analysis) {
                let allowed =
                    "is empty: allowed is a sentence on why the model is right all the same";
                return Err(fault(miss.analysis.span().start, "miss.analysis", allowed.to_owned()));
            }
            if !(0.0..=most).contains(miss.tolerance.get_ref()) {
                let allowed = format!(
                    "is {}: allowed is 0 to {most}, {MOST_PERCENT} % of `value`",
                    miss.tolerance.get_ref()
                );
                return Err(fault(start, "miss.tolerance", allowed));
            }
        }
        for threshold in &file.thresholds {
            if is_empty(&threshold.reason) {
                let allowed = "is empty: allowed is a sentence on why so much";
                return Err(fault(
                    threshold.reason.span().start,
                    "threshold.reason",
                    allowed.to_owned(),
                ));
            }
            if !(0.0..=MOST_PERCENT).contains(threshold.percent.get_ref()) {
                let allowed = format!(
                    "is {}: allowed is 0 to {MOST_PERCENT} % of the reference",
                    threshold.percent.get_ref()
                );
                return Err(fault(threshold.percent.span().start, "threshold.percent", allowed));
            }
        }
        Ok(file.into())
    }

    /// Entries without effect, a sentence each: of no check that was asked, or of one that passes.
    pub fn without_effect(&self, checks: &[Check]) -> Vec<String> {
        let unknown = |ids: &str| !checks.iter().any(|check| matches(ids, &check.id));
        let miss = |miss: &Miss| match checks.iter().find(|check| check.id == miss.id) {
            None => Some(format!("accepted miss `{}`: no such check was asked", miss.id)),
            Some(check) if check.status == Status::Pass => {
                Some(format!("accepted miss `{}`: the check passes without it", miss.id))
            }
            Some(_) => None,
        };
        let threshold = |t: &Threshold| {
            unknown(&t.ids).then(|| format!("threshold `{}`: no such check was asked", t.ids))
        };
        let misses = self.misses.iter().filter_map(miss);
        misses.chain(self.thresholds.iter().filter_map(threshold)).collect()
    }

    /// Judges a row by the last threshold that names it. Theorems and hand calculations are not judged less strictly.
    pub(crate) fn judge(&self, check: &mut Check) {
        let threshold = self.thresholds.iter().rev().find(|t| matches(&t.ids, &check.id));
        let (Some(threshold), Value::Number(expected), Some(Value::Number(actual))) =
            (threshold, &check.expected, &check.actual)
        else {
            return;
        };
        let absolute = 0.01 * threshold.percent * expected.abs();
        let is_exact =
            matches!(check.kind, ReferenceKind::Analytic | ReferenceKind::HandCalculation);
        // Of a reference of 0 no percentage is a tolerance.
        if *expected == 0.0 || (is_exact && absolute > check.tolerance.absolute) {
            return;
        }
        let reason = format!("threshold of the results: {}", threshold.reason);
        check.tolerance = Tolerance { absolute, band: None, reason };
        check.status = match check.tolerance.allows(actual - expected) {
            true => Status::Pass,
            false => Status::Fail,
        };
    }
}
