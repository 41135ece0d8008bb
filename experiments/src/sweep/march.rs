//! Mesh cycles marched one after another, compared with those before.

use std::collections::VecDeque;

use super::error::SweepError;
use super::marching::Marching;
use super::record::Record;
use super::set_shape::SetShape;

/// Largest number of mesh cycles after which a motion is tested for repeating.
pub const MOST_REPEATS: usize = 8;

/// A motion repeats after several cycles only if its change over fewer, into which these divide, exceeds the
/// tolerance by this factor: transients that have nearly died out change within the tolerance over one cycle or
/// several.
const CLEARLY: f64 = 10.0;

/// Changes over several cycles within this factor of each other are alike: the fewest cycles count.
const ALIKE: f64 = 2.0;

/// A march from the start of a mesh cycle.
pub(super) struct March<'m> {
    pub(super) set: &'m mut dyn Marching,
    pub(super) shape: SetShape,
    pub(super) first_planet_rad: f64,
    pub(super) steps: usize,
    /// Cycles marched.
    pub(super) cycles: usize,
    /// The last of them, at most [`MOST_REPEATS`] + 1, the latest first.
    recent: VecDeque<Record>,
}

impl<'m> March<'m> {
    pub(super) fn new(
        set: &'m mut dyn Marching,
        shape: SetShape,
        first_planet_rad: f64,
        steps: usize,
    ) -> Self {
        Self { set, shape, first_planet_rad, steps, cycles: 0, recent: VecDeque::new() }
    }

    /// Forgets the cycles before a push or a restored state.
    pub(super) fn begin_anew(&mut self) {
        self.recent.clear();
    }

    /// One more cycle; the change to it from the one before.
    ///
    /// # Errors
    /// If a step fails.
    pub(super) fn advance(&mut self) -> Result<f64, SweepError> {
        let mut now = match self.recent.len() > MOST_REPEATS {
            true => self.recent.pop_back().unwrap_or_default(),
            false => Record::new(self.shape),
        };
        now.march(self.set, self.first_planet_rad, self.steps)?;
        self.recent.push_front(now);
        self.cycles += 1;
        Ok(self.change_over(1))
    }

    /// Change to the last cycle from that `count` cycles before.
    pub(super) fn change_over(&self, count: usize) -> f64 {
        match (self.recent.front(), self.recent.get(count)) {
            (Some(now), Some(before)) => now.change_from(before),
            _ => f64::INFINITY,
        }
    }

    /// Mesh cycles, 1 to [`MOST_REPEATS`], after which the motion comes nearest to repeating, and the change over
    /// them. Of numbers that are alike the least.
    pub(super) fn nearest_repeat(&self) -> (usize, f64) {
        let all: Vec<f64> = (1..=MOST_REPEATS).map(|count| self.change_over(count)).collect();
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let at = all.iter().position(|change| *change <= ALIKE * least).unwrap_or(0);
        (at + 1, all[at])
    }

    /// Mesh cycles after which the motion repeats within a tolerance; `None` if after none of 1 to [`MOST_REPEATS`].
    pub(super) fn repeats_after(&self, tolerance: f64) -> Option<usize> {
        let repeats = |count: &usize| {
            let mut fewer = (1..*count).filter(|fewer| count.is_multiple_of(*fewer));
            self.change_over(*count) <= tolerance
                && fewer.all(|fewer| self.change_over(fewer) > CLEARLY * tolerance)
        };
        (1..=MOST_REPEATS).find(repeats)
    }

    /// The last `count` cycles in order of time.
    pub(super) fn last(&self, count: usize) -> Record {
        let mut all = Record::new(self.shape);
        let cycles = self.recent.iter().take(count).rev();
        for (number, cycle) in cycles.enumerate() {
            match number {
                0 => all = cycle.clone(),
                _ => all.append(cycle.clone()),
            }
        }
        all
    }
}
