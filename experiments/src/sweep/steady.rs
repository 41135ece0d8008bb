//! Steady state by shooting, or by marching from cycle to cycle.

use dynamics::Multiplier;
use fe_contact::statics::KinematicRest;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::critical_motion::CriticalMotion;
use super::extrapolation::Extrapolation;
use super::marching::Marching;
use super::record::Record;
use super::rest_samples::RestSamples;
use super::set_shape::SetShape;
use super::shooting::{Shot, multipliers_of_next_cycle, shot};
use crate::error::ExperimentError;

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
        }
    }
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
    /// Floquet multipliers of size 1e-3 and above of a motion found by shooting, by descending size.
    pub multipliers: Vec<Multiplier>,
    /// How the perturbation moves whose multiplier is nearest in size to 1, of a motion found by shooting.
    pub critical: Option<CriticalMotion>,
    /// The last cycle.
    pub record: Record,
    /// Cycles marched, the last of which is recorded.
    pub cycles: usize,
    /// Change from the last cycle but one to the last, relative as [`SteadySettings::tolerance`]; of a motion found by
    /// shooting that from the last cycle to the one that follows it, to first order.
    pub residual: f64,
    /// Share of the vibration's energy that lies between mesh harmonics, if requested.
    pub between: Option<f64>,
    /// Kinematic rest at a sample of positions; `None` if the model has none.
    pub rest: Option<KinematicRest>,
    /// What may be left of the transient in the recorded cycle, of the vibration, by the Floquet multipliers of that cycle;
    /// `None` of a motion found by shooting, of one whose cycles change by 1e-6 or less, or without derivative.
    pub transient: Option<f64>,
    /// Number of mesh cycles after which the motion repeats within the tolerance: 1 for a steady state, 2 to
    /// [`MOST_REPEATS`] for a subharmonic response; `None` if it repeats after none of these.
    pub repeats_after: Option<usize>,
    /// The cycles after `record` over which contact is watched where the motion does not repeat from cycle
    /// to cycle: as many as it takes to repeat, or [`MOST_REPEATS`] if it does not.
    further: Option<Record>,
}

impl Steady {
    /// The cycles over which the lowest mesh forces, loss of contact and backside contact are counted: the
    /// last cycle of a steady state, otherwise all cycles of one period of the motion, or
    /// [`MOST_REPEATS`] cycles of a motion without period.
    pub fn watched(&self) -> &Record {
        self.further.as_ref().unwrap_or(&self.record)
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
    ) -> Result<Self, ExperimentError> {
        let (record, between, further) = match cycles {
            1 => (whole, None, None),
            _ => (whole.mean_cycle(cycles), Some(whole.between_harmonics(cycles)?), Some(whole)),
        };
        Ok(Self {
            method: SteadyMethod::Shooting,
            why_marched: None,
            derivatives: 1,
            multipliers,
            critical,
            record,
            cycles,
            residual,
            between,
            rest: None,
            transient: None,
            repeats_after: Some(cycles),
            further,
        })
    }
}

/// Largest number of mesh cycles after which a motion is tested for repeating.
pub const MOST_REPEATS: usize = 8;

/// A motion is called subharmonic only if its change from one cycle to the next exceeds the tolerance by this
/// factor: transients that have nearly died out change within the tolerance over one cycle or several.
const CLEARLY: f64 = 10.0;

/// Changes from cycle to cycle up to this leave no question of a transient: it would have to lose less than 1e-4 of itself
/// in a cycle to be 1 % of the vibration.
const SETTLED: f64 = 1e-6;

/// A multiplier beyond 1 by more than this means that the motion is unstable: without damping, multipliers are of
/// size 1 to rounding.
const UNSTABLE: f64 = 1e-6;

/// Finds the steady state near the present state, which must be at the start of a mesh cycle: by shooting, or by
/// marching where that is asked for or shooting finds no stable periodic motion.
///
/// # Errors
/// If a step fails.
pub fn steady(
    set: &mut dyn Marching,
    shape: impl Into<SetShape>,
    first_planet_rad: f64,
    steps: usize,
    settings: &SteadySettings,
) -> Result<Steady, ExperimentError> {
    let shape = shape.into();
    let mut why_marched = None;
    let mut shot_cycles = (0, 0);
    if settings.method == SteadyMethod::Shooting {
        if set.derivative().is_some() {
            let start = set.state();
            match shot(set, shape, first_planet_rad, steps, settings)? {
                Ok(found) if found.largest_multiplier() <= 1.0 + UNSTABLE => {
                    return Ok(found.into_steady());
                }
                Ok(found) => {
                    let largest = found.largest_multiplier();
                    shot_cycles = (found.cycles, found.derivatives);
                    why_marched = Some(format!(
                        "the periodic motion that shooting found is unstable: a multiplier of size {largest:.6}"
                    ));
                }
                Err(why) => why_marched = Some(why.to_string()),
            }
            set.restore(&start)?;
        } else {
            why_marched = Some("the model has no derivative of its steps".into());
        }
    }
    let mut found = march(set, shape, first_planet_rad, steps, settings)?;
    found.cycles += shot_cycles.0;
    found.derivatives = shot_cycles.1;
    found.why_marched = why_marched;
    Ok(found)
}

