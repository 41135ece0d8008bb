//! What a sweep runs through: fixed chains of speeds.
//!
//! A chain starts from rest at its first speed and continues from each speed's steady state to the
//! next, or begins every speed from a random start. Chains know nothing of one another, so neither threads nor
//! interruptions change a result.

use serde::{Deserialize, Serialize};

use super::steady::SteadySettings;

/// Speeds in a chain unless said otherwise.
pub(super) const CHAIN: usize = 12;

/// Most speeds of a plan.
const MOST_SPEEDS: f64 = 100_000.0;

/// Which way the speed goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Speeds grow.
    Up,
    /// Speeds fall.
    Down,
}

/// Speeds that follow one another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Chain {
    /// `up_03`, `down_03`, `peak_1`, `random_02_00`: unlike that of any other chain.
    pub name: String,
    /// Speeds of the input member, rpm.
    pub speeds_rpm: Vec<f64>,
    /// Number of the random start from which every speed of it is searched; `None` where each goes on from the one
    /// before.
    #[serde(default)]
    pub random_start: Option<u32>,
}

/// Chains of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// When a steady state is one.
    pub steady: SteadySettings,
    /// Chains.
    pub chains: Vec<Chain>,
}

/// Why speeds make no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A speed that is none.
    #[error("a speed of {0:?} rpm: speeds must be finite and above 0, from {least} to {most:e} rpm",
        least = scene::SPEEDS_RPM[0], most = scene::SPEEDS_RPM[1])]
    Speed(f64),
    /// No speed between the ends.
    #[error(
        "speeds from {from} to {to} rpm: the range is empty, the first must not exceed the last"
    )]
    Empty {
        /// First, rpm.
        from: f64,
        /// Last, rpm.
        to: f64,
    },
    /// A step that leads nowhere.
    #[error("a step of {0} rpm: it must be finite and above 0")]
    Step(f64),
    /// More speeds than anyone could want.
    #[error("the step is too small: it makes {} speeds, at most 100,000 are allowed", count(.0))]
    TooMany(f64),
    /// No harmonic at all.
    #[error("0 harmonics: at least 1, at most 5 or, with at least 560 steps in a mesh cycle, 10")]
    NoHarmonic,
    /// Harmonics that the steps of a cycle do not resolve.
    #[error(
        "{harmonics} harmonics with {steps} steps in a mesh cycle: up to 5 with any, up to 10 with at least 560, none above (at a resonance of the highest average acceleration is {percent:.1} % off)"
    )]
    Harmonics {
        /// Harmonics asked for.
        harmonics: usize,
        /// Steps in a cycle.
        steps: usize,
        /// What it would be off, percent.
        percent: f64,
    },
}

/// Harmonic l over steps S in a mesh cycle at which a resonance is 1 % below its place: y/tan y = 0.99, y = πl/S.
const LARGEST_SHARE: f64 = 0.05508;

/// By how much average acceleration lowers the speed at which harmonic l excites a mode, %: with S steps in a cycle of
/// any length, a mode ω meets the harmonic where (2/h) atan(ωh/2) = 2πl/(Sh), which is y/tan y of ω, y = πl/S.
fn place_percent(harmonic: usize, steps: usize) -> f64 {
    let y = std::f64::consts::PI * harmonic as f64 / steps.max(1) as f64;
    // From two steps a period on the harmonic is none of the samples'.
    let part = if y < std::f64::consts::FRAC_PI_2 { y / y.tan() } else { 0.0 };
    100.0 * (1.0 - part)
}

impl SteadySettings {
    /// Refuses harmonics that the steps of a cycle do not resolve.
    ///
    /// # Errors
    /// [`PlanError::NoHarmonic`] for none, [`PlanError::Harmonics`] for too many.
    pub fn check(&self, steps: usize) -> Result<(), PlanError> {
        let harmonics = self.harmonics;
        if harmonics == 0 {
            return Err(PlanError::NoHarmonic);
        }
        if harmonics <= 5 || (harmonics <= 10 && steps >= 560) {
            return Ok(());
        }
        Err(PlanError::Harmonics { harmonics, steps, percent: place_percent(harmonics, steps) })
    }

    /// What to know before harmonics are read from this many steps in a mesh cycle; `None` if resonances of the highest
    /// of them are within 1 % of their place.
    pub fn caution(&self, steps: usize) -> Option<String> {
        let (harmonics, percent) = (self.harmonics, place_percent(self.harmonics, steps));
        (percent > 1.0).then(|| {
            let least = (harmonics as f64 / LARGEST_SHARE).ceil();
            format!(
                "with {steps} steps in a mesh cycle resonances that harmonic {harmonics} excites appear {percent:.1} % below \
                 their speed: for 1 % take at least {least} (`dynamics.steps_per_cycle`), or fewer harmonics"
            )
        })
    }
}

