//! The test of `auto`: answers at a loose and a tight tolerance on drawn sets beside a finer calculation.

use experiments::ModelError;
use experiments::auto::{
    AmplitudeQuestion, AutoError, AutoModel, AutoSettings, BodyInertia, Choice, CycleQuestion,
    CycleValue, FrequencyQuestion, Question, choose_amplitude, choose_frequency,
    choose_transmission_error,
};
use experiments::study::{CpuTime, Stopwatch};
use experiments::sweep::SteadySettings;
use lumped::ModeType;
use scene::{AutoResponse, LoadCase, Scene, excitation_of_scene};
use validation::drawn_set;

use super::Outcome;

/// Seeds of the record, one question each.
const SEEDS: std::ops::Range<u64> = 41001..41061;

/// Loose and tight tolerance of natural frequencies, transmission errors at rest and amplitudes, percent.
const TOLERANCES: [[f64; 2]; 3] = [[5.0, 0.5], [10.0, 2.0], [20.0, 5.0]];

/// Harmonics of an amplitude.
const HARMONICS: usize = 5;

/// Discretisation of the truth, finer than any candidate's.
const TRUTH: AutoSettings = AutoSettings {
    model: AutoModel::QuasiStatic,
    flank_elements: Some(24),
    contact_cells: Some(100),
    positions: Some(480),
    steps_per_cycle: Some(480),
    ..AutoSettings::LUMPED
};

/// Modes of each body that give what inertia changes of a true frequency and of a true amplitude, on the coarsest
/// discretisation.
const MODES: [BodyInertia; 2] = [BodyInertia::Modes(100), BodyInertia::Modes(60)];

/// Kinds of questions, in turn by seed: natural frequency, transmission error at rest, amplitude.
const KINDS: [usize; 5] = [0, 0, 1, 1, 2];

fn kind(seed: u64) -> usize {
    KINDS[usize::try_from(seed % 5).unwrap_or(0)]
}

/// A set with a carrier whose bore is drawn as well: outer over bore diameter from 1.5 to 2.9.
fn set(seed: u64, random: &mut fastrand::Rng) -> Option<Scene> {
    let mut scene = drawn_set(seed)?;
    if let Some(carrier) = scene.geometry.as_mut().and_then(|g| g.carrier.as_mut()) {
        carrier.bore_radius_m = carrier.outer_radius_m / (1.5 + 1.4 * random.f64());
    }
    Some(scene)
}

/// One line of the record.
struct Row {
    quantity: String,
    unit: &'static str,
    truth: f64,
    /// At the loose and at the tight tolerance.
    found: [Result<Choice, AutoError>; 2],
    /// CPU time of both choices, s.
    seconds: [f64; 2],
}

/// Answers to a question and the truth, which is `beside` of the finest discretisation and of what modes change on
/// the coarsest.
fn row<Q: Question>(
    question: &Q,
    choose: impl Fn(&Q, f64) -> Result<Choice, AutoError>,
    tolerances: [f64; 2],
    modes: BodyInertia,
) -> Result<Row, AutoError> {
    let mut clock = CpuTime::default();
    let mut seconds = [0.0; 2];
    let found = [0, 1].map(|k| {
        let start = clock.seconds();
        let found = choose(question, tolerances[k]);
        seconds[k] = clock.seconds() - start;
        found
    });
    let fine = question.answer(&TRUTH)?;
    let by_modes = match question.inertias() {
        [_] => 1.0,
        _ => {
            let of = |inertia| question.settings(0, inertia);
            let without = question.answer(&of(BodyInertia::None))?;
            let beside = question.answer_beside(&of(BodyInertia::None), &without)?;
            let modal = question.answer_beside(&of(modes), &without)?;
            question.value(&modal) / question.value(&beside)
        }
    };
    let truth = question.value(&fine) * by_modes;
    Ok(Row { quantity: question.words(), unit: question.unit(), truth, found, seconds })
}

