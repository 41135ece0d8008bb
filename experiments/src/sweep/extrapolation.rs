//! Leaps of a march towards its steady state, by reduced-rank extrapolation from the last cycles.
//!
//! Once the contact pattern has settled, the map from the state at the start of a cycle to that of the next
//! is affine, and the deviation from the steady state decays in the few modes of least damping. A leap only
//! changes the state from which the march continues; the change from cycle to cycle that defines a steady
//! state is the same with and without leaps.

use dynamics::extrapolation_weights;

use super::marching::Marching;
use super::record::Record;
use crate::error::ExperimentError;

/// Cycles after a leap or the start before differences are collected: fast modes and contact settle first.
const PAUSE: usize = 4;

/// Number of differences used for a leap: two for each of three oscillating modes, and one for a decay.
const WINDOW: usize = 7;

/// A leap has helped if, after the pause, the change from cycle to cycle is below this share of that before
/// the leap. It does not help where many modes keep ringing, as at very low speeds, at which a time step is
/// far longer than their periods.
const HELPFUL: f64 = 0.3;

/// Number of leaps without success after which no more are tried.
const PATIENCE: usize = 2;

/// The last cycles of a march.
#[derive(Debug, Default)]
pub(super) struct Extrapolation {
    /// Cycles since the last leap.
    cycles: usize,
    /// State at the start of each cycle whose difference to the next is in `differences`.
    states: Vec<Vec<f64>>,
    differences: Vec<Vec<f64>>,
    /// Change from cycle to cycle, and the state, when the last leap was made.
    before_leap: Option<(f64, Vec<f64>)>,
    /// Leaps that did not help.
    vain: usize,
}

impl Extrapolation {
    /// Registers the cycle `now`, which began in the state `start` and followed the cycle `before`; makes a
    /// leap once enough differences are known.
    ///
    /// # Errors
    /// As [`Marching::restore`].
    pub(super) fn take(
        &mut self,
        set: &mut dyn Marching,
        start: Vec<f64>,
        now: &Record,
        before: &Record,
        residual: f64,
    ) -> Result<(), ExperimentError> {
        if self.vain >= PATIENCE {
            return Ok(());
        }
        self.cycles += 1;
        if self.cycles == PAUSE
            && let Some((earlier, mut state)) = self.before_leap.take()
            && residual.is_nan() | (residual > HELPFUL * earlier)
        {
            self.vain += 1;
            self.cycles = 0;
            let counters = set.counters();
            state[..counters].copy_from_slice(&set.state()[..counters]);
            return set.restore(&state);
        }
        // Cycles of the pause are not used.
        if self.cycles <= PAUSE {
            return Ok(());
        }
        self.differences.push(now.scaled_difference(before));
        self.states.push(start);
        if self.differences.len() < WINDOW {
            return Ok(());
        }
        if let Some(weights) = extrapolation_weights(&self.differences) {
            let here = set.state();
            let mut leap = here.clone();
            let counters = set.counters();
            for (i, value) in leap.iter_mut().enumerate().skip(counters) {
                // As many states as differences are weighted; the state after the last is not needed.
                *value = weights.iter().zip(&self.states).map(|(w, s)| w * s[i]).sum();
            }
            set.restore(&leap)?;
            self.before_leap = Some((residual, here));
        }
        self.cycles = 0;
        self.states.clear();
        self.differences.clear();
        Ok(())
    }
}
