//! Runs a study: truths once, settings in rounds between runs of the yardstick.

use scene::LoadCase;

use super::answers::{Answer, answers};
use super::cost::{CpuTime, Quartiles, Stopwatch, Timings, interleaved, quartiles};
use super::efficiency::{Candidate, Doubt, Judged, judge};
use super::error::StudyError;
use super::experiment::{Experiment, Work};
use super::quantity::Quantity;
use super::result::{
    QuantityResult, QuantityTime, Row, RowTime, SettingResult, StudyResult, StudyTime, TruthResult,
};
use super::study_file::{CostKind, StudyFile};
use super::truth::{Way, truth};
use super::yardstick::{Yardstick, yardstick};
use crate::scene_keys::flat;

/// Runs a study on one thread; `now` hears what is being done.
///
/// # Errors
/// If the yardstick cannot be marched, a quantity has no truth, or a setting gives different answers in two rounds. A
/// setting without an answer is no error: its row says why.
pub fn run_study(
    study: &StudyFile,
    now: &(dyn Fn(&str) + Sync),
) -> Result<StudyResult, StudyError> {
    run_study_with(study, &mut || Box::new(CpuTime::default()), now)
}

/// The same with a stopwatch of one's own, made on the thread of the study.
///
/// # Errors
/// As [`run_study`].
pub fn run_study_with(
    study: &StudyFile,
    stopwatch: &mut (dyn FnMut() -> Box<dyn Stopwatch> + Send),
    now: &(dyn Fn(&str) + Sync),
) -> Result<StudyResult, StudyError> {
    apart(|| on_this_thread(study, stopwatch().as_mut(), now))?
}

/// Runs on a thread of its own, so that times are those of one core. The yardstick shares its thread with no contact
/// solution: the state in which one leaves the processor's registers halves the speed of what follows on its thread.
fn apart<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, StudyError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|e| StudyError::Thread(e.to_string()))?;
    Ok(pool.install(work))
}

fn on_this_thread(
    study: &StudyFile,
    stopwatch: &mut dyn Stopwatch,
    now: &(dyn Fn(&str) + Sync),
) -> Result<StudyResult, StudyError> {
    let torque = study.sun_torque_nm;
    let case = LoadCase::of_scene(&study.scene).map_err(|e| StudyError::Yardstick(e.into()))?;
    let case = torque.map_or(case, |torque| case.with_sun_torque(torque));
    now("yardstick");
    let lumped = apart(|| yardstick(&study.scene, case))?.map_err(StudyError::Yardstick)?;
    let mut unit = Yardstick::new(&lumped).map_err(StudyError::Yardstick)?;
    let experiments = experiments(&study.quantities);
    let truths = truths(study, stopwatch, now)?;
    let mut first: Vec<Vec<Answer>> = Vec::new();
    let mut measured = Measuring { study, stopwatch, now };
    let clock: &mut Measuring<'_> = &mut measured;
    let clock = std::cell::RefCell::new(clock);
    let timings = interleaved(
        study.rounds,
        study.settings.len(),
        || {
            let mut own = clock.borrow_mut();
            unit.cycle_s(own.stopwatch).map_err(StudyError::Yardstick)
        },
        |round, setting| {
            let found = clock.borrow_mut().answers(round, setting, &experiments)?;
            let times = found.iter().flat_map(|a| a.times).collect();
            match first.get(setting) {
                None => first.push(found),
                Some(before) => same(study, setting, &experiments, before, &found)?,
            }
            Ok(times)
        },
    )?;
    let quantities = study.quantities.iter().zip(truths);
    let quantities = quantities
        .map(|(quantity, truth)| judged(study, (quantity, truth), &experiments, &first, &timings))
        .collect();
    let settings = study.settings.iter().map(|s| SettingResult {
        name: s.name.clone(),
        group: s.group.clone(),
        choices: s.choices.described(),
    });
    Ok(StudyResult {
        title: study.title.clone(),
        scene: study.scene.title.clone(),
        sun_torque_nm: case.sun_torque_nm,
        keys: flat(&study.keys),
        tolerance_percent: study.tolerance_percent,
        cost: study.cost,
        rounds: study.rounds,
        settings: settings.collect(),
        quantities,
        time: StudyTime {
            yardstick_s: quartiles(&timings.yardsticks),
            yardstick_drift: timings.drift(),
        },
    })
}

