//! How far linear kinematics about the mean loaded configuration are from exact ones in a result.

use crate::error::FeError;

/// What exact kinematics, evaluated on a result, make of the approaches of its loaded pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinematicRest {
    /// Largest difference of an approach from its linear form, m.
    pub largest: f64,
    /// The same in parts of the transmission error's peak-to-peak value.
    pub share: f64,
}

/// From this share on a result carries a warning, from that one on it is refused, unless the difference
/// itself is below the length (m) beside it.
const WARNED: (f64, f64) = (0.01, 1e-8);
const REFUSED: (f64, f64) = (0.1, 1e-7);

impl KinematicRest {
    /// From the largest difference and the transmission error's peak-to-peak value (m).
    pub fn new(largest: f64, transmission_error: f64) -> Self {
        let share = if largest == 0.0 { 0.0 } else { largest / transmission_error };
        Self { largest, share }
    }

    fn is_beyond(&self, (share, least): (f64, f64)) -> bool {
        // What is no number is beyond everything.
        let is_small = self.largest <= least || self.share <= share;
        !is_small
    }

    /// Whether the result carries a warning.
    pub fn is_worth_a_warning(&self) -> bool {
        self.is_beyond(WARNED)
    }

    /// Refuses results that linear kinematics do not give.
    ///
    /// # Errors
    /// [`FeError::BeyondLinear`].
    pub fn check(&self) -> Result<(), FeError> {
        if self.is_beyond(REFUSED) {
            let (rest_um, percent) = (1e6 * self.largest, 100.0 * self.share);
            return Err(FeError::BeyondLinear { rest_um, percent });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_pass_and_large_ones_are_named() {
        assert!(!KinematicRest::new(0.0, 0.0).is_worth_a_warning());
        // Five planets may cancel their transmission error: nanometres are no matter.
        assert!(!KinematicRest::new(5e-9, 1e-9).is_worth_a_warning());
        let warned = KinematicRest::new(0.05e-6, 2e-6);
        assert!(warned.is_worth_a_warning() && warned.check().is_ok());
        let refused = KinematicRest::new(1e-6, 2e-6).check().unwrap_err().to_string();
        assert!(refused.contains("dynamics.kinematics"), "{refused}");
        assert!(KinematicRest::new(f64::NAN, 1e-6).check().is_err());
    }
}