/// A number of speeds, which may be beyond any integer.
fn count(count: &f64) -> String {
    if *count < 1e9 { format!("{count:.0}") } else { format!("{count:.0e}") }
}

/// Even speeds from `from` to `to` (rpm), both included where the step meets them.
///
/// # Errors
/// [`PlanError`] for a range or a step that makes none.
pub fn even_speeds(from: f64, to: f64, step: f64) -> Result<Vec<f64>, PlanError> {
    for speed in [from, to] {
        if !scene::is_speed(speed) {
            return Err(PlanError::Speed(speed));
        }
    }
    if !(step > 0.0 && step.is_finite()) {
        return Err(PlanError::Step(step));
    }
    if from > to {
        return Err(PlanError::Empty { from, to });
    }
    let count = ((to - from) / step + 1e-9).floor() + 1.0;
    if count > MOST_SPEEDS {
        return Err(PlanError::TooMany(count));
    }
    Ok((0..count as usize).map(|i| from + i as f64 * step).collect())
}

impl Plan {
    /// Chains of twelve speeds each, in one direction.
    ///
    /// # Errors
    /// [`PlanError`] for no speed, or one that is none.
    pub fn new(
        speeds_rpm: &[f64],
        directions: &[Direction],
        steady: SteadySettings,
    ) -> Result<Self, PlanError> {
        if speeds_rpm.is_empty() {
            return Err(PlanError::Empty { from: f64::NAN, to: f64::NAN });
        }
        if let Some(bad) = speeds_rpm.iter().find(|s| !scene::is_speed(**s)) {
            return Err(PlanError::Speed(*bad));
        }
        let mut sorted = speeds_rpm.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        let mut chains = Vec::new();
        for direction in directions {
            let name = match direction {
                Direction::Up => "up",
                Direction::Down => "down",
            };
            for (k, part) in sorted.chunks(CHAIN).enumerate() {
                let mut speeds_rpm = part.to_vec();
                if *direction == Direction::Down {
                    speeds_rpm.reverse();
                }
                let name = format!("{name}_{k:02}");
                chains.push(Chain { name, speeds_rpm, random_start: None });
            }
        }
        Ok(Self { steady, chains })
    }

    /// The same with further chains, in which every speed is searched from each of `starts` random starts.
    pub fn with_random_starts(mut self, starts: u32) -> Self {
        let mut speeds: Vec<f64> =
            self.chains.iter().flat_map(|c| c.speeds_rpm.iter().copied()).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        for number in 1..=starts {
            for (k, part) in speeds.chunks(CHAIN).enumerate() {
                self.chains.push(Chain {
                    name: format!("random_{number:02}_{k:02}"),
                    speeds_rpm: part.to_vec(),
                    random_start: Some(number),
                });
            }
        }
        self
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.chains.iter().map(|c| c.speeds_rpm.len()).sum()
    }

    /// Chains of `count` even speeds about each of some centres (rpm), `span` (parts of the centre) to
    /// either side: the second manifest of a sweep.
    pub fn around(centres_rpm: &[f64], span: f64, count: usize, steady: SteadySettings) -> Self {
        let chain = |(k, centre): (usize, &f64)| {
            let at = |i: usize| 2.0 * i as f64 / (count.max(2) - 1) as f64 - 1.0;
            let speeds_rpm = (0..count).map(|i| centre * (1.0 + span * at(i))).collect();
            Chain { name: format!("peak_{k:02}"), speeds_rpm, random_start: None }
        };
        Self { steady, chains: centres_rpm.iter().enumerate().map(chain).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_hold_every_speed_once_a_direction() {
        let speeds = even_speeds(100.0, 2500.0, 100.0).unwrap();
        assert_eq!(speeds.len(), 25);
        let both = [Direction::Up, Direction::Down];
        let plan = Plan::new(&speeds, &both, SteadySettings::default()).unwrap();
        assert_eq!(plan.points(), 50);
        let mut names: Vec<&str> = plan.chains.iter().map(|c| c.name.as_str()).collect();
        names.dedup();
        assert_eq!(names.len(), plan.chains.len());
        assert_eq!(plan.chains[3].speeds_rpm[0], 1200.0);
    }

    #[test]
    fn ranges_that_are_none_are_refused() {
        assert!(matches!(even_speeds(500.0, 100.0, 10.0), Err(PlanError::Empty { .. })));
        assert!(matches!(even_speeds(-5.0, 100.0, 10.0), Err(PlanError::Speed(_))));
        assert!(matches!(even_speeds(5.0, 100.0, 0.0), Err(PlanError::Step(_))));
        assert!(matches!(even_speeds(5.0, 1e6, 1e-3), Err(PlanError::TooMany(_))));
        let ten = SteadySettings { harmonics: 10, ..SteadySettings::default() };
        assert!(ten.check(140).is_err() && ten.check(560).is_ok());
        let eleven = SteadySettings { harmonics: 11, ..SteadySettings::default() };
        assert!(eleven.check(5600).is_err());
    }
}
