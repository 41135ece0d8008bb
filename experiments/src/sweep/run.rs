//! Runs a plan: chains side by side, points kept as soon as they are there.

use std::collections::BTreeMap;
use std::sync::Mutex;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::judge::peak_centres;
use super::plan::{Chain, Plan};
use super::point::{SweepPoint, TableRow};
use super::state::SteadyState;
use super::steady::{SteadySettings, steady};
use super::sweep_model::SweepModel;
use crate::error::ExperimentError;
use crate::table_growth::large_enough;

/// A finished point with the state its chain goes on from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// The point.
    pub point: SweepPoint,
    /// State after it.
    pub state: Vec<f64>,
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
}

impl Sweep {
    /// All points by speed.
    pub fn points(&self) -> Vec<&SweepPoint> {
        let mut all: Vec<&SweepPoint> = self.chains.iter().flat_map(|(_, list)| list).collect();
        all.sort_by(|a, b| a.state.case.speed_rpm.total_cmp(&b.state.case.speed_rpm));
        all
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
        let centres = peak_centres(&self.states(), steady.harmonics, least, span);
        Plan::around(&centres, span, count, steady)
    }

    /// The tidy table.
    pub fn rows(&self, scene: &str) -> impl Iterator<Item = TableRow> {
        self.chains.iter().flat_map(move |(chain, points)| {
            points.iter().flat_map(move |p| {
                p.state.lines.iter().map(move |line| TableRow {
                    scene: scene.to_owned(),
                    fidelity: self.fidelity.clone(),
                    torque_nm: p.state.case.sun_torque_nm,
                    speed_rpm: p.state.case.speed_rpm,
                    mesh_frequency_hz: p.state.case.mesh_frequency_hz,
                    chain: chain.clone(),
                    body: line.part.name(),
                    coordinate: line.coordinate.name().to_owned(),
                    harmonic: line.harmonic,
                    amplitude: line.amplitude,
                    unit: line.coordinate.unit().to_owned(),
                    phase_rad: line.phase_rad,
                    cycles: p.cycles,
                    residual: p.residual,
                })
            })
        })
    }
}

/// Runs every chain of a plan; `done` hears of each point, finished now or before.
///
/// # Errors
/// If a point fails or cannot be kept; finished points stay kept.
pub fn run(
    model: &dyn SweepModel,
    plan: &Plan,
    store: &dyn PointStore,
    done: &(dyn Fn(&SweepPoint) + Sync),
) -> Result<Sweep, ExperimentError> {
    plan.steady.check(model.steps_per_cycle())?;
    let found: Mutex<BTreeMap<usize, Vec<SweepPoint>>> = Mutex::default();
    plan.chains.par_iter().enumerate().try_for_each(|(k, chain)| {
        let mut points = Vec::with_capacity(chain.speeds_rpm.len());
        let mut state: Option<Vec<f64>> = None;
        for (index, speed) in chain.speeds_rpm.iter().enumerate() {
            let kept = match store.load(chain, index)? {
                Some(kept) => kept,
                None => {
                    let kept = one(model, *speed, state.as_deref(), &plan.steady)?;
                    store.save(chain, index, &kept)?;
                    kept
                }
            };
            done(&kept.point);
            points.push(kept.point);
            state = Some(kept.state);
        }
        if let Ok(mut all) = found.lock() {
            all.insert(k, points);
        }
        Ok::<(), ExperimentError>(())
    })?;
    let found = found.into_inner().unwrap_or_default();
    let chains = plan.chains.iter().map(|c| c.name.clone()).zip(found.into_values()).collect();
    Ok(Sweep { fidelity: model.name(), chains })
}

/// One steady state, tables laid out for more where the load outgrows them.
fn one(
    model: &dyn SweepModel,
    speed_rpm: f64,
    state: Option<&[f64]>,
    settings: &SteadySettings,
) -> Result<Kept, ExperimentError> {
    let case = model.case().at_speed(speed_rpm);
    large_enough(|size| {
        let mut set = model.turning(&case, size)?;
        match state {
            Some(state) => set.restore(state)?,
            None => set.rest()?,
        }
        let steps = model.steps_per_cycle();
        let found =
            steady(set.as_mut(), model.planets(), model.first_planet_rad(), steps, settings)?;
        if let Some(rest) = found.rest {
            rest.check()?;
        }
        let point = SweepPoint::new(case, &found, settings, size)?;
        Ok(Kept { point, state: set.state() })
    })
}