struct Measuring<'s> {
    study: &'s StudyFile,
    stopwatch: &'s mut dyn Stopwatch,
    now: &'s (dyn Fn(&str) + Sync),
}

impl Measuring<'_> {
    fn answers(
        &mut self,
        round: usize,
        setting: usize,
        experiments: &[Experiment],
    ) -> Result<Vec<Answer>, StudyError> {
        let own = &self.study.settings[setting];
        (self.now)(&format!("round {} of {}, {}", round + 1, self.study.rounds, own.name));
        let (torque, stopwatch) = (self.study.sun_torque_nm, &mut *self.stopwatch);
        apart(|| answers(own, torque, experiments, stopwatch))
    }
}

/// The experiments of all quantities, each once.
fn experiments(quantities: &[Quantity]) -> Vec<Experiment> {
    let mut list: Vec<Experiment> = Vec::new();
    for quantity in quantities {
        if !list.contains(&quantity.experiment) {
            list.push(quantity.experiment.clone());
        }
    }
    list
}

fn place(experiments: &[Experiment], quantity: &Quantity) -> usize {
    experiments.iter().position(|e| *e == quantity.experiment).unwrap_or(0)
}

/// Refuses answers that differ from those of the first round.
fn same(
    study: &StudyFile,
    setting: usize,
    experiments: &[Experiment],
    before: &[Answer],
    after: &[Answer],
) -> Result<(), StudyError> {
    for quantity in &study.quantities {
        let k = place(experiments, quantity);
        let value = |list: &[Answer]| value(quantity, &list[k]).unwrap_or(f64::NAN);
        let (first, then) = (value(before), value(after));
        if first.to_bits() != then.to_bits() && !(first.is_nan() && then.is_nan()) {
            return Err(StudyError::Unrepeatable {
                setting: study.settings[setting].name.clone(),
                quantity: quantity.name.clone(),
                first,
                then,
            });
        }
    }
    Ok(())
}

fn value(quantity: &Quantity, answer: &Answer) -> Result<f64, String> {
    answer.outcome.as_ref().map_err(String::clone).and_then(|own| quantity.reading.of(own))
}

/// The truths of all quantities; settings of a route answer all of its quantities at once.
fn truths(
    study: &StudyFile,
    stopwatch: &mut dyn Stopwatch,
    now: &(dyn Fn(&str) + Sync),
) -> Result<Vec<TruthResult>, StudyError> {
    let mut results = vec![Vec::new(); study.quantities.len()];
    for route in &study.routes {
        let own: Vec<usize> = (0..study.quantities.len()).filter(|k| route.is_for(*k)).collect();
        let asked: Vec<Quantity> = own.iter().map(|k| study.quantities[*k].clone()).collect();
        let experiments = experiments(&asked);
        let settings = match &route.way {
            Way::Kept { .. } => &[][..],
            Way::Settings { settings, .. } => settings,
        };
        let mut found = Vec::new();
        for setting in settings {
            now(&format!("truth, {}", setting.name));
            let torque = study.sun_torque_nm;
            found.push(apart(|| answers(setting, torque, &experiments, &mut *stopwatch))?);
        }
        for (k, quantity) in own.into_iter().zip(&asked) {
            let at = place(&experiments, quantity);
            let values = found.iter().zip(settings).map(|(list, setting)| {
                value(quantity, &list[at]).map_err(|reason| StudyError::Truth {
                    route: route.name.clone(),
                    quantity: quantity.name.clone(),
                    reason: format!("{}: {reason}", setting.name),
                })
            });
            let values = values.collect::<Result<Vec<_>, _>>()?;
            results[k].push(route.result(&values));
        }
    }
    let all = results.into_iter().zip(&study.quantities);
    all.map(|(routes, quantity)| {
        let route = routes.first().map_or(String::new(), |r| r.name.clone());
        let quantity = quantity.name.clone();
        truth(routes).map_err(|reason| StudyError::Truth { route, quantity, reason })
    })
    .collect()
}

