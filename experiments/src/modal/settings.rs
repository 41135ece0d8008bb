//! Settings of an impulse test, and why they may be refused.

use dynamics::identify::Options;

use scene::LoadCase;

use super::linear::Preload;

/// Fewest steps in the shortest period of the band: with fewer, average acceleration lengthens that
/// period by more than 5 % ((ωΔt)²/12).
const STEPS_IN_PERIOD: f64 = 8.0;

/// Most steps of one decay, to limit memory and time.
const MOST_STEPS: f64 = 1e5;

/// Step (s) and band (Hz) whose product the default step of any band has: 67 steps in the shortest period, so that
/// average acceleration lowers the highest frequency by 0.07 %.
const STEP_AT_3_KHZ: f64 = 5e-6 * 3000.0;

/// Periods of the lowest mode of the band in a decay by default.
const PERIODS: f64 = 30.0;

/// Length of a decay by default where that is longer than the periods, s.
const USUAL_DURATION_S: f64 = 0.04;

/// Periods of the lowest mode that are left where a decay of the default length would have too many steps.
const FEWEST_PERIODS: f64 = 20.0;

/// Neighbouring frequencies with at least this ratio have a gap between them at which a band may end.
const GAP: f64 = 1.5;

/// Highest over lowest frequency of a band by default: a wider one needs more steps than a decay may have.
const WIDEST: f64 = 40.0;

/// Poles that differ by less than this part of them are one repeated pole. Without noise those of equally spaced
/// planets differ by 1e-8, and modes 3e-4 apart are told apart.
const SAME_POLE: f64 = 1e-6;

/// Modes below this are rigid-body motion, Hz.
const RIGID_HZ: f64 = 1.0;

/// Band of an impulse test that covers the lower half of some natural frequencies (Hz, in any order) and goes on
/// to the next gap of a factor 1.5: from half the lowest to the geometric mean of the last frequency within and
/// the next, or 1.4 times the last if the next is farther. Rigid-body motion is left out. `None` without a mode.
pub fn band_of(frequencies_hz: &[f64]) -> Option<(f64, f64)> {
    let mut list: Vec<f64> = frequencies_hz.iter().copied().filter(|f| *f > RIGID_HZ).collect();
    list.sort_by(f64::total_cmp);
    let lowest = *list.first()?;
    let half = list.len().div_ceil(2);
    let is_end = |k: &usize| list.get(k + 1).is_none_or(|next| *next > GAP * list[*k]);
    let mut last = (half - 1..list.len()).find(is_end).unwrap_or(list.len() - 1);
    while list[last] > WIDEST * lowest {
        last -= 1;
    }
    let next = list.get(last + 1).copied().unwrap_or(f64::INFINITY);
    Some((0.5 * lowest, list[last] * (next / list[last]).sqrt().min(1.4)))
}

/// Settings of an impulse test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpulseSettings {
    /// Torque and position of the standing set, and the time step.
    pub preload: Preload,
    /// Length of each decay, s.
    pub duration_s: f64,
    /// Wanted largest change of a mesh force by a pulse, relative to the largest mesh force.
    pub size: f64,
    /// Band in which modes are identified, Hz.
    pub band_hz: (f64, f64),
    /// Steps of the trial that determines the force of a pulse, and of the response to half the pulse.
    pub trial_steps: usize,
    /// Whether only the first of several similar pulses is applied, to save time with costly bodies.
    pub is_short: bool,
}

/// Why settings of an impulse test are refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// No torque.
    #[error("0 N·m: nothing touches, so there is no preload to linearise about or to push from")]
    NoTorque,
    /// A torque that is not finite.
    #[error("{0} N·m: allowed is a finite torque other than 0; clockwise if negative")]
    Torque(f64),
    /// A position outside the mesh cycle.
    #[error("{0}: allowed is a position in the mesh cycle, from 0 to 1")]
    Position(f64),
    /// A band without width, or with an end that is no frequency.
    #[error(
        "{low} to {high} Hz: allowed are finite frequencies above 0, the first below the second"
    )]
    Band {
        /// Lowest frequency, Hz.
        low: f64,
        /// Highest frequency, Hz.
        high: f64,
    },
    /// A time step that is not positive, or too long for the upper end of the band.
    #[error(
        "{} µs: allowed is a step above 0, at most {} µs, so that the shortest period of the band ({} Hz) has {STEPS_IN_PERIOD} steps",
        shown(1e6 * step_s), shown(1e6 * longest_s), highest_hz
    )]
    Step {
        /// The step, s.
        step_s: f64,
        /// The longest allowed, s.
        longest_s: f64,
        /// Upper end of the band, Hz.
        highest_hz: f64,
    },
    /// Decays too short for an identification.
    #[error(
        "{} ms: identification in steps of {} µs needs records of at least {} ms",
        shown(1e3 * duration_s), shown(1e6 * step_s), shown(1e3 * least_s)
    )]
    Duration {
        /// The duration, s.
        duration_s: f64,
        /// The step, s.
        step_s: f64,
        /// The shortest allowed, s.
        least_s: f64,
    },
    /// Decays too long.
    #[error(
        "{} ms: in steps of {} µs allowed are at most {MOST_STEPS} steps, {} ms",
        shown(1e3 * duration_s), shown(1e6 * step_s), shown(1e3 * MOST_STEPS * step_s)
    )]
    Steps {
        /// The duration, s.
        duration_s: f64,
        /// The step, s.
        step_s: f64,
    },
}

