//! Difference between linear kinematics about the mean loaded configuration and exact kinematics in
//! a result.

use crate::error::FeError;

/// Difference between exact and linear approaches of the loaded pairs of a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinematicRest {
    /// Largest difference of an approach from its linear form, m.
    pub largest: f64,
    /// The same divided by the sun's peak-to-peak motion; `None` where that is 0, as with a single
    /// position. At rest the motion is the transmission error; in time translation counts as well.
    pub share: Option<f64>,
}

/// Shares above which a result carries a warning (`WARNED`) or is refused (`REFUSED`), unless the
/// difference itself is at most the length given second (m).
const WARNED: (f64, f64) = (0.01, 1e-8);
const REFUSED: (f64, f64) = (0.1, 1e-7);

impl KinematicRest {
    /// From the largest difference and the sun's peak-to-peak motion (m).
    pub fn new(largest: f64, motion: f64) -> Self {
        let share = (motion != 0.0).then(|| largest / motion);
        Self { largest, share }
    }

    fn is_beyond(&self, (share, least): (f64, f64)) -> bool {
        // NaN is beyond every limit.
        let is_small = self.largest <= least || self.share.is_some_and(|own| own <= share);
        !is_small
    }

    /// Whether the result carries a warning.
    pub fn is_worth_a_warning(&self) -> bool {
        self.is_beyond(WARNED)
    }

    /// Refuses a result for which linear kinematics are not accurate enough.
    ///
    /// # Errors
    /// [`FeError::BeyondLinear`].
    pub fn check(&self) -> Result<(), FeError> {
        if self.is_beyond(REFUSED) {
            let rest_um = 1e6 * self.largest;
            return Err(FeError::BeyondLinear { rest_um, share: self.share });
        }
        Ok(())
    }
}

/// The largest of non-negative numbers; NaN if one of them is NaN.
pub(crate) fn larger(each: impl Iterator<Item = f64>) -> f64 {
    each.fold(0.0, |a, b| if a.is_nan() || a >= b { a } else { b })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_pass_and_large_ones_are_named() {
        assert!(!KinematicRest::new(0.0, 0.0).is_worth_a_warning());
        // A single position has no peak-to-peak motion, hence no share.
        let alone = KinematicRest::new(1e-12, 0.0);
        assert!(alone.share.is_none() && !alone.is_worth_a_warning());
        assert!(KinematicRest::new(1e-6, 0.0).check().is_err());
        // The transmission error of five planets may almost cancel: a difference of nanometres
        // needs no warning.
        assert!(!KinematicRest::new(5e-9, 1e-9).is_worth_a_warning());
        let warned = KinematicRest::new(0.05e-6, 2e-6);
        assert!(warned.is_worth_a_warning() && warned.check().is_ok());
        let refused = KinematicRest::new(1e-6, 2e-6).check().unwrap_err().to_string();
        assert!(refused.contains("dynamics.kinematics"), "{refused}");
        assert!(KinematicRest::new(f64::NAN, 1e-6).check().is_err());
    }
}
