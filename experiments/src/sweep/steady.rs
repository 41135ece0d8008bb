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
}

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
    let between = match settings.between_cycles {
        0 => None,
        count => {
            before.march(set, first_planet_rad, steps * count)?;
            Some(before.between_harmonics(count)?)
        }
    };
    let rest = sampled_rest(set, &now, steps)?;
    Ok(Steady { record: now, cycles, residual, between, rest })
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