/// A number above 0 rounded to two digits, which people can read.
fn two_digits(x: f64) -> f64 {
    let digit = 10f64.powf(x.log10().floor() - 1.0);
    (x / digit).round() * digit
}

/// A number with at most six decimal places; very small and very large ones in exponent notation.
fn shown(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) {
        return format!("{x:e}");
    }
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

impl ImpulseSettings {
    /// Settings at a preload: decays of 40 ms in steps of 5 µs, modes between 400 and 3000 Hz.
    pub fn at(load: LoadCase, position: f64) -> Self {
        Self {
            preload: Preload { load, position, step_s: 5e-6 },
            duration_s: 0.04,
            size: 2e-4,
            band_hz: (400.0, 3000.0),
            trial_steps: 400,
            is_short: false,
        }
    }

    /// Settings at a preload for another band: the step follows its upper end, the decay its lower one.
    pub fn in_band(load: LoadCase, position: f64, band_hz: (f64, f64)) -> Self {
        let (low, high) = band_hz;
        let step_s = two_digits(STEP_AT_3_KHZ / high);
        // The lowest mode lies at twice the lower end (see [`band_of`]).
        let periods = |count: f64| count / (2.0 * low);
        let most_s = periods(FEWEST_PERIODS).max(MOST_STEPS * step_s);
        let duration_s = two_digits(USUAL_DURATION_S.max(periods(PERIODS)).min(most_s));
        let preload = Preload { load, position, step_s };
        Self { preload, duration_s, band_hz, ..Self::at(load, position) }
    }

    /// The same for bodies with every FE degree of freedom: 10 ms, and only the pulses needed to excite all
    /// modes.
    pub fn short(load: LoadCase, position: f64) -> Self {
        Self { duration_s: 0.01, trial_steps: 60, is_short: true, ..Self::at(load, position) }
    }

    /// Whether the pulse of this name belongs to the test.
    pub(super) fn takes(&self, pulse: &str) -> bool {
        let left_out = ["carrier y force", "planets tangentially"];
        !self.is_short || !left_out.iter().any(|name| pulse.starts_with(name))
    }

    /// Steps of each decay.
    pub fn steps(&self) -> usize {
        (self.duration_s / self.preload.step_s).round().max(1.0) as usize
    }

    /// Checks torque, position, step and duration.
    ///
    /// # Errors
    /// If torque, position, step or duration cannot be used.
    pub fn check(&self) -> Result<(), SettingsError> {
        let Preload { load, position, step_s } = self.preload;
        let torque_nm = load.sun_torque_nm;
        if torque_nm == 0.0 {
            return Err(SettingsError::NoTorque);
        }
        if !torque_nm.is_finite() {
            return Err(SettingsError::Torque(torque_nm));
        }
        if !(0.0..=1.0).contains(&position) {
            return Err(SettingsError::Position(position));
        }
        let (low, high) = self.band_hz;
        if !(low > 0.0 && low < high && high.is_finite()) {
            return Err(SettingsError::Band { low, high });
        }
        let longest_s = 1.0 / (STEPS_IN_PERIOD * self.band_hz.1);
        if !(step_s > 0.0 && step_s <= longest_s) {
            return Err(SettingsError::Step { step_s, longest_s, highest_hz: self.band_hz.1 });
        }
        let duration_s = self.duration_s;
        if duration_s / step_s >= MOST_STEPS + 0.5 {
            return Err(SettingsError::Steps { duration_s, step_s });
        }
        // For a single input, which needs the longest records.
        let needed = self.identification().samples_needed(step_s, 1);
        if !duration_s.is_finite() || self.steps() < needed {
            let least_s = needed as f64 * step_s;
            return Err(SettingsError::Duration { duration_s, step_s, least_s });
        }
        Ok(())
    }

    /// Options of the identification, except the scale of the records.
    pub(super) fn identification(&self) -> Options {
        let mut options = Options::new(self.band_hz, self.stride());
        // Some pulse excites every mode; far weaker ones are rounding.
        options.weakest = 1e-3;
        options.tolerances.repeated = SAME_POLE;
        options
    }

