//! The whole verdict as one: sound, with the ids that others rely on.

#[test]
fn every_check_passes_or_is_a_listed_miss() {
    let verdict = validation::validate().unwrap();
    let failed: Vec<_> =
        verdict.checks.iter().filter(|c| c.status == validation::Status::Fail).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(verdict.passed + verdict.missed, verdict.checks.len());
}

#[test]
fn ids_are_unique_and_the_promised_ones_are_there() {
    let verdict = validation::validate().unwrap();
    let mut ids: Vec<_> = verdict.checks.iter().map(|c| c.id.clone()).collect();
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
