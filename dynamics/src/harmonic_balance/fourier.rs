//! Real Fourier series, and the discrete transform between a cycle's samples and their coefficients.

use std::f64::consts::TAU;
use std::sync::Arc;

use faer::c64;
use nalgebra::DMatrix;
use rustfft::{Fft, FftPlanner};

/// x(θ) = Re Σ X_l exp(i l θ), l = 0 … H, with X_0 real.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierSeries {
    /// X_0 … X_H in the unit of x: X_l = a_l − i b_l for a_l cos lθ + b_l sin lθ.
    pub lines: Vec<c64>,
}

impl FourierSeries {
    /// From real coefficients a_0, a_1, b_1, a_2, b_2, …
    pub(super) fn from_real(coefficients: &[f64]) -> Self {
        let mean = coefficients.first().map(|a| c64::new(*a, 0.0));
        let (pairs, _) = coefficients.get(1..).unwrap_or_default().as_chunks::<2>();
        Self {
            lines: mean.into_iter().chain(pairs.iter().map(|[a, b]| c64::new(*a, -b))).collect(),
        }
    }

    /// Mean over a cycle.
    pub fn mean(&self) -> f64 {
        self.lines.first().map_or(0.0, |x| x.re)
    }

    /// Value at phase θ, rad.
    pub fn value(&self, theta: f64) -> f64 {
        self.derivative(0, theta)
    }

    /// Derivative of an order by phase at θ, per radⁿ.
    pub fn derivative(&self, order: u32, theta: f64) -> f64 {
        // Re Σ (i l)ⁿ X_l exp(i l θ)
        let of = |(l, x): (usize, &c64)| {
            let l = l as f64;
            (c64::new(0.0, l).powu(order) * *x * c64::from_polar(1.0, l * theta)).re
        };
        self.lines.iter().enumerate().map(of).sum()
    }

    /// Least and greatest of `samples` equidistant values, each refined by a parabola through its neighbours.
    pub fn extremes(&self, samples: usize) -> [f64; 2] {
        let n = samples.max(3);
        let x: Vec<f64> = (0..n).map(|s| self.value(TAU * s as f64 / n as f64)).collect();
        [-1.0, 1.0].map(|sign| {
            let best = (0..n).max_by(|a, b| (sign * x[*a]).total_cmp(&(sign * x[*b]))).unwrap_or(0);
            let (before, at, after) = (x[(best + n - 1) % n], x[best], x[(best + 1) % n]);
            let (rise, bend) = (0.5 * (after - before), after - 2.0 * at + before);
            if bend == 0.0 { at } else { at - 0.5 * rise * rise / bend }
        })
    }
}

/// Transform of S samples of a cycle.
#[derive(Clone)]
pub(super) struct Transform {
    samples: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl std::fmt::Debug for Transform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Transform").field("samples", &self.samples).finish_non_exhaustive()
    }
}

impl Transform {
    pub(super) fn new(samples: usize) -> Self {
        let mut planner = FftPlanner::new();
        let forward = planner.plan_fft_forward(samples);
        Self { samples, forward, inverse: planner.plan_fft_inverse(samples) }
    }

    /// Samples x(2π s/S) of a series with real coefficients a_0, a_1, b_1, …
    pub(super) fn samples(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut buffer = vec![c64::new(0.0, 0.0); self.samples];
        let series = FourierSeries::from_real(coefficients);
        for (to, from) in buffer.iter_mut().zip(series.lines) {
            *to = from;
        }
        self.inverse.process(&mut buffer);
        buffer.into_iter().map(|x| x.re).collect()
    }

    /// (1/S) Σ_s x_s exp(−i k θ_s) for k = 0 … S−1.
    pub(super) fn lines(&self, samples: &[f64]) -> Vec<c64> {
        let mut buffer: Vec<c64> = samples.iter().map(|x| c64::new(*x, 0.0)).collect();
        self.forward.process(&mut buffer);
        let scale = 1.0 / self.samples as f64;
        buffer.iter_mut().for_each(|x| *x *= scale);
        buffer
    }

    /// Real coefficients a_0, a_1, b_1, … up to harmonic H of samples.
    pub(super) fn coefficients(&self, samples: &[f64], harmonics: usize) -> Vec<f64> {
        let lines = self.lines(samples);
        let mut out = vec![lines[0].re];
        for line in &lines[1..=harmonics] {
            out.extend([2.0 * line.re, -2.0 * line.im]);
        }
        out
    }

