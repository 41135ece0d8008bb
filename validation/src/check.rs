//! One checked number or statement, with everything a reader needs to judge it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a value is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReferenceKind {
    /// A closed form or a theorem.
    Analytic,
    /// A number or statement printed in the literature.
    Published,
    /// The same quantity from another program.
    OtherCode,
    /// Worked out by hand from published numbers.
    HandCalculation,
    /// Two of our own routes to one number, convergence, or symmetry of our own output.
    Consistency,
    /// An earlier value of our own: only drift is judged.
    OwnRegression,
}

/// What became of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Within tolerance.
    Pass,
    /// Outside tolerance.
    Fail,
    /// A published value that the sound model does not reproduce, or a limit of our own that it misses, listed
    /// with its analysis.
    Miss,
    /// Not part of the profile that ran.
    NotRun,
    /// Results of another kind of model than the reference: shown beside it, not judged.
    OtherKind,
}

/// A checked value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A word or sentence.
    Text(String),
    /// Several values.
    List(Vec<Value>),
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl<T: Into<Value>> From<Vec<T>> for Value {
    fn from(list: Vec<T>) -> Self {
        Self::List(list.into_iter().map(Into::into).collect())
    }
}

/// How far a value may be off, and why so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Tolerance {
    /// Largest |actual − expected| in the unit of the check; 0 for statements and counts.
    pub absolute: f64,
    /// Range of actual − expected in the unit of the check, where it is not the same to both sides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub band: Option<[f64; 2]>,
    /// Reason for the figure.
    pub reason: String,
}

impl Tolerance {
    /// For statements, words and counts.
    pub fn exact() -> Self {
        Self {
            absolute: 0.0,
            band: None,
            reason: "a statement or a count: it holds or it does not".into(),
        }
    }

    /// Whether a difference is within it; one that is not finite never is.
    pub fn allows(&self, difference: f64) -> bool {
        match self.band {
            Some([low, high]) => difference >= low && difference <= high,
            None => difference.abs() <= self.absolute,
        }
    }
}

/// One check.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Check {
    /// Stable id, e.g. `table2.lumped.1`.
    pub id: String,
    /// What is checked, for people.
    pub title: String,
    /// Kind of reference.
    pub kind: ReferenceKind,
    /// Where the expected value comes from.
    pub source: String,
    /// Expected value.
    pub expected: Value,
    /// What came out; absent if the check has not run.
    pub actual: Option<Value>,
    /// Unit of both.
    pub unit: String,
    /// What else came out, for people; nothing is judged by it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// 100 (actual − expected)/expected, for numbers with a non-zero expectation.
    pub difference_percent: Option<f64>,
    /// Tolerance.
    pub tolerance: Tolerance,
    /// Verdict.
    pub status: Status,
}

/// What a check is about: everything but the verdict.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// Stable id.
    pub id: &'a str,
    /// What is checked.
    pub title: &'a str,
    /// Kind of reference.
    pub kind: ReferenceKind,
    /// Source of the expectation.
    pub source: &'a str,
    /// Unit.
    pub unit: &'a str,
}

impl Check {
    /// A number against a number. A non-finite actual value fails.
    pub fn number(subject: Subject<'_>, expected: f64, actual: f64, tolerance: Tolerance) -> Self {
        // 7773.55 is half a unit from 7773.6, though their difference as binary numbers is more.
        let rounding = 2.0 * f64::EPSILON * expected.abs().max(actual.abs());
        let difference = actual - expected;
        let within = tolerance.allows(difference)
            || tolerance.allows(difference - rounding)
            || tolerance.allows(difference + rounding);
        let difference_percent =
            (expected != 0.0 && actual.is_finite()).then(|| 100.0 * (actual - expected) / expected);
        Self::assemble(subject, expected, actual, difference_percent, tolerance, within)
    }

    /// Words, lists or counts, which must be equal.
    pub fn equal(
        subject: Subject<'_>,
        expected: impl Into<Value>,
        actual: impl Into<Value>,
    ) -> Self {
        let (expected, actual) = (expected.into(), actual.into());
        let within = expected == actual;
        Self::assemble(subject, expected, actual, None, Tolerance::exact(), within)
    }

    /// A check that the profile leaves out.
    pub fn not_run(subject: Subject<'_>, expected: impl Into<Value>, tolerance: Tolerance) -> Self {
        let mut check = Self::assemble(subject, expected, 0.0, None, tolerance, false);
        (check.actual, check.status) = (None, Status::NotRun);
        check
    }

    fn assemble(
        subject: Subject<'_>,
        expected: impl Into<Value>,
        actual: impl Into<Value>,
        difference_percent: Option<f64>,
        tolerance: Tolerance,
        within: bool,
    ) -> Self {
        Self {
            id: subject.id.to_owned(),
            title: subject.title.to_owned(),
            kind: subject.kind,
            source: subject.source.to_owned(),
            expected: expected.into(),
            actual: Some(actual.into()),
            unit: subject.unit.to_owned(),
            note: None,
            difference_percent,
            tolerance,
            status: if within { Status::Pass } else { Status::Fail },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn subject() -> Subject<'static> {
        let kind = ReferenceKind::Analytic;
        Subject { id: "a", title: "a", kind, source: "a", unit: "Hz" }
    }

    #[test]
    fn a_number_outside_its_tolerance_fails_and_so_does_nan() {
        let tolerance = || Tolerance { absolute: 0.5, band: None, reason: String::new() };
        let status = |actual| Check::number(subject(), 100.0, actual, tolerance()).status;
        assert_eq!(status(100.5), Status::Pass);
        assert_eq!(status(100.6), Status::Fail);
        let printed = Tolerance { absolute: 0.05, band: None, reason: String::new() };
        assert_eq!(Check::number(subject(), 7773.6, 7773.55, printed).status, Status::Pass);
        assert_eq!(status(f64::NAN), Status::Fail);
        assert_eq!(status(f64::INFINITY), Status::Fail);
    }

    #[test]
    fn unequal_words_fail() {
        assert_eq!(Check::equal(subject(), "planet", "mixed").status, Status::Fail);
    }
}
