//! The paper's checks on your own model, and on tables of its results.

use epicyclic::experiments::ModalModel;
use epicyclic::experiments::models::Recorded;
use epicyclic::gearset::LoadCase;
use epicyclic::validation::results::{Judgement, ResultsFolder};
use epicyclic::validation::{Models, PublishedScene, Status, ValidationError, judge_model, scene};
use your_model::YourModel;

/// Suites that a lumped model with printed parameters must pass.
const SUITES: [&str; 4] = [
    "lin_parker_1999.three_planets",
    "table3.lumped",
    "table2.geometry_consistent",
    "structure.spectrum",
];

fn failures(model: &dyn ModalModel, suite: &str) -> Result<Vec<String>, ValidationError> {
    let models = Models { modal: Some(model), ..Models::default() };
    let verdict = judge_model(&models, suite)?;
    assert!(!verdict.checks.is_empty(), "{suite} asks nothing");
    let failed = verdict.checks.iter().filter(|c| c.status == Status::Fail);
    Ok(failed.map(|c| format!("{}: {:?}, not {:?}", c.id, c.actual, c.expected)).collect())
}

#[test]
fn a_right_model_passes() {
    for suite in SUITES {
        assert_eq!(failures(&YourModel::default(), suite).unwrap(), Vec::<String>::new());
    }
}

#[test]
fn a_wrong_model_is_caught() {
    // A sign that is wrong in all planets alike leaves the structure of the spectrum, not its numbers.
    let wrong = YourModel { sign: -1.0, ..YourModel::default() };
    for suite in SUITES.into_iter().filter(|s| !s.starts_with("structure")) {
        assert!(!failures(&wrong, suite).unwrap().is_empty(), "{suite} did not notice");
    }
}

#[test]
fn tables_of_results_are_judged_alike_and_what_they_lack_is_listed() {
    let (model, mut tables) = (YourModel::default(), Recorded::default());
    let set = scene(PublishedScene::LinParkerFourPlanets).unwrap();
    let modes = model.natural_modes(&set, &LoadCase::standing(0.0)).unwrap();
    tables.modes.extend(modes.into_iter().map(|mode| (set.title.clone(), mode)));
    let folder = tempfile::tempdir().unwrap();
    tables.write(folder.path()).unwrap();
    let read = ResultsFolder::read(folder.path()).unwrap();
    let verdict = read.judge(&Judgement::default()).unwrap();
    assert_eq!(verdict.failed, 0);
    let missed: Vec<&str> =
        verdict.checks.iter().filter(|c| c.status == Status::Miss).map(|c| c.id.as_str()).collect();
    // Three printed digits that no assembly reproduces to half a unit: see checks/misses.toml.
    assert_eq!(
        missed,
        [
            "lin_parker_1999.four_planets.rotational.2",
            "lin_parker_1999.four_planets.translational.1",
            "lin_parker_1999.four_planets.translational.2",
        ]
    );
    // The set of three planets is not in the tables.
    assert!(verdict.not_asked.iter().any(|n| n.lacks.contains("lin_parker_1999_3p")));
}

#[test]
fn an_error_of_your_own_arrives_as_it_is() {
    let mut bare = scene(PublishedScene::Oh58FourPlanets).unwrap();
    bare.lumped = None;
    let error = YourModel::default().natural_modes(&bare, &LoadCase::standing(0.0)).unwrap_err();
    assert_eq!(error.downcast_ref::<your_model::Lacks>(), Some(&your_model::Lacks("[lumped]")));
}

/// The model asked everything, and what it fails.
fn asked_everything(model: &YourModel, only: &str) -> (Vec<String>, Vec<String>) {
    let models = Models {
        modal: Some(model),
        at_rest: Some(model),
        in_time: Some(model),
        ..Models::default()
    };
    let verdict = judge_model(&models, only).unwrap();
    let ids = |status| {
        let own = verdict.checks.iter().filter(move |c| c.status == status);
        own.map(|c| c.id.clone()).collect::<Vec<String>>()
    };
    (ids(Status::Pass), ids(Status::Fail))
}

/// What follows from the mesh phases alone, whatever the teeth are like.
const PHASING: [&str; 10] = [
    "fe.sets.sharing.three",
    "fe.sets.sun_stays.three",
    "fe.sets.sharing.four",
    "fe.sets.mirror",
    "fe.sets.numbering",
    "sweep.forbidden.three",
    "sweep.forbidden.four",
    "sweep.forbidden.five",
    "sweep.allowed.five",
    "sweep.order.five",
];

#[test]
fn every_suite_can_be_asked_and_what_phasing_says_holds() {
    let (passed, failed) = asked_everything(&YourModel::default(), "");
    for suite in [
        "table2.lumped",
        "table3.lumped",
        "table2.geometry_consistent",
        "table3.geometry_consistent",
        "table3.explained",
        "claims",
        "lin_parker_1999",
        "structure",
        "fe.sets",
        "fe.fig12",
        "table2.fe_contact",
        "table3.fe_contact",
        "sweep",
        "torque",
    ] {
        let mut all = passed.iter().chain(&failed);
        assert!(all.any(|id| id.starts_with(suite)), "{suite} was not asked");
    }
    for id in PHASING {
        assert!(passed.iter().any(|p| p == id), "{id}; failed: {failed:?}");
    }
    // A linear model has nothing that grows faster than the torque, which the paper's Fig. 12 and section 4.2 show.
    assert!(failed.iter().any(|id| id == "fe.fig12.rotation_ahead"), "{failed:?}");
}

#[test]
fn mesh_phases_in_the_wrong_order_are_caught() {
    let wrong = YourModel { phasing: -1.0, ..YourModel::default() };
    let (_, failed) = asked_everything(&wrong, "sweep.");
    assert!(failed.iter().any(|id| id == "sweep.order.five"), "{failed:?}");
}
