//! Periodic motions by shooting with a Runge–Kutta method: another route than the library's.

use std::convert::Infallible;
use std::f64::consts::TAU;

use dynamics::continuation::{Evaluation, Family, Judgement};
use nalgebra::{DMatrix, DVector};

use super::oscillator::Oscillator;

/// Periodic motions of an oscillator by shooting: unknowns x, v at phase 0; fourth-order Runge–Kutta in θ = ωt, with
/// the derivatives by start and frequency integrated along.
pub(crate) struct Shooting {
    pub(crate) own: Oscillator,
    pub(crate) gamma: f64,
    pub(crate) steps: usize,
}

impl Shooting {
    /// End of a period [x, v, ∂x/∂x₀, ∂v/∂x₀, ∂x/∂v₀, ∂v/∂v₀, ∂x/∂ω, ∂v/∂ω], and x along it.
    pub(crate) fn period(&self, y: &[f64], omega: f64) -> ([f64; 8], Vec<f64>) {
        let o = &self.own;
        let rate = |s: &[f64; 8], theta: f64| -> [f64; 8] {
            let (x, v) = (s[0], s[1]);
            let a = (o.harmonic * theta.cos()
                - o.damping * v
                - o.stiffness * x
                - self.gamma * x * x * x)
                / o.mass;
            let (by_x, by_v) =
                (-(o.stiffness + 3.0 * self.gamma * x * x) / o.mass, -o.damping / o.mass);
            let mut out = [v / omega, a / omega, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            for k in [2, 4, 6] {
                out[k] = s[k + 1] / omega;
                out[k + 1] = (by_x * s[k] + by_v * s[k + 1]) / omega;
            }
            out[6] -= v / (omega * omega);
            out[7] -= a / (omega * omega);
            out
        };
        let h = TAU / self.steps as f64;
        let mut s = [y[0], y[1], 1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let mut along = Vec::with_capacity(self.steps);
        for step in 0..self.steps {
            along.push(s[0]);
            let theta = step as f64 * h;
            let moved = |k: &[f64; 8], part: f64| std::array::from_fn(|i| s[i] + part * k[i]);
            let k1 = rate(&s, theta);
            let k2 = rate(&moved(&k1, 0.5 * h), theta + 0.5 * h);
            let k3 = rate(&moved(&k2, 0.5 * h), theta + 0.5 * h);
            let k4 = rate(&moved(&k3, h), theta + h);
            for i in 0..8 {
                s[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        (s, along)
    }
}

impl Family for Shooting {
    type Error = Infallible;

    fn dimension(&self) -> usize {
        2
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, Infallible> {
        let (s, _) = self.period(y, lambda);
        Ok(Evaluation {
            residual: DVector::from_vec(vec![s[0] - y[0], s[1] - y[1]]),
            jacobian: DMatrix::from_row_slice(2, 2, &[s[2] - 1.0, s[4], s[3], s[5] - 1.0]),
            derivative: DVector::from_vec(vec![s[6], s[7]]),
        })
    }

    /// Stable if both multipliers are within the unit circle; 1 − trace + det passes zero where one is +1.
    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, Infallible> {
        let (s, _) = self.period(y, lambda);
        let (trace, det) = (s[2] + s[5], s[2] * s[5] - s[3] * s[4]);
        let at_one = 1.0 - trace + det;
        let is_stable = at_one > 0.0 && 1.0 + trace + det > 0.0 && det < 1.0;
        Ok(Judgement { is_stable: Some(is_stable), tests: vec![at_one] })
    }
}