    /// The matrix that takes the real coefficients of z to those of the product D z, both up to harmonic H,
    /// sampled as [`Transform::coefficients`] does: (2H+1)×(2H+1).
    ///
    /// With c_k = (1/S) Σ D_s cos kθ_s and s_k = (1/S) Σ D_s sin kθ_s it is exactly the derivative of the
    /// sampled coefficients, aliasing included.
    pub(super) fn product(&self, factor: &[f64], harmonics: usize) -> DMatrix<f64> {
        let lines = self.lines(factor);
        let c = |k: usize| lines[k % self.samples].re;
        // s_{l−j} with its sign.
        let s =
            |k: isize| -lines[k.unsigned_abs() % self.samples].im * if k < 0 { -1.0 } else { 1.0 };
        let mut out = DMatrix::zeros(2 * harmonics + 1, 2 * harmonics + 1);
        out[(0, 0)] = c(0);
        for l in 1..=harmonics {
            let (a, b) = (2 * l - 1, 2 * l);
            (out[(0, a)], out[(0, b)]) = (c(l), s(l as isize));
            (out[(a, 0)], out[(b, 0)]) = (2.0 * c(l), 2.0 * s(l as isize));
        }
        for j in 1..=harmonics {
            for l in 1..=harmonics {
                let (sum, difference) = (c(l + j), c(l.abs_diff(j)));
                let (both, apart) = (s((l + j) as isize), s(l as isize - j as isize));
                // 2 cos l cos j, 2 sin l cos j, 2 cos l sin j, 2 sin l sin j
                out[(2 * l - 1, 2 * j - 1)] = difference + sum;
                out[(2 * l, 2 * j - 1)] = both + apart;
                out[(2 * l - 1, 2 * j)] = both - apart;
                out[(2 * l, 2 * j)] = difference - sum;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn phase(s: usize, count: usize) -> f64 {
        TAU * s as f64 / count as f64
    }

    #[test]
    fn coefficients_and_samples_are_each_other_s_inverse() {
        for count in [9, 16, 35] {
            let given = [0.3, 1.0, -2.0, 0.5, 0.25, -0.125, 4.0];
            let transform = Transform::new(count);
            let samples = transform.samples(&given);
            let series = FourierSeries::from_real(&given);
            for (s, x) in samples.iter().enumerate() {
                assert!((series.value(phase(s, count)) - x).abs() < 1e-13);
            }
            for (a, b) in transform.coefficients(&samples, 3).iter().zip(given) {
                assert!((a - b).abs() < 1e-13);
            }
        }
    }

    /// Column by column against the samples multiplied one by one, with the spectrum of the factor reaching
    /// beyond half the sampling rate.
    #[test]
    fn product_matrix_multiplies_samples_with_aliasing_too() {
        for count in [9, 12, 40] {
            let transform = Transform::new(count);
            let factor: Vec<f64> =
                (0..count).map(|s| (phase(s, count).sin() * 3.0).exp()).collect();
            let matrix = transform.product(&factor, 4);
            for j in 0..9 {
                let mut unit = [0.0; 9];
                unit[j] = 1.0;
                let along = transform.samples(&unit);
                let product: Vec<f64> = along.iter().zip(&factor).map(|(a, b)| a * b).collect();
                for (i, x) in transform.coefficients(&product, 4).iter().enumerate() {
                    assert!((matrix[(i, j)] - x).abs() < 1e-12, "{count} {i} {j}");
                }
            }
        }
    }

    #[test]
    fn extremes_and_derivatives_of_a_sine() {
        let series = FourierSeries { lines: vec![c64::new(1.0, 0.0), c64::from_polar(2.0, 0.4)] };
        let [least, greatest] = series.extremes(500);
        assert!((least + 1.0).abs() < 1e-8 && (greatest - 3.0).abs() < 1e-8);
        assert_eq!(series.mean(), 1.0);
        assert!((series.derivative(2, 0.3) + 2.0 * 0.7f64.cos()).abs() < 1e-14);
        assert!((series.derivative(1, 0.3) + 2.0 * 0.7f64.sin()).abs() < 1e-14);
    }
}
