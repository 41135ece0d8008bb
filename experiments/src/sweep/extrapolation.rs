//! Leaps of a march: where the last cycles are heading, by reduced-rank extrapolation.
//!
//! What a march has left decays by the few modes that are damped least, and contact that has settled makes the
//! map from cycle to cycle affine. A leap only chooses another state to march on from: a steady state is one by
//! the same change from cycle to cycle as without.

use dynamics::extrapolation_weights;

use super::marching::Marching;
use super::record::Record;
use crate::error::ExperimentError;

/// Cycles after a leap or the start before differences are collected: fast modes and contact settle first.
const PAUSE: usize = 4;

/// Differences that a leap takes: of three pairs of modes and one decay.
const WINDOW: usize = 7;

/// A leap has helped if, after the pause, the change from cycle to cycle is below this part of what it was.
/// Where many modes ring (steps far longer than their periods, at creeping speeds) it does not.
const HELPFUL: f64 = 0.3;

/// Leaps in vain after which a march goes on without.
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
    /// Takes note of a cycle, `now`, that began in the state `start` and followed `before`; leaps if it has seen
    /// enough.
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
        // The first cycle after a leap follows none.
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
                // Differences are of cycles: one state more stands at their ends than is weighed.
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
