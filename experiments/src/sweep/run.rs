//! Runs a plan: chains side by side, points kept as soon as they are there.

use std::cell::{Cell, RefCell};
use std::sync::OnceLock;

use rayon::prelude::*;
use scene::LoadCase;
use serde::{Deserialize, Serialize};

use super::error::SweepError;
use super::failed_point::FailedPoint;
use super::judge::peak_centres;
use super::plan::{Chain, Plan};
use super::point::{SearchStart, SweepPoint};
use super::random_start::start_at_random;
use super::resolved_steps::{Resolved, Vibrations};
use super::search::steady;
use super::state::SteadyState;
use super::steady::{CameFrom, SteadyMethod, SteadySettings};
use super::sweep_model::SweepModel;
use crate::table_growth::large_enough;

/// A finished point: a steady state or motion found, or a failure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kept {
    /// A point with the state its chain goes on from.
    Found {
        /// The point.
        point: Box<SweepPoint>,
        /// State after it.
        state: Vec<f64>,
    },
    /// A speed at which nothing could be computed; its chain goes on from the state before it.
    Failed(FailedPoint),
}

/// Why a point could not be kept or read.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct StoreError {
    /// What went wrong, naming the file.
    pub message: String,
}

/// Where finished points go.
pub trait PointStore: Sync {
    /// A point that an earlier run finished.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    fn load(&self, chain: &Chain, index: usize) -> Result<Option<Kept>, StoreError>;

    /// Keeps a point for good.
    ///
    /// # Errors
    /// If it cannot be written.
    fn save(&self, chain: &Chain, index: usize, kept: &Kept) -> Result<(), StoreError>;
}

/// Keeps nothing beyond the run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Memory;

impl PointStore for Memory {
    fn load(&self, _: &Chain, _: usize) -> Result<Option<Kept>, StoreError> {
        Ok(None)
    }

    fn save(&self, _: &Chain, _: usize, _: &Kept) -> Result<(), StoreError> {
        Ok(())
    }
}

/// Points of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Fidelity or model.
    pub fidelity: String,
    /// Points by chain, in its order.
    pub chains: Vec<(String, Vec<SweepPoint>)>,
    /// Speeds at which nothing could be computed, chain by chain, in the order of each chain.
    pub failed: Vec<FailedPoint>,
}

impl Sweep {
    /// All points with the name of their chain, by speed; at one speed in the order of the chains.
    pub fn by_speed(&self) -> Vec<(&str, &SweepPoint)> {
        let mut all: Vec<(&str, &SweepPoint)> = Vec::new();
        for (name, points) in &self.chains {
            all.extend(points.iter().map(|point| (name.as_str(), point)));
        }
        all.sort_by(|(_, a), (_, b)| a.state.case.speed_rpm.total_cmp(&b.state.case.speed_rpm));
        all
    }

    /// All points by speed.
    pub fn points(&self) -> Vec<&SweepPoint> {
        self.by_speed().into_iter().map(|(_, point)| point).collect()
    }

    /// Failed points by speed; at one speed in the order of the chains.
    pub fn failed_by_speed(&self) -> Vec<&FailedPoint> {
        let mut all: Vec<&FailedPoint> = self.failed.iter().collect();
        all.sort_by(|a, b| a.case.speed_rpm.total_cmp(&b.case.speed_rpm));
        all
    }

    /// The sweep, if every speed of its plan has a result.
    ///
    /// # Errors
    /// [`SweepError::Failed`] with the failed point of lowest speed.
    pub fn complete(self) -> Result<Self, SweepError> {
        match self.failed_by_speed().first() {
            Some(first) => Err(SweepError::Failed(Box::new((*first).clone()))),
            None => Ok(self),
        }
    }

    /// The sweep, if every motion of it repeats with the mesh cycle and attracts.
    ///
    /// # Errors
    /// [`SweepError::NoSteadyState`] with the lowest speed of which that is not so.
    pub fn steady(self) -> Result<Self, SweepError> {
        let Some(point) = self.points().into_iter().find(|p| !p.is_steady) else { return Ok(self) };
        let repeats = match point.repeats_after {
            Some(1) => format!("the motion repeats, attraction: {}", point.attracts.name()),
            Some(cycles) => format!("the motion repeats after {cycles} cycles"),
            None => "the motion does not repeat".into(),
        };
        let found = format!("{repeats}, {} cycles after its start", point.cycles);
        Err(SweepError::NoSteadyState { rpm: point.state.case.speed_rpm, found })
    }

