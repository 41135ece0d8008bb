//! What shooting needs of a motion that is marched from period to period.

use super::derivative::MapDerivative;

/// A map of the state over one period, made of time steps.
pub trait PeriodMap {
    /// Why a period cannot be marched.
    type Error;

    /// Coordinates y at the start of the next period, n. They determine all that follows.
    fn coordinates(&mut self) -> Vec<f64>;

    /// Continues from other coordinates at the start of the same period.
    ///
    /// # Errors
    /// If they are no state of this motion.
    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), Self::Error>;

    /// Marches one period.
    ///
    /// # Errors
    /// If a step fails.
    fn advance(&mut self) -> Result<(), Self::Error>;

    /// The derivative of the map over the period marched last.
    ///
    /// # Errors
    /// If there is none.
    fn derivative(&mut self) -> Result<MapDerivative, Self::Error>;

    /// The same with errors of the order of 1e-4 of its size, if such a derivative costs less: corrections approach the
    /// solution almost as fast with it, as the error of each is that of the derivative times the correction (Kelley, SIAM
    /// Review 64, 2022).
    ///
    /// # Errors
    /// If there is none.
    fn rough_derivative(&mut self) -> Result<MapDerivative, Self::Error> {
        self.derivative()
    }

    /// Size of a deviation of the coordinates (n) relative to the peak-to-peak vibration over the last period.
    fn relative(&self, deviation: &[f64]) -> f64;

    /// Largest change of the last period from the one before it, relative to the peak-to-peak vibration;
    /// infinite unless the one followed the other.
    fn change(&self) -> f64;
}