/// Set-up and experiment of a setting, and their sum, in mesh cycles of the lumped model.
#[derive(Clone, Copy)]
struct Costs {
    set_up: Quartiles,
    solution: Quartiles,
    cost: Quartiles,
}

impl Costs {
    fn of(timings: &Timings, setting: usize, experiment: usize, kind: CostKind) -> Self {
        let part = |k: usize| &timings.ratios[setting][2 * experiment + k];
        let whole: Vec<f64> = part(0).iter().zip(part(1)).map(|(a, b)| a + b).collect();
        let (set_up, solution) = (quartiles(part(0)), quartiles(part(1)));
        let cost = match kind {
            CostKind::Whole => quartiles(&whole),
            CostKind::Solution => solution,
        };
        Self { set_up, solution, cost }
    }
}

/// A setting with an answer.
struct Answered {
    setting: usize,
    value: f64,
    costs: Costs,
    work: f64,
}

fn judged(
    study: &StudyFile,
    (quantity, truth): (&Quantity, TruthResult),
    experiments: &[Experiment],
    answers: &[Vec<Answer>],
    timings: &Timings,
) -> QuantityResult {
    let k = place(experiments, quantity);
    let mut list = Vec::new();
    let mut refusals = vec![None; answers.len()];
    for (setting, own) in answers.iter().enumerate() {
        let costs = Costs::of(timings, setting, k, study.cost);
        match value(quantity, &own[k]) {
            Ok(value) => {
                let work = own[k].work.of(quantity.work);
                list.push(Answered { setting, value, costs, work });
            }
            Err(reason) => refusals[setting] = Some(reason),
        }
    }
    let judge_by = |cost: &dyn Fn(usize, &Answered) -> f64| {
        let candidate = |(i, a): (usize, &Answered)| Candidate {
            value: a.value,
            cost: cost(i, a),
            place: study.settings[a.setting].place,
        };
        let all: Vec<Candidate> = list.iter().enumerate().map(candidate).collect();
        judge(truth.value, truth.uncertainty, &all)
    };
    let by_time = judge_by(&|_, a| a.costs.cost.median);
    let by_work = judge_by(&|_, a| a.work);
    // One setting at a time as dear as its quartiles allow, all others as cheap, and the other way round.
    let moved: Vec<[bool; 2]> = (0..list.len())
        .map(|i| {
            let ends = |own: fn(&Quartiles) -> f64, others: fn(&Quartiles) -> f64| {
                let cost =
                    |k: usize, a: &Answered| (if k == i { own } else { others })(&a.costs.cost);
                judge_by(&cost)[i].is_efficient
            };
            [ends(|q| q.low, |q| q.high), ends(|q| q.high, |q| q.low)]
        })
        .collect();
    let mut rows: Vec<Row> = study
        .settings
        .iter()
        .zip(refusals)
        .enumerate()
        .map(|(setting, (own, refusal))| empty(&own.name, refusal, answers[setting][k].work))
        .collect();
    for (i, (a, j)) in list.iter().zip(&by_time).enumerate() {
        let is_open = moved[i].iter().any(|is| *is != j.is_efficient);
        rows[a.setting] = Row {
            value: Some(a.value),
            error_percent: Some(j.error_percent),
            guarded_percent: Some(j.guarded_percent),
            doubt: j.doubt,
            is_within_uncertainty: j.is_within_uncertainty,
            rank: Some(j.rank),
            ranks: Some(j.ranks),
            is_efficient_by_work: by_work[i].is_efficient,
            time: RowTime {
                set_up_cycles: Some(a.costs.set_up),
                solution_cycles: Some(a.costs.solution),
                cost_cycles: Some(a.costs.cost),
                is_efficient: j.is_efficient,
                is_efficiency_uncertain: j.is_efficiency_uncertain || is_open,
            },
            ..rows[a.setting].clone()
        };
    }
    let is_good = |i: usize| is_good(&by_time[i], &truth, study.tolerance_percent);
    let good: Vec<usize> = (0..list.len()).filter(|i| is_good(*i)).collect();
    let least = |of: &dyn Fn(&Answered) -> f64| {
        good.iter().copied().min_by(|a, b| of(&list[*a]).total_cmp(&of(&list[*b])))
    };
    let name = |i: usize| study.settings[list[i].setting].name.clone();
    let cheapest = least(&|a| a.costs.cost.median);
    let equally_cheap = good.iter().copied().filter(|i| {
        cheapest.is_some_and(|c| c != *i && list[c].costs.cost.overlaps(&list[*i].costs.cost))
    });
    QuantityResult {
        name: quantity.name.clone(),
        kind: quantity.kind,
        unit: quantity.unit.into(),
        work: quantity.work,
        notes: notes(&rows, &truth, study.tolerance_percent),
        answer_by_work: least(&|a| a.work).map(name),
        time: QuantityTime {
            answer: cheapest.map(name),
            answer_cycles: cheapest.map(|c| list[c].costs.cost),
            equally_cheap: equally_cheap.map(name).collect(),
        },
        truth,
        rows,
    }
}

