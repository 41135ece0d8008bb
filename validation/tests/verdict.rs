//! Ids, prefixes and profiles of a verdict. The snapshot tests run the whole verdict.

use std::sync::Mutex;

use validation::{Profile, Progress, Selection, Status, ValidationError, validate, validate_with};

#[test]
fn the_promised_rows_are_there_and_sound() {
    let verdict = validate(Profile::Quick, "table").unwrap();
    let ids: Vec<_> = verdict.checks.iter().map(|c| c.id.clone()).collect();
    for row in 1..=5 {
        assert!(ids.contains(&format!("table2.lumped.{row}")));
    }
    for row in 1..=6 {
        assert!(ids.contains(&format!("table3.lumped.{row}")));
    }
    assert_eq!(verdict.failed, 0);
}

#[test]
fn a_prefix_runs_its_checks_and_no_others() {
    let part = validate(Profile::Quick, "table3.lumped.").unwrap();
    assert!(part.checks.iter().all(|c| c.id.starts_with("table3.lumped.")));
    assert!(part.checks.len() >= 6 && part.failed == 0);
    let nothing = validate(Profile::Quick, "nothing.of.the.kind");
    assert!(matches!(nothing, Err(ValidationError::NoSuchCheck { .. })));
}

#[test]
fn what_the_quick_profile_leaves_out_is_listed_as_not_run() {
    let quick = validate(Profile::Quick, "fe.resolved.ring_planet").unwrap();
    let left_out = quick.checks.iter().filter(|c| c.status == Status::NotRun).count();
    assert_eq!((left_out, quick.passed, quick.failed), (3, 0, 0));
    assert!(quick.checks.iter().all(|c| c.actual.is_none()));
}

#[test]
fn who_waits_is_told_of_every_suite_in_turn() {
    let told = Mutex::new(Vec::new());
    let listen = |progress: Progress<'_>| {
        let (name, is_over) = match progress {
            Progress::SuiteStarted(name) => (name, false),
            Progress::SuiteEnded { name, seconds, checks } => {
                assert!(seconds >= 0.0 && checks > 0, "{name}");
                (name, true)
            }
        };
        told.lock().unwrap().push((name.to_owned(), is_over));
    };
    validate_with(Profile::Quick, &Selection::from("table1."), &listen).unwrap();
    let expected = [("table1".to_owned(), false), ("table1".to_owned(), true)];
    assert_eq!(*told.lock().unwrap(), expected);
}
