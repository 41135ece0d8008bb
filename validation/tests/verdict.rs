//! The whole verdict as one: sound, with the ids that others rely on.

use std::sync::OnceLock;

use validation::{Profile, Status, Verdict, validate};

/// The quick verdict, run once.
fn verdict() -> &'static Verdict {
    static VERDICT: OnceLock<Verdict> = OnceLock::new();
    VERDICT.get_or_init(|| validate(Profile::Quick, "").unwrap())
}

#[test]
fn every_check_passes_or_is_a_listed_miss() {
    let failed: Vec<_> = verdict().checks.iter().filter(|c| c.status == Status::Fail).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    let left_out = verdict().checks.iter().filter(|c| c.status == Status::NotRun).count();
    assert_eq!(verdict().passed + verdict().missed + left_out, verdict().checks.len());
}

#[test]
fn ids_are_unique_and_the_promised_ones_are_there() {
    let mut ids: Vec<_> = verdict().checks.iter().map(|c| c.id.clone()).collect();
    for row in 1..=5 {
        assert!(ids.contains(&format!("table2.lumped.{row}")));
    }
    for row in 1..=6 {
        assert!(ids.contains(&format!("table3.lumped.{row}")));
    }
    ids.sort();
    let before = ids.len();
    ids.dedup();
    assert_eq!(ids.len(), before);
}

#[test]
fn a_prefix_runs_its_checks_and_no_others() {
    let part = validate(Profile::Quick, "table3.lumped.").unwrap();
    assert!(part.checks.iter().all(|c| c.id.starts_with("table3.lumped.")));
    assert!(part.checks.len() >= 6 && part.failed == 0);
    assert!(validate(Profile::Quick, "nothing.of.the.kind").unwrap().checks.is_empty());
}
