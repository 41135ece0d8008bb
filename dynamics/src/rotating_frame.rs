//! Translations seen from a frame that turns at a constant speed.
//!
//! A mass m at (x, y) in a frame turning at Ω has the kinetic energy ½ m [(ẋ − Ωy)² + (ẏ + Ωx)²]. Rotations about
//! axes normal to the plane have no such terms.

/// A frame that turns counter-clockwise about the origin.
///
/// `[eq:rotating-frame]` m (ẍ − 2Ωẏ − Ω²x) = F_x, m (ÿ + 2Ωẋ − Ω²y) = F_y.
/// Source: derived here.
/// Checked by: `dynamics/src/rotating_frame.rs::a_body_at_rest_in_space_feels_no_force`,
/// `fe_contact/tests/gyroscopic.rs::free_bodies_vibrate_in_planes_that_stand_still_in_space`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotatingFrame {
    /// Ω, rad/s.
    pub speed: f64,
}

impl RotatingFrame {
    /// Gyroscopic matrix of a mass (kg) on its velocities (ẋ, ẏ), kg/s: rows [0, −2mΩ] and [2mΩ, 0].
    pub fn gyroscopic(&self, mass: f64) -> [[f64; 2]; 2] {
        let coupling = 2.0 * mass * self.speed;
        [[0.0, -coupling], [coupling, 0.0]]
    }

    /// Centripetal stiffness of a mass (kg) on each of its displacements, −mΩ², N/m.
    pub fn centripetal(&self, mass: f64) -> f64 {
        -(mass * self.speed * self.speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body at rest in space, at (1, 0), moves through the frame as (cos Ωt, −sin Ωt): free of forces.
    #[test]
    fn a_body_at_rest_in_space_feels_no_force() {
        let (frame, m) = (RotatingFrame { speed: 7.0 }, 3.0);
        let (o, k) = (frame.speed, frame.centripetal(m));
        let g = frame.gyroscopic(m);
        let (x, v, a) = ([1.0, 0.0], [0.0, -o], [-o * o, 0.0]);
        for i in 0..2 {
            let force = m * a[i] + g[i][0] * v[0] + g[i][1] * v[1] + k * x[i];
            assert!(force.abs() < 1e-12, "{force}");
        }
    }
}
