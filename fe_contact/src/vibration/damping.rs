//! Damping of a body in proportion to its mass and stiffness.

use dynamics::AverageAcceleration;

use super::body::RaceMotion;

/// C = αM + βK.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proportional {
    /// α, 1/s.
    pub alpha: f64,
    /// β, s.
    pub beta: f64,
}

impl Proportional {
    /// What Newmark's rule leaves of q̈ + α q̇ once its part in the new displacement is taken out:
    /// a* + α v* of each coordinate.
    pub fn race_history(&self, rule: &AverageAcceleration, race: &RaceMotion) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            rule.acceleration_history(race.x[i], race.v[i], race.a[i])
                + self.alpha * rule.velocity_history(race.x[i], race.v[i])
        })
    }
}
