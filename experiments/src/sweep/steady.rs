//! A motion of a turning set that repeats, with what shows that it attracts.

use dynamics::Multiplier;
use fe_contact::statics::KinematicRest;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attraction::Attraction;
use super::critical_motion::CriticalMotion;
use super::error::SweepError;
use super::record::Record;

/// How a steady state is found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SteadyMethod {
    /// Newton's method for the periodic motion of the time steps. Where the model has no derivative, no periodic
    /// motion is found, or the one found is unstable, the motion is marched.
    #[default]
    Shooting,
    /// Marching until cycles repeat.
    Marching,
}

/// When a steady state is found, and what is recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SteadySettings {
    /// How it is found.
    #[serde(default)]
    pub method: SteadyMethod,
    /// Largest change from one cycle to the next of a steady state, relative to the largest peak-to-peak
    /// vibration.
    pub tolerance: f64,
    /// Cycles after which the march ends and is recorded although it is not steady.
    pub most_cycles: usize,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// Cycles on which the energy between harmonics of a marched motion is measured; 0 leaves that out. Of a
    /// motion found by shooting it is measured on the last cycle and the one that follows it.
    pub between_cycles: usize,
    /// Whether sets that are themselves after a part of the cycle are shot over whole cycles all the same. Motions that
    /// break the symmetry are then found too, and what the symmetry forbids is a result instead of a premise.
    #[serde(default)]
    pub whole_cycles: bool,
    /// Whether low speeds keep the steps of the scene although these are too long for the vibrations of the set.
    #[serde(default)]
    pub keeps_steps: bool,
}

impl Default for SteadySettings {
    /// Shooting to 1e-9 within 2,000 cycles, harmonics 1 to 5, energy between them over 16 cycles.
    fn default() -> Self {
        let method = SteadyMethod::Shooting;
        let (most_cycles, harmonics, between_cycles) = (2000, 5, 16);
        Self {
            method,
            tolerance: 1e-9,
            most_cycles,
            harmonics,
            between_cycles,
            whole_cycles: false,
            keeps_steps: false,
        }
    }
}

/// Where a search began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameFrom {
    /// At the state that it was given.
    Given,
    /// At rest, because none that attracts was found from there.
    Rest,
    /// At an unstable motion, pushed, for the same reason.
    Unstable,
}

/// A set whose cycles repeat, or one that was marched as long as allowed.
#[derive(Debug, Clone)]
pub struct Steady {
    /// How it was found.
    pub method: SteadyMethod,
    /// Why it was marched although shooting was asked for.
    pub why_marched: Option<String>,
    /// Derivatives of the cycle that shooting computed, those of a search without success included.
    pub derivatives: usize,
    /// Whether it attracts.
    pub attraction: Attraction,
    /// Where the search for it began.
    pub came_from: CameFrom,
    /// Floquet multipliers of size 1e-3 and above of one period, by descending size; none where the model has no
    /// derivative or the motion does not repeat.
    pub multipliers: Vec<Multiplier>,
    /// How the perturbation moves whose multiplier is nearest in size to 1.
    pub critical: Option<CriticalMotion>,
    /// The last cycle; of a motion that repeats after several, their mean.
    pub record: Record,
    /// Cycles marched.
    pub cycles: usize,
    /// Change from the last period but one to the last, relative as [`SteadySettings::tolerance`], of a motion
    /// that does not repeat from the last mesh cycle but one to the last; of a motion found by shooting that from
    /// the last period to the one that follows it, to first order.
    pub residual: f64,
    /// Share of the vibration's energy that lies between mesh harmonics, if requested.
    pub between: Option<f64>,
    /// Kinematic rest at a sample of positions; `None` if the model has none.
    pub rest: Option<KinematicRest>,
    /// What may be left of the transient in the recorded cycle, of the vibration, by the Floquet multipliers of that
    /// cycle;
    /// `None` of a motion found by shooting, of one whose cycles change by 1e-6 or less, or without derivative.
    pub transient: Option<f64>,
    /// Number of mesh cycles after which the motion repeats within the tolerance: 1 for a steady state, 2 to
    /// [`MOST_REPEATS`](super::MOST_REPEATS) for a subharmonic response; `None` if it repeats after none of these.
    pub repeats_after: Option<usize>,
    /// The cycles over which contact is watched where the motion does not repeat from cycle to cycle: as many as
    /// it takes to repeat, or [`MOST_REPEATS`](super::MOST_REPEATS) if it does not.
    pub(super) watched: Option<Record>,
}

impl Steady {
    /// The cycles over which the lowest mesh forces, loss of contact and backside contact are counted: the
    /// last cycle of a steady state, otherwise all cycles of one period of the motion, or
    /// [`MOST_REPEATS`](super::MOST_REPEATS) cycles of a motion without period.
    pub fn watched(&self) -> &Record {
        self.watched.as_ref().unwrap_or(&self.record)
    }

    /// A periodic motion of which one period of `cycles` mesh cycles was recorded. Its harmonics are those of the mean
    /// cycle.
    ///
    /// # Errors
    /// If the record is not finite.
    pub(crate) fn periodic(
        whole: Record,
        cycles: usize,
        multipliers: Vec<Multiplier>,
        critical: Option<CriticalMotion>,
        residual: f64,
    ) -> Result<Self, SweepError> {
        let (record, between, watched) = match cycles {
            1 => (whole, None, None),
            _ => (whole.mean_cycle(cycles), Some(whole.between_harmonics(cycles)?), Some(whole)),
        };
        Ok(Self {
            method: SteadyMethod::Shooting,
            why_marched: None,
            derivatives: 1,
            attraction: Attraction::by(&multipliers),
            came_from: CameFrom::Given,
            multipliers,
            critical,
            record,
            cycles,
            residual,
            between,
            rest: None,
            transient: None,
            repeats_after: Some(cycles),
            watched,
        })
    }
}

/// `[eq:transient-left]` What is left of a transient over the last change from cycle to cycle, at most: max
/// |μ|/|μ − 1| over the Floquet multipliers μ; infinite without decay.
///
/// Source: derived here.
/// Checked by: `tests/all/stability_command.rs::an_unfinished_transient_is_as_large_as_multipliers_say`.
pub fn left_of_transient(multipliers: &[Multiplier]) -> f64 {
    let left = |m: &Multiplier| m.size() / (m.re - 1.0).hypot(m.im);
    multipliers.iter().map(left).fold(0.0, f64::max)
}