    /// Adds the points of another sweep of the same model, such as one about the peaks of this one.
    pub fn extend(&mut self, more: Self) {
        self.chains.extend(more.chains);
        self.failed.extend(more.failed);
    }

    /// Harmonics of all points by speed.
    pub fn states(&self) -> Vec<&SteadyState> {
        self.points().into_iter().map(|p| &p.state).collect()
    }

    /// Chains of `count` speeds about every peak of the sun and of planet 0 that stands out by `least`,
    /// `span` (parts of the speed) to either side; peaks nearer than that share one.
    pub fn around_peaks(
        &self,
        least: f64,
        span: f64,
        count: usize,
        steady: SteadySettings,
    ) -> Plan {
        let attract = self.points().into_iter().filter(|p| p.attracts.is_shown());
        let states: Vec<&SteadyState> = attract.map(|p| &p.state).collect();
        let centres = peak_centres(&states, steady.harmonics, least, span);
        Plan::around(&centres, span, count, steady)
    }
}

/// Runs every chain of a plan; `done` hears of each point, finished now or before, failed ones included.
///
/// A speed whose march to the steady state fails is recorded in [`Sweep::failed`]. Its chain goes on with the
/// next speed from the state after its last point that succeeded, or from rest if there is none.
///
/// # Errors
/// If the set cannot be built or brought to rest, or a point cannot be kept or read; finished points stay
/// kept.
pub fn run(
    model: &dyn SweepModel,
    plan: &Plan,
    store: &dyn PointStore,
    done: &(dyn Fn(&Kept) + Sync),
) -> Result<Sweep, SweepError> {
    plan.steady.check(model.steps_per_cycle())?;
    type Chained = (Vec<SweepPoint>, Vec<FailedPoint>);
    let is_complete = |chain: &Chain| -> Result<bool, StoreError> {
        let last = chain.speeds_rpm.len().saturating_sub(1);
        Ok(store.load(chain, last)?.is_some())
    };
    for chain in &plan.chains {
        if !is_complete(chain)? {
            model.prepare()?;
            break;
        }
    }
    let (vibrations, inertia) = (OnceLock::new(), OnceLock::new());
    let chains = plan.chains.par_iter().map(|chain| {
        let (mut points, mut failed) = Chained::default();
        let mut start: (SearchStart, Option<Vec<f64>>) = Default::default();
        for (index, speed) in chain.speeds_rpm.iter().enumerate() {
            let kept = match store.load(chain, index)? {
                Some(kept) => kept,
                None => {
                    let from = match chain.random_start {
                        Some(number) => (SearchStart::Random(number), None),
                        None => (start.0, start.1.as_deref()),
                    };
                    let known = of_model(model, &plan.steady, &vibrations)?;
                    let mut kept = resolved((model, known), chain, *speed, from, &plan.steady)?;
                    if let (Kept::Found { point, .. }, Some(known)) = (&mut kept, known) {
                        let (steps, highest) = (point.steps_per_cycle, plan.steady.harmonics);
                        point.step_error = known.step_error(&point.state, steps, highest);
                        let shifted = inertia.get_or_init(|| model.body_inertia());
                        point.inertia_error = shifted
                            .as_ref()
                            .and_then(|own| own.error(&point.state, known, highest));
                    }
                    store.save(chain, index, &kept)?;
                    kept
                }
            };
            done(&kept);
            match kept {
                Kept::Found { point, state } => {
                    start = (SearchStart::Speed(point.state.case.speed_rpm), Some(state));
                    points.push(*point);
                }
                Kept::Failed(point) => failed.push(point),
            }
        }
        Ok((points, failed))
    });
    let found: Vec<Chained> = chains.collect::<Result<_, SweepError>>()?;
    let (points, failed): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let chains = plan.chains.iter().map(|c| c.name.clone()).zip(points).collect();
    Ok(Sweep { fidelity: model.name(), chains, failed: failed.concat() })
}

/// The vibrations of a model, found once; `None` where steps are kept, and of a model without derivative.
///
/// # Errors
/// If a set cannot be built, or its vibrations are not found.
fn of_model<'v>(
    model: &dyn SweepModel,
    settings: &SteadySettings,
    vibrations: &'v OnceLock<Option<Vibrations>>,
) -> Result<Option<&'v Vibrations>, SweepError> {
    if settings.keeps_steps {
        return Ok(None);
    }
    if vibrations.get().is_none() {
        let found = Vibrations::of(model)?;
        vibrations.get_or_init(|| found);
    }
    Ok(vibrations.get().and_then(Option::as_ref))
}

