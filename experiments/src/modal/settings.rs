//! Settings of an impulse test, and why they may be refused.

use dynamics::identify::Options;

use gearset::LoadCase;

use super::linear::Preload;

/// Fewest steps in the shortest period of the band: with fewer, average acceleration lengthens that
/// period by more than 5 % ((ωΔt)²/12).
const STEPS_IN_PERIOD: f64 = 8.0;

/// Most steps of one decay, to limit memory and time.
const MOST_STEPS: f64 = 1e5;

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
        let longest_s = 1.0 / (STEPS_IN_PERIOD * self.band_hz.1);
        if !(step_s > 0.0 && step_s <= longest_s) {
            return Err(SettingsError::Step { step_s, longest_s, highest_hz: self.band_hz.1 });
        }
        let duration_s = self.duration_s;
        if duration_s / step_s > MOST_STEPS {
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