    /// Decimation that leaves at least 2.7 samples per shortest period of the band.
    fn stride(&self) -> usize {
        let wanted = 1.0 / (2.7 * self.band_hz.1 * self.preload.step_s);
        (wanted.floor() as usize).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(change: impl Fn(&mut ImpulseSettings)) -> SettingsError {
        let mut settings = ImpulseSettings::at(LoadCase::standing(1130.0), 0.0);
        change(&mut settings);
        settings.check().unwrap_err()
    }

    #[test]
    fn the_band_follows_the_modes_and_step_and_decay_follow_the_band() {
        // OH-58 with four planets, linearised: a gap of a factor 3 above 2.2 kHz.
        let oh58 = [775.0, 783.0, 1154.0, 1691.0, 1707.0, 1717.0, 1764.0, 2152.0, 2157.0];
        let mut all = oh58.to_vec();
        all.extend([0.0, 6900.0, 7100.0, 7200.0, 7500.0, 9000.0, 11e3, 12e3, 14e3]);
        let (low, high) = band_of(&all).unwrap();
        assert_eq!(low, 387.5);
        assert!((high - 1.4 * 2157.0).abs() < 1e-9);
        let settings = ImpulseSettings::in_band(LoadCase::standing(1130.0), 0.0, (low, high));
        assert_eq!(settings.check(), Ok(()));
        assert!((settings.preload.step_s - 5.0e-6).abs() < 1e-12);
        assert!((settings.duration_s - 0.04).abs() < 2e-3);
        // A soft set: its lowest pair is far below the others, and all of the lower half is there.
        let (low, high) = band_of(&[94.0, 94.0, 622.0, 700.0, 1500.0, 5000.0]).unwrap();
        assert!(low < 94.0 && high > 700.0 && high < 1500.0);
        let soft = ImpulseSettings::in_band(LoadCase::standing(1130.0), 0.0, (low, high));
        assert_eq!(soft.check(), Ok(()));
        assert!(soft.duration_s > 0.3 && soft.preload.step_s > 1e-5);
        // Whatever a set's frequencies, the settings are allowed.
        for spread in [1.01, 1.4, 1.6, 1.9, 2.5, 3.0, 10.0, 100.0] {
            for lowest in [20.0, 776.0, 1100.0, 5000.0] {
                let list: Vec<f64> = (0..12).map(|k| lowest * f64::powi(spread, k)).collect();
                let band = band_of(&list).unwrap();
                let settings = ImpulseSettings::in_band(LoadCase::standing(1.0), 0.0, band);
                assert_eq!(settings.check(), Ok(()), "{spread}: {band:?}");
                let periods = settings.duration_s * lowest;
                assert!(periods > 0.9 * FEWEST_PERIODS, "{spread}: {periods} periods");
            }
        }
        // OH-58 with eight modes of each body: more than 100,000 of its steps in 40 ms.
        let many = ImpulseSettings::in_band(LoadCase::standing(1413.0), 0.0, (388.0, 39e3));
        assert_eq!((many.check(), many.duration_s), (Ok(()), 0.038));
        assert_eq!(band_of(&[0.0, 0.3]), None);
        for band_hz in [(0.0, 1.0), (5.0, 5.0), (f64::NAN, 2.0), (1.0, f64::INFINITY)] {
            let found = refusal(|s| s.band_hz = band_hz);
            assert!(matches!(found, SettingsError::Band { .. }), "{found}");
        }
    }

    #[test]
    fn settings_that_make_no_sense_are_refused() {
        assert_eq!(ImpulseSettings::at(LoadCase::standing(-1130.0), 0.5).check(), Ok(()));
        assert_eq!(refusal(|s| s.preload.load = LoadCase::standing(0.0)), SettingsError::NoTorque);
        for torque in [f64::NAN, f64::INFINITY] {
            let found = refusal(|s| s.preload.load = LoadCase::standing(torque));
            assert!(matches!(found, SettingsError::Torque(_)), "{found}");
        }
        for position in [f64::NAN, -0.1, 1.1] {
            let found = refusal(|s| s.preload.position = position);
            assert!(matches!(found, SettingsError::Position(_)), "{found}");
        }
        for step in [f64::NAN, -5e-6, 0.0, 42e-6, f64::INFINITY] {
            let found = refusal(|s| s.preload.step_s = step);
            assert!(matches!(found, SettingsError::Step { .. }), "{found}");
        }
        for duration in [f64::NAN, -1.0, 0.0, 1e-3] {
            let found = refusal(|s| s.duration_s = duration);
            assert!(matches!(found, SettingsError::Duration { .. }), "{found}");
        }
        for duration in [0.6, f64::INFINITY] {
            let found = refusal(|s| s.duration_s = duration);
            assert!(matches!(found, SettingsError::Steps { .. }), "{found}");
        }
        // The shortest step above 0.
        let found = refusal(|s| s.preload.step_s = f64::MIN_POSITIVE);
        assert!(matches!(found, SettingsError::Steps { .. }), "{found}");
    }

    /// The shortest duration named in the refusal is one that is allowed.
    #[test]
    fn the_shortest_duration_named_is_allowed() {
        for step_s in [1e-6, 5e-6, 20e-6, 41e-6] {
            let mut settings = ImpulseSettings::at(LoadCase::standing(1130.0), 0.0);
            (settings.preload.step_s, settings.duration_s) = (step_s, 1e-4);
            let found = settings.check().unwrap_err();
            let SettingsError::Duration { least_s, .. } = found else { panic!("{found}") };
            settings.duration_s = least_s;
            assert_eq!(settings.check(), Ok(()));
        }
    }
}