/// Whether the guarded error and U together are within the tolerance.
fn is_good(judged: &Judged, truth: &TruthResult, tolerance_percent: f64) -> bool {
    judged.guarded_percent + truth.uncertainty_percent <= tolerance_percent
}

fn empty(name: &str, refusal: Option<String>, work: Work) -> Row {
    Row {
        setting: name.into(),
        refusal,
        value: None,
        error_percent: None,
        guarded_percent: None,
        doubt: None,
        is_within_uncertainty: false,
        rank: None,
        ranks: None,
        is_efficient_by_work: false,
        work,
        time: RowTime {
            set_up_cycles: None,
            solution_cycles: None,
            cost_cycles: None,
            is_efficient: false,
            is_efficiency_uncertain: false,
        },
    }
}

fn notes(rows: &[Row], truth: &TruthResult, tolerance_percent: f64) -> Vec<String> {
    let mut notes = Vec::new();
    for row in rows {
        let guarded = row.guarded_percent.unwrap_or(f64::NAN);
        match row.doubt {
            Some(Doubt::Crossing) => notes.push(format!(
                "{}: the error crosses zero here, and a finer setting is {} % off on the other side: ranked by that",
                row.setting,
                Significant(guarded)
            )),
            Some(Doubt::GrowsWithRefinement) => notes.push(format!(
                "{}: a finer setting of the series is {} % off: ranked by that",
                row.setting,
                Significant(guarded)
            )),
            None => (),
        }
        if row.work.marched_instead > 0.0 {
            notes.push(format!(
                "{}: {} of its steady states were marched, because shooting found no stable periodic motion",
                row.setting, row.work.marched_instead
            ));
        }
        if let Some(reason) = &row.refusal {
            notes.push(format!("{}: no answer: {reason}", row.setting));
        }
    }
    let open: Vec<&str> = rows
        .iter()
        .filter(|row| row.ranks.is_some_and(|[low, high]| low != high))
        .map(|row| row.setting.as_str())
        .collect();
    if !open.is_empty() {
        notes.push(format!(
            "ranks that change as the truth moves by ±{} %: {}",
            Significant(truth.uncertainty_percent),
            open.join("; ")
        ));
    }
    if truth.uncertainty_percent > tolerance_percent {
        notes.push(format!(
            "U is {} %, larger than the tolerance: no setting can be shown to be within it",
            Significant(truth.uncertainty_percent)
        ));
    }
    for route in truth.routes.iter().filter(|r| r.order.is_none() && r.values.len() > 2) {
        notes.push(format!(
            "truth `{}`: no order of convergence can be observed; its finest value is taken, with three times its last \
             change as uncertainty",
            route.name
        ));
    }
    notes
}

/// Shown with two significant digits.
struct Significant(f64);

impl std::fmt::Display for Significant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let decimals = (1 - self.0.abs().log10().floor() as i32).clamp(0, 9) as usize;
        write!(f, "{:.decimals$}", self.0)
    }
}
