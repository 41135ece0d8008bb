//! What the author of results accepts: rows known to miss, thresholds.

use std::path::Path;

use serde::Deserialize;

use super::error::ManifestError;
use super::file::line_of;
use crate::check::{Check, ReferenceKind, Status, Tolerance, Value};
use crate::glob::matches;
use crate::reference::Miss;

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

/// What the author of results accepts.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accepted {
    /// Rows that the results are known to miss, each pinned and analysed.
    #[serde(default, rename = "miss")]
    pub misses: Vec<Miss>,
    /// Tolerances instead of those of the registry.
    #[serde(default, rename = "threshold")]
    pub thresholds: Vec<Threshold>,
}

/// A tolerance of the author's for some rows.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Threshold {
    /// Id of a check, or a pattern in which `*` stands for any characters.
    pub ids: String,
    /// Largest |yours − reference|, percent of the reference.
    pub percent: f64,
    /// Why so much.
    pub reason: String,
}

impl Accepted {
    /// Reads a TOML file: `[[miss]]` entries with `id` of the check, `value` that the model gives, `tolerance` of it
    /// and `analysis`, why the model is right all the same; `[[threshold]]` entries with `ids`, `percent`, `reason`.
    ///
    /// # Errors
    /// [`ManifestError`] with file and line of the first fault.
    pub fn read(path: &Path) -> Result<Self, ManifestError> {
        let text = scene::read_text(path, MOST_BYTES)
            .map_err(|source| ManifestError::Unreadable { path: path.to_owned(), source })?;
        toml::from_str(&text).map_err(|error| ManifestError::Syntax {
            path: path.to_owned(),
            line: line_of(&text, error.span().map_or(0, |span| span.start)),
            reason: format!(
                "{}: allowed is [[miss]] with id, value, tolerance and analysis, and [[threshold]] with ids, percent \
                 and reason",
                error.message().replace('\n', "; ")
            ),
        })
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
        if is_exact && absolute > check.tolerance.absolute {
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