fn of_seed(seed: u64) -> Result<Row, ModelError> {
    let mut random = fastrand::Rng::with_seed(!seed);
    let scene = set(seed, &mut random).ok_or("no drawn scene can be assembled")?;
    let case = LoadCase::of_scene(&scene)?;
    match kind(seed) {
        0 => {
            let types = [ModeType::Rotational, ModeType::Translational, ModeType::Planet];
            // Three planets have no planet modes.
            let mode_type = types[random.usize(0..if scene.planets.count() > 3 { 3 } else { 2 })];
            let number = random.usize(1..=if mode_type == ModeType::Translational { 6 } else { 3 });
            let question = FrequencyQuestion { scene: &scene, case: &case, mode_type, number };
            Ok(row(&question, choose_frequency, TOLERANCES[0], MODES[0])?)
        }
        1 => {
            let value =
                if random.u32(0..4) == 0 { CycleValue::Mean } else { CycleValue::PeakToPeak };
            let question = CycleQuestion { scene: &scene, case: &case, value };
            Ok(row(&question, choose_transmission_error, TOLERANCES[1], BodyInertia::None)?)
        }
        _ => {
            let strengths = excitation_of_scene(&scene, HARMONICS as u32).unwrap_or_default();
            let is_allowed = |response: &AutoResponse| {
                let of = |s: &gearset::ExcitationStrengths| match response {
                    AutoResponse::TransmissionError => s.allowed().rotational,
                    AutoResponse::SunTranslation => s.allowed().translational,
                };
                strengths.iter().any(of)
            };
            let mut both = vec![AutoResponse::TransmissionError, AutoResponse::SunTranslation];
            both.retain(is_allowed);
            let response = both[random.usize(0..both.len().max(1))];
            let rpm = scene.operation.map_or(1000.0, |operation| operation.speed_rpm);
            let shares: &[f64] = if random.bool() { &[0.97, 1.0, 1.03] } else { &[1.0] };
            let speeds = shares.iter().map(|share| share * rpm).collect();
            let steady = SteadySettings {
                harmonics: HARMONICS,
                between_cycles: 0,
                ..SteadySettings::default()
            };
            let question = AmplitudeQuestion::new((&scene, &case), response, speeds, steady);
            let choose =
                |q: &AmplitudeQuestion<'_>, t| choose_amplitude(q, t).map(|found| found.choice);
            Ok(row(&question, choose, TOLERANCES[2], MODES[1])?)
        }
    }
}

/// `kept/auto.csv`.
pub(super) fn remake() -> Outcome {
    println!(
        "# What auto chose on drawn sets at two tolerances, beside a finer calculation (docs/auto.md)."
    );
    println!("# Own computation: remake/src/auto.rs");
    println!("# cargo run --release -p remake -- auto > auto.csv && mv auto.csv kept/");
    println!(
        "seed,quantity,unit,truth,loose_percent,loose_settings,loose_value,loose_estimate_percent,loose_error_percent,\
         tight_percent,tight_settings,tight_value,tight_estimate_percent,tight_error_percent,loose_cpu_s,tight_cpu_s"
    );
    // One thread, so that CPU times are those of the whole work.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let named =
        std::env::args().skip(2).map(|seed| seed.parse()).collect::<Result<Vec<u64>, _>>()?;
    let seeds = if named.is_empty() { SEEDS.collect() } else { named };
    for seed in seeds {
        match pool.install(|| of_seed(seed)) {
            Ok(row) => println!("{}", line(seed, &row)),
            Err(e) => {
                println!("{seed},no truth: {},,,,,,,,,,,,,,", e.to_string().replace(',', ";"))
            }
        }
    }
    Ok(())
}

fn line(seed: u64, row: &Row) -> String {
    let mut cells = vec![
        seed.to_string(),
        row.quantity.replace(',', ""),
        row.unit.into(),
        format!("{:.6}", row.truth),
    ];
    for (found, tolerance) in row.found.iter().zip(TOLERANCES[kind(seed)]) {
        cells.push(tolerance.to_string());
        match found {
            Ok(choice) => cells.extend([
                choice.settings.to_string().replace(',', ""),
                format!("{:.6}", choice.value),
                format!("{:.4}", choice.estimated_error_percent),
                format!("{:.4}", 100.0 * (choice.value / row.truth - 1.0).abs()),
            ]),
            Err(e) => {
                eprintln!("{seed}: {e}");
                cells.extend(["refused".into(), String::new(), String::new(), String::new()]);
            }
        }
    }
    cells.extend(row.seconds.iter().map(|s| format!("{s:.2}")));
    cells.join(",")
}
