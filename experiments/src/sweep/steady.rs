//! Steady state by marching from cycle to cycle.

use fe_contact::statics::KinematicRest;
use serde::{Deserialize, Serialize};

use super::extrapolation::Extrapolation;
use super::marching::Marching;
use super::record::{Record, SUN};
use crate::error::ExperimentError;

/// When a march is over, and what is recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SteadySettings {
    /// Largest change from one cycle to the next of a steady state, relative to the largest peak-to-peak
    /// vibration.
    pub tolerance: f64,
    /// Cycles after which the march ends and is recorded although it is not steady.
    pub most_cycles: usize,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// Cycles on which the energy between harmonics is measured; 0 leaves that out.
    pub between_cycles: usize,
}

impl Default for SteadySettings {
    /// 1e-9 within 2,000 cycles, harmonics 1 to 5, energy between them over 16 cycles.
    fn default() -> Self {
        Self { tolerance: 1e-9, most_cycles: 2000, harmonics: 5, between_cycles: 16 }
    }
}

/// A set marched until its cycles repeat.
#[derive(Debug, Clone)]
pub struct Steady {
    /// The last cycle.
    pub record: Record,
    /// Cycles marched before those that are recorded.
    pub cycles: usize,
    /// Change from the last cycle but one to the last, relative as [`SteadySettings::tolerance`].
    pub residual: f64,
    /// Share of the vibration's energy that lies between mesh harmonics, if requested.
    pub between: Option<f64>,
    /// Kinematic rest at a sample of positions; `None` if the model has none.
    pub rest: Option<KinematicRest>,
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
}

/// Largest number of mesh cycles after which a motion is tested for repeating.
pub const MOST_REPEATS: usize = 8;

/// A motion is called subharmonic only if its change from one cycle to the next exceeds the tolerance by this
/// factor: transients that have nearly died out change within the tolerance over one cycle or several.
const CLEARLY: f64 = 10.0;

/// Number of positions of a mesh cycle at which exact kinematics are evaluated.
const SAMPLED: usize = 14;

/// Marches from the present state, which must be at the start of a mesh cycle, to the steady state.
///
/// # Errors
/// If a step fails.
pub fn steady(
    set: &mut dyn Marching,
    planets: usize,
    first_planet_rad: f64,
    steps: usize,
    settings: &SteadySettings,
) -> Result<Steady, ExperimentError> {
    let (mut now, mut before) = (Record::new(planets), Record::new(planets));
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
        let (period, watched) = period(set, planets, first_planet_rad, steps, settings.tolerance)?;
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
    Ok(Steady { record: now, cycles, residual, between, rest, repeats_after, further })
}

/// Number of mesh cycles (2 to [`MOST_REPEATS`]) after which a motion that is not steady repeats within the
/// tolerance, `None` if after none of these; and the cycles marched for one period or, without one, for
/// [`MOST_REPEATS`] cycles.
fn period(
    set: &mut dyn Marching,
    planets: usize,
    first_planet_rad: f64,
    steps: usize,
    tolerance: f64,
) -> Result<(Option<usize>, Record), ExperimentError> {
    // The first cycle is marched anew: a leap may lie between the last cycle of the march and the next.
    let mut first = Record::new(planets);
    first.march(set, first_planet_rad, steps)?;
    let mut watched = first.clone();
    let mut differs = false;
    for cycles in 1..=MOST_REPEATS {
        let mut next = Record::new(planets);
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

/// Kinematic rest over one more cycle, also relative to the sun's largest peak-to-peak motion over the
/// recorded cycle. This includes x and y, since the transmission error (rotation at the base circle) is small
/// at resonances of translational modes.
fn sampled_rest(
    set: &mut dyn Marching,
    record: &Record,
    steps: usize,
) -> Result<Option<KinematicRest>, ExperimentError> {
    if set.kinematic_rest().is_none() {
        return Ok(None);
    }
    let (mut largest, mut radius) = (0.0f64, 0.0);
    for step in 0..steps {
        set.step()?;
        if step % (steps / SAMPLED).max(1) != 0 {
            continue;
        }
        if let Some([rest, base_radius]) = set.kinematic_rest() {
            radius = base_radius;
            // NaN is kept.
            largest = if largest.is_nan() || largest >= rest { largest } else { rest };
        }
    }
    let [x, y, rotation] = SUN.map(|channel| record.range(channel));
    Ok(Some(KinematicRest::new(largest, x.max(y).max(radius * rotation))))
}
