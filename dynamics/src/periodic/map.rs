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
    /// solution almost as fast with it, as the error of each is that of the derivative times the correction (Kelley,
    /// SIAM Review 64, 2022).
    ///
    /// # Errors
    /// If there is none.
    fn rough_derivative(&mut self) -> Result<MapDerivative, Self::Error> {
        self.derivative()
    }

    /// Size of a deviation of the coordinates (n) relative to the peak-to-peak vibration over the last period.
    fn relative(&self, deviation: &[f64]) -> f64;

    /// The derivative over the period marched last, y(0) to y(T), and the largest change from that period to the one
    /// that would follow it, relative to its peak-to-peak vibration.
    ///
    /// The next period begins `residual` = y(T) − y(0) (n) beside this one, so that at step k it differs by P_k (y(T) −
    /// y(0)) with P_k the derivative of the first k steps, to first order. At the end of shooting the residual is some
    /// 1e-9 of the vibration, and the second order is rounding.
    ///
    /// # Errors
    /// If there is none.
    fn derivative_and_change(
        &mut self,
        residual: &[f64],
    ) -> Result<(MapDerivative, f64), Self::Error>;
}
