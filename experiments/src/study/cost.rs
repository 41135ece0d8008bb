//! Time as a ratio to a yardstick that is timed just before and just after.

use std::time::Instant;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tells the time.
pub trait Stopwatch: Send {
    /// Seconds since any fixed moment.
    fn seconds(&mut self) -> f64;
}

/// CPU time of the calling thread; where the system does not tell, elapsed time.
#[derive(Debug)]
pub struct CpuTime(Instant);

impl Default for CpuTime {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Stopwatch for CpuTime {
    fn seconds(&mut self) -> f64 {
        // The system brings a thread's account up to date when it may change threads.
        std::thread::yield_now();
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
        let nanoseconds = text.and_then(|t| t.split_whitespace().next()?.parse::<f64>().ok());
        nanoseconds.map_or_else(|| self.0.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
    }
}

/// Lower quartile, median, upper quartile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Quartiles {
    /// Lower quartile.
    pub low: f64,
    /// Median.
    pub median: f64,
    /// Upper quartile.
    pub high: f64,
}

impl Quartiles {
    /// Whether two ranges have values in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }
}

/// Quartiles of a list, interpolated between its members; NaN for an empty one.
pub fn quartiles(list: &[f64]) -> Quartiles {
    let mut sorted = list.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = share * sorted.len().saturating_sub(1) as f64;
        let (below, above) = (place.floor() as usize, place.ceil() as usize);
        match (sorted.get(below), sorted.get(above)) {
            (Some(a), Some(b)) => a + (place - place.floor()) * (b - a),
            _ => f64::NAN,
        }
    };
    Quartiles { low: at(0.25), median: at(0.5), high: at(0.75) }
}

/// Times of settings over those of the yardstick.
#[derive(Debug, Clone, PartialEq)]
pub struct Timings {
    /// By setting, then by part of its work (empty for a setting that fails), then by round: ratios to one unit of the
    /// yardstick.
    pub ratios: Vec<Vec<Vec<f64>>>,
    /// Every time of one unit of the yardstick, in order, s.
    pub yardsticks: Vec<f64>,
}

impl Timings {
    /// Median time of the yardstick in the last third of the run over that in the first third.
    pub fn drift(&self) -> f64 {
        let third = self.yardsticks.len().div_ceil(3);
        let (first, last) =
            (&self.yardsticks[..third], &self.yardsticks[self.yardsticks.len() - third..]);
        quartiles(last).median / quartiles(first).median
    }
}

/// Runs `count` settings in `rounds` rounds; the yardstick runs before the first and after every one. `timed` gives the
/// times of the parts of a setting's work (s, the same number in every round), `yardstick` the time of one unit (s). A
/// ratio is a time over the mean of the yardsticks just before and just after it.
///
/// # Errors
/// At the first run that fails.
pub fn interleaved<E>(
    rounds: usize,
    count: usize,
    mut yardstick: impl FnMut() -> Result<f64, E>,
    mut timed: impl FnMut(usize, usize) -> Result<Vec<f64>, E>,
) -> Result<Timings, E> {
    let mut ratios: Vec<Vec<Vec<f64>>> = vec![Vec::new(); count];
    let mut yardsticks = vec![yardstick()?];
    for round in 0..rounds {
        for (setting, own) in ratios.iter_mut().enumerate() {
            let before = yardsticks.last().copied().unwrap_or(f64::NAN);
            let times = timed(round, setting)?;
            let after = yardstick()?;
            yardsticks.push(after);
            own.resize(times.len(), Vec::new());
            for (list, time) in own.iter_mut().zip(times) {
                list.push(time / (0.5 * (before + after)));
            }
        }
    }
    Ok(Timings { ratios, yardsticks })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn quartiles_by_hand() {
        let found = quartiles(&[5.0, 1.0, 3.0, 2.0, 4.0]);
        assert_eq!((found.low, found.median, found.high), (2.0, 3.0, 4.0));
        assert_eq!(quartiles(&[1.0, 2.0]).median, 1.5);
        assert!(quartiles(&[]).median.is_nan());
        let of = |low, high| Quartiles { low, median: low, high };
        assert!(of(1.0, 2.0).overlaps(&of(2.0, 3.0)) && !of(1.0, 2.0).overlaps(&of(2.1, 3.0)));
    }

    /// A machine that becomes three times as slow during the run: settings of known cost, one unit of the yardstick
    /// each 1, 7 and 40, keep their ratios; against a yardstick timed once they would be off by more than half.
    #[test]
    fn a_machine_that_slows_down_moves_the_yardstick_and_not_the_ratios() {
        let (clock, rounds, costs) = (Cell::new(0.0f64), 9, [1.0, 7.0, 40.0]);
        let whole = rounds as f64 * costs.iter().sum::<f64>();
        let done = Cell::new(0.0f64);
        let work = |units: f64| {
            let start = clock.get();
            // The rate falls in proportion to what was done.
            for _ in 0..100 {
                clock.set(clock.get() + 0.01 * units * (1.0 + 2.0 * done.get() / whole));
                done.set(done.get() + 0.01 * units);
            }
            clock.get() - start
        };
        let yardstick = || Ok::<f64, ()>(work(1.0));
        let found = interleaved(rounds, 3, yardstick, |_, k| Ok(vec![work(costs[k])])).unwrap();
        for (own, cost) in found.ratios.iter().zip(costs) {
            assert!((quartiles(&own[0]).median / cost - 1.0).abs() < 0.01, "{cost}: {own:?}");
        }
        assert!(found.drift() > 1.5, "{}", found.drift());
        let last = found.ratios[2][0].last().unwrap() * found.yardsticks.last().unwrap();
        assert!(last / found.yardsticks[0] > 1.5 * costs[2]);
    }
}
