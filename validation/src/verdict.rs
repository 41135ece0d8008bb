//! The outcome of a run: all checks, with listed misses taken into account.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, ReferenceKind, Status, Value};
use crate::reference::Miss;

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
        let count = |status| checks.iter().filter(|c| c.status == status).count();
        let (passed, missed, failed) =
            (count(Status::Pass), count(Status::Miss), count(Status::Fail));
        Self { checks, passed, missed, failed }
    }

    /// Whether nothing failed.
    pub fn is_sound(&self) -> bool {
        self.failed == 0
    }
}

fn judge_miss(check: &mut Check, miss: &Miss) {
    let pinned = match check.actual {
        Some(Value::Number(x)) => (x - miss.value).abs() <= miss.tolerance,
        _ => false,
    };
    // A published value or a limit between own results may be missed, a theorem or hand calculation may not.
    let may_miss = !matches!(check.kind, ReferenceKind::Analytic | ReferenceKind::HandCalculation);
    check.status = match check.status {
        Status::Fail if may_miss && pinned => Status::Miss,
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
}
