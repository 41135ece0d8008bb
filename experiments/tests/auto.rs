//! Settings that `auto` chooses for OH-58 with four planets, beside finer calculations.

use experiments::auto::{
    AmplitudeQuestion, AutoError, AutoModel, AutoSettings, BodyInertia, CycleQuestion, CycleValue,
    FrequencyQuestion, Question, choose_amplitude, choose_frequency, choose_transmission_error,
};
use experiments::sweep::SteadySettings;
use lumped::ModeType;
use scene::{AutoResponse, LoadCase, Scene};

fn set(name: &str) -> (Scene, LoadCase) {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let scene = Scene::from_file(path.as_ref()).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    (scene, case)
}

/// A mode that bearings govern is answered in closed form, and at a small tolerance by FE/contact; both are within
/// their estimates of a finer discretisation with modes of the bodies.
#[test]
fn frequencies_are_within_their_estimates() {
    let (scene, case) = set("oh58_4p");
    let mode_type = ModeType::Rotational;
    let question = FrequencyQuestion { scene: &scene, case: &case, mode_type, number: 1 };
    let finest = question.settings(2, BodyInertia::FirstOrder);
    let truth = question.answer(&finest).unwrap();
    for (tolerance, model) in [(5.0, AutoModel::Lumped), (0.2, AutoModel::QuasiStatic)] {
        let choice = choose_frequency(&question, tolerance).unwrap();
        assert_eq!(choice.settings.model, model);
        let error = 100.0 * (choice.value / truth - 1.0).abs();
        println!("{}: {error:.4} of {:.4} %", choice.settings, choice.estimated_error_percent);
        assert!(error <= choice.estimated_error_percent, "{error}");
    }
    let missing = FrequencyQuestion { number: 99, ..question };
    let refusal = choose_frequency(&missing, 10.0).unwrap_err();
    assert!(matches!(refusal, AutoError::NoAnswer { .. }), "{refusal}");
}

#[test]
#[ignore = "long: .ci/full runs it"]
fn transmission_errors_at_rest_are_within_their_estimates() {
    let (scene, case) = set("oh58_4p");
    let value = CycleValue::PeakToPeak;
    let question = CycleQuestion { scene: &scene, case: &case, value };
    let choice = choose_transmission_error(&question, 10.0).unwrap();
    let finer =
        AutoSettings { flank_elements: Some(20), contact_cells: Some(90), ..choice.settings };
    let finer = AutoSettings { positions: Some(320), ..finer };
    let truth = question.value(&question.answer(&finer).unwrap());
    let error = 100.0 * (choice.value / truth - 1.0).abs();
    println!("{error:.3} of {:.3} %", choice.estimated_error_percent);
    assert!(error <= choice.estimated_error_percent && error < 2.0, "{error}");
}

/// An amplitude away from resonances, beside twice the steps; where several motions attract there is no answer.
#[test]
#[ignore = "long: .ci/full runs it"]
fn amplitudes_are_answered_where_one_motion_attracts() {
    let (scene, case) = set("oh58_4p");
    let response = AutoResponse::TransmissionError;
    let steady = || SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let question = AmplitudeQuestion::new((&scene, &case), response, vec![1500.0], steady());
    let found = choose_amplitude(&question, 20.0).unwrap();
    let chosen = found.choice.settings;
    let finer = AutoSettings { steps_per_cycle: chosen.steps_per_cycle.map(|n| 2 * n), ..chosen };
    let truth = question.value(&question.answer(&finer).unwrap());
    let error = 100.0 * (found.choice.value / truth - 1.0).abs();
    let estimate = found.choice.estimated_error_percent;
    println!("{chosen}: {error:.3} of {estimate:.3} %");
    assert!(error <= estimate, "{error} {estimate}");
    // Under a twentieth of its torque the set with three planets has motions with and without contact loss there.
    let (scene, case) = set("oh58_3p");
    let case = case.with_sun_torque(60.0);
    let question = AmplitudeQuestion::new((&scene, &case), response, vec![3500.0], steady());
    let refusal = choose_amplitude(&question, 50.0).map(|found| found.choice).unwrap_err();
    assert!(refusal.to_string().contains("several motions attract"), "{refusal}");
}
