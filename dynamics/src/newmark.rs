//! Newmark's average-acceleration method (γ = ½, β = ¼), as substructures use it.
//!
//! Over a step h the acceleration is the mean of its values at both ends. The method is of second order and has no
//! numerical damping.

/// A step that is not positive and finite.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the time step is {0} s: it must be positive and finite")]
pub struct StepError(pub f64);

/// The integration rule with its time step.
///
/// `[eq:average-acceleration]` γ = ½, β = ¼:
/// ```text
/// ẍ₁ = (4/h²) x₁ − a*,   a* = (4/h²) x₀ + (4/h) ẋ₀ + ẍ₀,
/// ẋ₁ = (2/h) x₁ − v*,   v* = (2/h) x₀ + ẋ₀;   ω becomes (2/h) atan(ωh/2).
/// ```
/// Source: Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67–94.
/// Checked by: `dynamics/src/newmark.rs::frequency_is_turned_as_theory_says_and_energy_kept`,
/// `dynamics/src/newmark.rs::damped_motion_converges_at_second_order`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AverageAcceleration {
    step: f64,
}

impl AverageAcceleration {
    /// With a step of h seconds.
    ///
    /// # Errors
    /// If it is not positive and finite.
    pub fn new(step: f64) -> Result<Self, StepError> {
        match step > 0.0 && step.is_finite() {
            true => Ok(Self { step }),
            false => Err(StepError(step)),
        }
    }

    /// h, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Factor of x₁ in the new acceleration: 4/h², 1/s².
    pub fn inertia(&self) -> f64 {
        4.0 / (self.step * self.step)
    }

    /// Factor of x₁ in the new velocity: 2/h, 1/s.
    pub fn damping(&self) -> f64 {
        2.0 / self.step
    }

    /// a* of one coordinate.
    pub fn acceleration_history(&self, x: f64, v: f64, a: f64) -> f64 {
        self.inertia() * x + 2.0 * self.damping() * v + a
    }

    /// v* of one coordinate.
    pub fn velocity_history(&self, x: f64, v: f64) -> f64 {
        self.damping() * x + v
    }
}

/// Displacements, velocities and accelerations of some coordinates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Motion {
    /// Displacements.
    pub x: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
}

impl Motion {
    /// At rest at the origin.
    pub fn at_rest(count: usize) -> Self {
        Self { x: vec![0.0; count], v: vec![0.0; count], a: vec![0.0; count] }
    }

    /// v* of all coordinates into `out`.
    pub fn velocity_history(&self, rule: &AverageAcceleration, out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = rule.velocity_history(self.x[i], self.v[i]);
        }
    }

    /// Replaces the motion by that at the end of the step, with displacements `x`.
    pub fn advance(&mut self, rule: &AverageAcceleration, x: &[f64]) {
        for (i, x) in x.iter().enumerate() {
            let a = rule.acceleration_history(self.x[i], self.v[i], self.a[i]);
            let v = rule.velocity_history(self.x[i], self.v[i]);
            self.a[i] = rule.inertia() * x - a;
            self.v[i] = rule.damping() * x - v;
            self.x[i] = *x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// m ẍ + c ẋ + k x = 0 from x = 1 at rest, to time t.
    fn swing(c: f64, omega: f64, t: f64, steps: usize) -> Motion {
        let rule = AverageAcceleration::new(t / steps as f64).unwrap();
        let k = omega * omega;
        let mut motion = Motion { x: vec![1.0], v: vec![0.0], a: vec![-k] };
        for _ in 0..steps {
            let a = rule.acceleration_history(motion.x[0], motion.v[0], motion.a[0]);
            let v = rule.velocity_history(motion.x[0], motion.v[0]);
            let x = (a + c * v) / (rule.inertia() + c * rule.damping() + k);
            motion.advance(&rule, &[x]);
        }
        motion
    }

    #[test]
    fn frequency_is_turned_as_theory_says_and_energy_kept() {
        let (omega, t, steps) = (2000.0, 0.05, 400);
        let h: f64 = t / steps as f64;
        let m = swing(0.0, omega, t, steps);
        let turned = 2.0 / h * (0.5 * omega * h).atan();
        assert!((m.x[0] - (turned * t).cos()).abs() < 1e-10);
        let energy = m.v[0] * m.v[0] + omega * omega * m.x[0] * m.x[0];
        assert!((energy / (omega * omega) - 1.0).abs() < 1e-11);
    }

    #[test]
    fn damped_motion_converges_at_second_order() {
        let (omega, zeta, t) = (900.0, 0.02, 0.02);
        let damped = omega * (1.0f64 - zeta * zeta).sqrt();
        let decay = (-zeta * omega * t).exp();
        let exact = decay * ((damped * t).cos() + zeta * omega / damped * (damped * t).sin());
        let error = |steps| (swing(2.0 * zeta * omega, omega, t, steps).x[0] - exact).abs();
        let order = (error(400) / error(800)).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }

    #[test]
    fn a_step_that_is_none_is_refused() {
        for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(AverageAcceleration::new(h).is_err());
        }
    }
}
