//! Whether motions near a periodic motion come to it, and what showed it.

use std::collections::VecDeque;

use dynamics::{Multiplier, MultiplierKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A largest multiplier within this distance of 1 in size is 1 to rounding, as without damping.
const NEUTRAL: f64 = 1e-6;

/// Cycles over which the largest change from cycle to cycle is taken: beats of two decaying motions are shorter.
const WINDOW: usize = 8;

/// Windows, one after another, in which that largest change has to fall.
const WINDOWS: usize = 3;

/// Least ratio of the largest to the last change from cycle to cycle that counts as a decay.
const FALLEN: f64 = 1e3;

/// Whether motions near a motion come to it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Attraction {
    /// They do: all Floquet multipliers of one period are smaller than 1 in size.
    ByMultipliers,
    /// They do: changes from cycle to cycle have fallen until the end of the march. For models without derivative.
    ByDecay,
    /// They do not: a multiplier is larger than 1 in size.
    Repels,
    /// They neither come nor go: the largest multiplier is 1 in size to rounding, as without damping.
    Neutral,
    /// Nothing was shown: the motion does not repeat, or has not settled.
    #[default]
    NotShown,
}

impl Attraction {
    /// By the multipliers of one period, the largest first.
    pub(crate) fn by(multipliers: &[Multiplier]) -> Self {
        let beyond = multipliers.first().map_or(0.0, |m| m.size()) - 1.0;
        match beyond {
            b if b < -NEUTRAL => Self::ByMultipliers,
            b if b <= NEUTRAL => Self::Neutral,
            _ => Self::Repels,
        }
    }

    /// Whether it was shown that motions near come to it.
    pub fn is_shown(self) -> bool {
        matches!(self, Self::ByMultipliers | Self::ByDecay)
    }

    /// As tables print it.
    pub fn name(self) -> &'static str {
        match self {
            Self::ByMultipliers => "by_multipliers",
            Self::ByDecay => "by_decay",
            Self::Repels => "repels",
            Self::Neutral => "neutral",
            Self::NotShown => "not_shown",
        }
    }
}

/// Name of the way in which stability is lost where a multiplier leaves the unit circle.
pub(super) fn multiplier_kind(multiplier: Multiplier) -> &'static str {
    match multiplier.kind() {
        MultiplierKind::Fold => "fold",
        MultiplierKind::PeriodDoubling => "period_doubling",
        MultiplierKind::NeimarkSacker => "neimark_sacker",
    }
}

/// Changes from cycle to cycle of a march.
#[derive(Debug, Default)]
pub(super) struct Decay {
    largest: f64,
    last: VecDeque<f64>,
}

impl Decay {
    /// Registers the change to one more cycle.
    pub(super) fn add(&mut self, change: f64) {
        if change.is_finite() {
            self.largest = self.largest.max(change);
        }
        if self.last.len() == WINDOW * WINDOWS {
            self.last.pop_front();
        }
        self.last.push_back(change);
    }

    /// Whether the march has begun so far from its end that a decay could be seen.
    pub(super) fn is_visible(&self) -> bool {
        self.largest > FALLEN * self.last.back().copied().unwrap_or(f64::INFINITY)
    }

    /// Whether changes have fallen by [`FALLEN`] and were falling from window to window at the end, or are gone to
    /// rounding.
    pub(super) fn is_shown(&self, rounding: f64) -> bool {
        let all: Vec<f64> = self.last.iter().copied().collect();
        let tops: Vec<f64> =
            all.chunks(WINDOW).map(|window| window.iter().copied().fold(0.0, f64::max)).collect();
        let falls = tops.len() == WINDOWS
            && all.len() == WINDOW * WINDOWS
            && tops.windows(2).all(|pair| pair[1] < pair[0] || pair[1] <= rounding);
        self.is_visible() && falls
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decay(changes: impl Iterator<Item = f64>) -> Decay {
        let mut decay = Decay::default();
        changes.for_each(|change| decay.add(change));
        decay
    }

    #[test]
    fn beats_that_decay_are_a_decay_and_growth_is_none() {
        let beat = |k: i32, rate: f64| rate.powi(k) * (0.6 + 0.4 * (1.9 * f64::from(k)).cos());
        assert!(decay((0..200).map(|k| beat(k, 0.9))).is_shown(1e-13));
        // A motion that left an unstable one again, and one that began where it ended.
        let leaving = (0..100).map(|k| beat(k, 0.8)).chain((0..60).map(|k| beat(100 - k, 0.8)));
        assert!(!decay(leaving).is_shown(1e-13));
        assert!(!decay((0..200).map(|_| 1e-12)).is_visible());
    }

    #[test]
    fn multipliers_of_size_one_are_neither() {
        let by = |re: f64| Attraction::by(&[Multiplier { re, im: 0.0 }]);
        assert_eq!(by(0.999), Attraction::ByMultipliers);
        assert_eq!(by(-1.0 - 1e-9), Attraction::Neutral);
        assert_eq!(by(1.001), Attraction::Repels);
        assert_eq!(Attraction::by(&[]), Attraction::ByMultipliers);
    }
}
