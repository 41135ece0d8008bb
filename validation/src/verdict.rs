//! The outcome of a run: all checks, with listed misses taken into account.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, ReferenceKind, Status, Value};
use crate::reference::Miss;

/// A suite that was not asked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct NotAsked {
    /// Its name in the registry.
    pub suite: String,
    /// What it needs that the results lack.
    pub lacks: String,
}

/// All checks of a run and their counts.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct Verdict {
    /// The checks, in the order they ran.
    pub checks: Vec<Check>,
    /// How many passed.
    pub passed: usize,
    /// How many published values, and limits against kept results of our own, are listed misses.
    pub missed: usize,
    /// How many failed.
    pub failed: usize,
    /// How many are of another kind of model than the results, and hence not judged.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub of_another_kind: usize,
    /// Suites that the results cannot answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_asked: Vec<NotAsked>,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl Verdict {
    /// Counts, after turning listed misses from `fail` into `miss`, and failing every listed miss that now
    /// passes, that drifted from its pinned value, whose reference is analytic or a hand calculation, or
    /// whose check is gone.
    pub fn new(mut checks: Vec<Check>, misses: &[Miss]) -> Self {
        for miss in misses {
            match checks.iter_mut().find(|c| c.id == miss.id) {
                Some(check) => judge_miss(check, miss),
                None => checks.push(unknown_miss(miss)),
            }
        }
        Self::counted(checks, Vec::new())
    }

    /// Counts of results that somebody else's model gave. `judges` says whether a check's reference is of their kind;
    /// where it is, a listed row that meets its reference passes, one within tolerance of the value that is pinned
    /// for this project's model is a miss, and any other fails.
    pub(crate) fn of_results(
        mut checks: Vec<Check>,
        misses: &[Miss],
        judges: impl Fn(&str) -> bool,
        not_asked: Vec<NotAsked>,
    ) -> Self {
        for check in &mut checks {
            if !judges(&check.id) {
                check.status = Status::OtherKind;
            } else if let Some(miss) = misses.iter().find(|m| m.id == check.id)
                && check.status == Status::Fail
                && is_pinned(check, miss, check.tolerance.absolute)
            {
                check.status = Status::Miss;
            }
        }
        Self::counted(checks, not_asked)
    }

    fn counted(checks: Vec<Check>, not_asked: Vec<NotAsked>) -> Self {
        let count = |status| checks.iter().filter(|c| c.status == status).count();
        let (passed, missed, failed) =
            (count(Status::Pass), count(Status::Miss), count(Status::Fail));
        let of_another_kind = count(Status::OtherKind);
        Self { checks, passed, missed, failed, of_another_kind, not_asked }
    }

    /// Whether nothing failed.
    pub fn is_sound(&self) -> bool {
        self.failed == 0
    }
}

/// Whether the value is the pinned one, and of a kind of which a reference may be missed: a published value or a limit
/// between own results, but no theorem and no hand calculation.
fn is_pinned(check: &Check, miss: &Miss, tolerance: f64) -> bool {
    let may_miss = !matches!(check.kind, ReferenceKind::Analytic | ReferenceKind::HandCalculation);
    match check.actual {
        Some(Value::Number(x)) => {
            may_miss && (x - miss.value).abs() <= miss.tolerance.max(tolerance)
        }
        _ => false,
    }
}

fn judge_miss(check: &mut Check, miss: &Miss) {
    check.status = match check.status {
        Status::Fail if is_pinned(check, miss, 0.0) => Status::Miss,
        Status::NotRun => Status::NotRun,
        _ => Status::Fail,
    };
}

fn unknown_miss(miss: &Miss) -> Check {
    let subject = crate::check::Subject {
        id: &miss.id,
        title: "a listed miss has a check of its id",
        kind: ReferenceKind::OwnRegression,
        source: "checks/misses.toml",
        unit: "",
    };
    Check::equal(subject, "a check", "no such check")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{Subject, Tolerance};

    fn check(kind: ReferenceKind, actual: f64) -> Check {
        let subject = Subject { id: "t", title: "t", kind, source: "s", unit: "Hz" };
        let tolerance = Tolerance { absolute: 1.0, band: None, reason: String::new() };
        Check::number(subject, 100.0, actual, tolerance)
    }

    fn miss(value: f64) -> Miss {
        Miss { id: "t".into(), value, tolerance: 0.1, analysis: "because".into() }
    }

    #[test]
    fn a_published_value_or_own_truth_at_its_pinned_place_is_a_miss_and_no_theorem_is() {
        let status = |check, misses: &[Miss]| Verdict::new(vec![check], misses).checks[0].status;
        let published = ReferenceKind::Published;
        assert_eq!(status(check(published, 110.0), &[]), Status::Fail);
        assert_eq!(status(check(published, 110.0), &[miss(110.0)]), Status::Miss);
        assert_eq!(status(check(published, 112.0), &[miss(110.0)]), Status::Fail);
        assert_eq!(status(check(published, 100.0), &[miss(100.0)]), Status::Fail);
        let own = ReferenceKind::OwnRegression;
        assert_eq!(status(check(own, 110.0), &[miss(110.0)]), Status::Miss);
        assert_eq!(status(check(own, 112.0), &[miss(110.0)]), Status::Fail);
        assert_eq!(status(check(ReferenceKind::Analytic, 110.0), &[miss(110.0)]), Status::Fail);
        assert_eq!(Verdict::new(vec![], &[miss(1.0)]).failed, 1);
    }

    #[test]
    fn results_of_others_have_the_same_misses_and_fail_by_references_of_their_kind_alone() {
        let status = |kind, actual: f64, judges: bool| {
            let checks = vec![check(kind, actual)];
            let verdict = Verdict::of_results(checks, &[miss(110.0)], |_| judges, Vec::new());
            verdict.checks[0].status
        };
        let published = ReferenceKind::Published;
        assert_eq!(status(published, 100.5, true), Status::Pass, "a listed row that meets it");
        assert_eq!(status(published, 110.9, true), Status::Miss, "within tolerance of the pin");
        assert_eq!(status(published, 111.1, true), Status::Fail);
        assert_eq!(status(published, f64::NAN, true), Status::Fail);
        assert_eq!(status(ReferenceKind::Analytic, 110.0, true), Status::Fail, "a theorem");
        assert_eq!(status(published, 300.0, false), Status::OtherKind);
    }
}