/// One speed in the steps that the vibrations of the set need there.
///
/// # Errors
/// As [`one`].
fn resolved(
    (model, vibrations): (&dyn SweepModel, Option<&Vibrations>),
    chain: &Chain,
    speed_rpm: f64,
    from: (SearchStart, Option<&[f64]>),
    settings: &SteadySettings,
) -> Result<Kept, SweepError> {
    let case = model.case().at_speed(speed_rpm);
    let (mesh_hz, steps) = (case.mesh_frequency_hz, model.steps_per_cycle());
    let in_steps = |settings: &SteadySettings| one(model, chain, (case, case), from, settings);
    let Some(vibrations) = vibrations else { return in_steps(settings) };
    let choice = vibrations.resolved(mesh_hz, steps, settings.harmonics);
    if choice == Resolved::Times(1) {
        return in_steps(settings);
    }
    if settings.method == SteadyMethod::Shooting
        && let Some((multipliers, mode_type)) = vibrations.multipliers(mesh_hz)
    {
        let few = SteadySettings { most_cycles: settings.most_cycles.min(FEW), ..settings.clone() };
        if let Kept::Found { point, state } = in_steps(&few)?
            && point.is_steady
        {
            let point = Box::new(point.with_vibrations(multipliers, mode_type));
            return Ok(Kept::Found { point, state });
        }
    }
    let finer = match choice {
        Resolved::Times(1) | Resolved::Faster { times: 1, .. } => Some(model),
        Resolved::Times(times) | Resolved::Faster { times, .. } => {
            model.with_times_the_steps(times)?
        }
        Resolved::Needs { .. } => model.with_times_the_steps(2)?,
    };
    // A model with a fixed number of steps is marched with these.
    let Some(finer) = finer else { return in_steps(settings) };
    match choice {
        Resolved::Times(_) => one(finer, chain, (case, case), from, settings),
        Resolved::Faster { mesh_hz, .. } => {
            let faster = model.case().at_speed(mesh_hz / case.mesh_frequency_per_rpm_hz());
            one(finer, chain, (case, faster), from, settings)
        }
        Resolved::Needs { steps, most } => {
            let error = SweepError::TooFewSteps { steps, most };
            Ok(Kept::Failed(FailedPoint::new(&chain.name, case, error, Default::default())))
        }
    }
}

/// Most cycles in which a motion is looked for in steps that are longer than the vibrations need.
const FEW: usize = 16;

/// One steady state, tables laid out for more where the load outgrows them; a failed point if the march
/// fails. It is that at the speed asked for, computed at another one where that is given.
///
/// # Errors
/// If the set cannot be built, brought to rest or put into `state`: faults that do not depend on the speed.
fn one(
    model: &dyn SweepModel,
    chain: &Chain,
    (asked, case): (LoadCase, LoadCase),
    (start, state): (SearchStart, Option<&[f64]>),
    settings: &SteadySettings,
) -> Result<Kept, SweepError> {
    let computed_at_rpm = (case != asked).then_some(case.speed_rpm);
    // Once a set has been built and has a state to start from, larger tables may fail, but the set-up is sound.
    let has_started = Cell::new(false);
    let last = RefCell::default();
    let attempt = |size: usize| {
        let mut set = model.turning(&case, size)?;
        let steps = model.steps_per_cycle();
        let cycle = (model.first_planet_rad(), steps);
        match (state, start) {
            (Some(state), _) => set.restore(state)?,
            (None, SearchStart::Random(number)) => {
                start_at_random(set.as_mut(), model.shape(), cycle, number)?;
            }
            (None, _) => set.rest()?,
        }
        has_started.set(true);
        let found = steady(set.as_mut(), model.shape(), model.first_planet_rad(), steps, settings)?;
        if let Some(rest) = found.rest {
            rest.check()?;
        }
        let mut point = SweepPoint::new(case, &found, settings, size)?;
        if found.came_from == CameFrom::Given {
            point.start = start;
        }
        point.state.case = asked;
        point.computed_at_rpm = computed_at_rpm;
        Ok(Kept::Found { point: Box::new(point), state: set.state() })
    };
    let found = large_enough(|size| {
        attempt(size).inspect_err(|error: &SweepError| {
            last.replace((size, error.to_string()));
        })
    });
    match found {
        Err(error) if has_started.get() => {
            Ok(Kept::Failed(FailedPoint::new(&chain.name, asked, error, last.into_inner())))
        }
        other => other,
    }
}

#[cfg(test)]
mod tests;
