//! What `auto` answers, and why it may not.

use schemars::JsonSchema;
use serde::Serialize;

use super::error_parts::EXPANDED;
use super::settings::AutoSettings;
use crate::error::ExperimentError;

/// One part of an estimated error.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ErrorPart {
    /// The approximation that causes it.
    pub source: String,
    /// Its size, percent of the quantity.
    pub percent: f64,
}

impl ErrorPart {
    pub(super) fn new(source: &str, share: f64) -> Self {
        Self { source: source.into(), percent: 100.0 * share }
    }
}

/// A correction of a value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Correction {
    /// The approximation whose effect it takes out.
    pub of: String,
    /// Change of the value, percent.
    pub percent: f64,
}

/// A candidate that was not chosen.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PassedOver {
    /// Its settings.
    pub settings: AutoSettings,
    /// Its estimated error, percent; absent where the candidate gave no answer.
    pub estimated_error_percent: Option<f64>,
    /// Why it was passed over.
    pub why: String,
}

/// The settings chosen for a quantity, and the answer with them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Choice {
    /// The quantity, in words.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
    /// Wanted accuracy, percent of the value.
    pub tolerance_percent: f64,
    /// Estimated error of the value, percent: the sum of `error_parts`, of an amplitude the root of the sum of their squares, of the lumped model
    /// 2/√3 of that if it is less.
    pub estimated_error_percent: f64,
    /// What the error consists of.
    pub error_parts: Vec<ErrorPart>,
    /// What the value was corrected for, after the calculation with these settings: by so many percent of the value that they give by
    /// themselves.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corrections: Vec<Correction>,
    /// Settings chosen.
    pub settings: AutoSettings,
    /// Cheaper candidates, and why each was not chosen.
    pub passed_over: Vec<PassedOver>,
}

/// Sum of the parts, percent: as if all errors had one sign.
pub(super) fn total(parts: &[ErrorPart]) -> f64 {
    parts.iter().map(|part| part.percent).sum()
}

/// How the parts of an error are taken together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Together {
    /// As if all had one sign.
    Sum,
    /// As errors of independent causes that are anywhere within their bounds, at most the sum.
    Squares,
    /// As errors of independent causes whose parts are what most of them are within, not bounds (expanded uncertainties: JCGM 100:2008, 5.1.2).
    Expanded,
}

impl Together {
    /// The error that the parts amount to, percent.
    pub(super) fn of(self, parts: &[ErrorPart]) -> f64 {
        let squares = || parts.iter().map(|part| part.percent * part.percent).sum::<f64>();
        match self {
            Self::Sum => total(parts),
            Self::Squares => total(parts).min(EXPANDED * squares().sqrt()),
            Self::Expanded => squares().sqrt(),
        }
    }
}

/// Why there is no choice.
#[derive(Debug, thiserror::Error)]
pub enum AutoError {
    /// A tolerance that is none.
    #[error(
        "`dynamics.tolerance_percent` is {0}: allowed is a finite number above 0 and up to 100"
    )]
    Tolerance(f64),
    /// No candidate has the quantity: each with its reason.
    #[error("{quantity}: no settings give it: {}", listed(.passed_over))]
    NoAnswer {
        /// The quantity, in words.
        quantity: String,
        /// Every candidate that was tried.
        passed_over: Vec<PassedOver>,
    },
    /// Every candidate's estimated error is above the tolerance.
    #[error(
        "{quantity}: no settings are estimated to be within {tolerance_percent} %: {}; allow a larger tolerance, or name \
         the settings and judge them by a study", listed(.passed_over)
    )]
    NothingMeets {
        /// The quantity, in words.
        quantity: String,
        /// Wanted accuracy, percent.
        tolerance_percent: f64,
        /// Every candidate with its estimate.
        passed_over: Vec<PassedOver>,
    },
    /// The scene lacks what the estimates need.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

/// Candidates with their reasons; a reason that neighbours share stands once, and alone where all share it.
fn listed(all: &[PassedOver]) -> String {
    let groups: Vec<&[PassedOver]> = all.chunk_by(|a, b| a.why == b.why).collect();
    let one = |group: &&[PassedOver]| {
        let settings: Vec<String> = group.iter().map(|p| p.settings.to_string()).collect();
        let why = group.first().map_or("", |p| p.why.as_str());
        match groups.len() {
            1 if group.len() > 1 => why.to_owned(),
            _ => format!("{}: {why}", settings.join(" and ")),
        }
    };
    groups.iter().map(one).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal parts by squares are √(8/3) of one; one alone, or one beside a very small one, is no more than the sum.
    #[test]
    fn parts_together_are_at_most_their_sum() {
        let of = |list: &[f64]| {
            let parts: Vec<_> = list.iter().map(|e| ErrorPart::new("", *e)).collect();
            [Together::Sum, Together::Squares, Together::Expanded].map(|own| own.of(&parts))
        };
        let [sum, squares, expanded] = of(&[0.01, 0.01]);
        assert!((sum - 2.0).abs() < 1e-12 && (squares - (8.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((expanded - 2f64.sqrt()).abs() < 1e-12);
        for list in [&[0.02][..], &[0.02, 0.001], &[]] {
            let [sum, squares, expanded] = of(list);
            assert!(sum == squares && expanded <= sum, "{list:?}");
        }
        assert!(of(&[0.01, f64::INFINITY])[1..].iter().all(|e| e.is_infinite()));
    }

    #[test]
    fn a_reason_that_candidates_share_is_given_once() {
        let over = |flank_elements, why: &str| PassedOver {
            settings: AutoSettings::quasi_static(flank_elements, 20),
            estimated_error_percent: None,
            why: why.into(),
        };
        assert_eq!(listed(&[over(6, "no such mode"), over(10, "no such mode")]), "no such mode");
        assert_eq!(
            listed(&[over(6, "a"), over(10, "b"), over(16, "b")]),
            "quasi_static, 6 flank elements, 20 contact cells: a; quasi_static, 10 flank elements, 20 contact cells and \
             quasi_static, 16 flank elements, 20 contact cells: b"
        );
        assert_eq!(listed(&[over(6, "a")]), "quasi_static, 6 flank elements, 20 contact cells: a");
    }
}
