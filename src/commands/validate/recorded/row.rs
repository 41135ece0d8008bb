//! A judged check as every report shows it.

use validation::{Check, Miss, Status, Value};

use crate::commands::validate::check_cells::{cells, signed_part, status_word};
use crate::commands::validate::summary::words;

/// A judged check beside its reference, in words for people.
pub(super) struct JudgedRow<'v> {
    pub(super) id: &'v str,
    pub(super) title: &'v str,
    pub(super) reference: String,
    pub(super) yours: String,
    /// Whether both are lists, which are long.
    pub(super) is_list: bool,
    pub(super) unit: &'v str,
    /// Percent of the reference; `–` where there is none.
    pub(super) difference: String,
    /// In the unit, or `exact`; a range of differences where it is not the same to both sides.
    pub(super) tolerance: String,
    /// Why the tolerance is that large.
    pub(super) reason: &'v str,
    /// Where the reference comes from.
    pub(super) source: &'v str,
    pub(super) status: Status,
    pub(super) word: &'static str,
    /// Correct digits; `–` where none can be counted.
    pub(super) digits: String,
    /// What the author accepts, where this row misses.
    pub(super) accepted: Option<&'v Miss>,
    /// (yours − reference)/tolerance; none of words, lists and exact counts.
    pub(super) part: Option<f64>,
    /// Range of `part` that is allowed.
    pub(super) allowed: [f64; 2],
}

impl<'v> JudgedRow<'v> {
    pub(super) fn new(check: &'v Check, accepted: &'v [Miss], digits: Option<f64>) -> Self {
        let [reference, yours, difference, tolerance] = cells(check);
        // Cells shorten lists, which a report has room for.
        let whole = |value: Option<&Value>, short: String| match value {
            None | Some(Value::Number(_)) => short,
            Some(value) => words(value),
        };
        let entry = accepted.iter().find(|miss| miss.id == check.id);
        let accepted = entry.filter(|_| check.status == Status::Miss);
        let absolute = check.tolerance.absolute;
        Self {
            id: &check.id,
            title: &check.title,
            reference: whole(Some(&check.expected), reference),
            yours: whole(check.actual.as_ref(), yours),
            is_list: matches!(check.expected, Value::List(_)),
            unit: &check.unit,
            difference,
            tolerance: check.tolerance.band.map_or(tolerance, |[low, high]| {
                // Of a range the cell has but the larger side.
                format!("{low:+.2} to {high:+.2}")
            }),
            reason: &check.tolerance.reason,
            source: &check.source,
            status: check.status,
            word: match accepted {
                Some(_) => "accepted miss",
                None => status_word(check.status),
            },
            digits: digits_cell(digits),
            accepted,
            part: signed_part(check),
            allowed: check.tolerance.band.map_or([-1.0, 1.0], |band| band.map(|x| x / absolute)),
        }
    }

    /// What the author accepts of this row, as a sentence.
    pub(super) fn acceptance(&self) -> Option<String> {
        let Miss { value, tolerance, analysis, .. } = self.accepted?;
        let unit = self.unit;
        Some(
            format!("accepted by the author at {value} ± {tolerance} {unit}: {}", analysis.trim())
                .replace(" :", ":"),
        )
    }

    /// Reference, value, difference, tolerance and its reason as one sentence.
    pub(super) fn comparison(&self) -> String {
        let with_unit = |cell: &str| match self.unit {
            "" => cell.to_owned(),
            unit => format!("{cell} {unit}"),
        };
        let tolerance = match self.tolerance.as_str() {
            "exact" => "exact".to_owned(),
            tolerance => with_unit(tolerance),
        };
        format!(
            "reference {}, yours {}, difference {} %, tolerance {tolerance} ({})",
            with_unit(&self.reference),
            with_unit(&self.yours),
            self.difference,
            self.reason
        )
        .replace(", difference – %", "")
    }
}

/// Correct digits with one decimal.
pub(super) fn digits_cell(digits: Option<f64>) -> String {
    digits.map_or_else(|| "–".to_owned(), |digits| format!("{digits:.1}"))
}
