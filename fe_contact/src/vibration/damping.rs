//! Damping of a body in proportion to its mass and stiffness.

use dynamics::AverageAcceleration;

use super::body::RaceMotion;

/// `[eq:proportional-damping]` C = αM + βK.
///
/// Source: definition.
/// Checked by: `fe_contact/tests/vibration.rs::linear_damping_is_near_that_of_proportional_damping`,
/// `fe.modal.routes.damping`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proportional {
    /// α, 1/s.
    pub alpha: f64,
    /// β, s.
    pub beta: f64,
}

impl Proportional {
    /// The term a* + α v* of each coordinate of a race: at the end of a step, Newmark's rule gives
    /// q̈ + α q̇ = (4/h² + 2α/h) q − (a* + α v*).
    pub fn race_history(&self, rule: &AverageAcceleration, race: &RaceMotion) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            rule.acceleration_history(race.x[i], race.v[i], race.a[i])
                + self.alpha * rule.velocity_history(race.x[i], race.v[i])
        })
    }
}