impl Shot {
    /// Size of the largest multiplier; 0 if all perturbations are gone after one cycle.
    fn largest_multiplier(&self) -> f64 {
        self.multipliers.first().map_or(0.0, |m| m.size())
    }

    fn into_steady(self) -> Steady {
        Steady {
            method: SteadyMethod::Shooting,
            why_marched: None,
            derivatives: self.derivatives,
            rest: self.rest,
            multipliers: self.multipliers,
            critical: self.critical,
            record: self.record,
            cycles: self.cycles,
            residual: self.residual,
            between: self.between,
            transient: None,
            repeats_after: Some(1),
            further: None,
        }
    }
}

/// What is left of a transient over the last change from cycle to cycle, at most: max |μ|/|μ − 1| over the Floquet
/// multipliers μ; infinite without decay.
pub fn left_of_transient(multipliers: &[Multiplier]) -> f64 {
    let left = |m: &Multiplier| m.size() / (m.re - 1.0).hypot(m.im);
    multipliers.iter().map(left).fold(0.0, f64::max)
}

/// Marches from the present state to the steady state.
fn march(
    set: &mut dyn Marching,
    shape: SetShape,
    first_planet_rad: f64,
    steps: usize,
    settings: &SteadySettings,
) -> Result<Steady, ExperimentError> {
    let (mut now, mut before) = (Record::new(shape), Record::new(shape));
    let (mut cycles, mut residual) = (0, f64::INFINITY);
    let mut ahead = Extrapolation::default();
    while residual > settings.tolerance && cycles < settings.most_cycles.max(2) {
        std::mem::swap(&mut now, &mut before);
        let start = set.state();
        now.march(set, first_planet_rad, steps)?;
        cycles += 1;
        residual = now.change_from(&before);
        if residual > settings.tolerance {
            ahead.take(set, start, &now, &before, residual)?;
        }
    }
    let (repeats_after, further) = if residual <= settings.tolerance {
        (Some(1), None)
    } else {
        let (period, watched) = period(set, shape, first_planet_rad, steps, settings.tolerance)?;
        (period, Some(watched))
    };
    let between = match settings.between_cycles {
        0 => None,
        count => {
            before.march(set, first_planet_rad, steps * count)?;
            Some(before.between_harmonics(count)?)
        }
    };
    let rest = sampled_rest(set, &now, steps)?;
    let is_question = residual > SETTLED && repeats_after == Some(1);
    let transient = match is_question {
        true => multipliers_of_next_cycle(set, shape, first_planet_rad, steps)?
            .map(|multipliers| residual * left_of_transient(&multipliers)),
        false => None,
    };
    Ok(Steady {
        method: SteadyMethod::Marching,
        why_marched: None,
        derivatives: 0,
        multipliers: Vec::new(),
        critical: None,
        record: now,
        cycles,
        residual,
        between,
        rest,
        transient,
        repeats_after,
        further,
    })
}

/// Number of mesh cycles (2 to [`MOST_REPEATS`]) after which a motion that is not steady repeats within the
/// tolerance, `None` if after none of these; and the cycles marched for one period or, without one, for
/// [`MOST_REPEATS`] cycles.
fn period(
    set: &mut dyn Marching,
    shape: SetShape,
    first_planet_rad: f64,
    steps: usize,
    tolerance: f64,
) -> Result<(Option<usize>, Record), ExperimentError> {
    // The first cycle is marched anew: a leap may lie between the last cycle of the march and the next.
    let mut first = Record::new(shape);
    first.march(set, first_planet_rad, steps)?;
    let mut watched = first.clone();
    let mut differs = false;
    for cycles in 1..=MOST_REPEATS {
        let mut next = Record::new(shape);
        next.march(set, first_planet_rad, steps)?;
        let change = next.change_from(&first);
        if cycles == 1 {
            differs = change > CLEARLY * tolerance;
        } else if differs && change <= tolerance {
            return Ok((Some(cycles), watched));
        }
        if cycles < MOST_REPEATS {
            watched.append(next);
        }
    }
    Ok((None, watched))
}

/// Kinematic rest over one more cycle.
fn sampled_rest(
    set: &mut dyn Marching,
    record: &Record,
    steps: usize,
) -> Result<Option<KinematicRest>, ExperimentError> {
    if set.loaded_step().is_none() {
        return Ok(None);
    }
    let mut rest = RestSamples::new(steps);
    for step in 0..steps {
        set.step()?;
        rest.take(set, step);
    }
    Ok(rest.rest(set, record))
}
