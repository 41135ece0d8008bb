//! The low-pass filter before decimation.

use std::f64::consts::PI;

use faer::c64;

/// Attenuation at frequencies that fold into the band, dB.
const ATTENUATION: f64 = 140.0;

/// Half length of the filter, samples: its pass band ends at `high` (Hz), its stop band begins at
/// 1/(stride·interval) − high, the lowest frequency that folds into the band.
pub(super) fn half_length(high: f64, stride: usize, interval: f64) -> usize {
    let width = 1.0 / stride as f64 - 2.0 * high * interval; // cycles a sample
    // n = (A − 7.95) / (2.285 · 2π Δf) (Kaiser 1974)
    ((ATTENUATION - 7.95) / (2.285 * 2.0 * PI * width) / 2.0).ceil() as usize
}

/// 2·half + 1 weights h_j of y(k) = Σ h_j x(k + j), sum one: a sinc under a Kaiser window.
pub(super) fn low_pass(half: usize, stride: usize) -> Vec<f64> {
    let cutoff = 0.5 / stride as f64; // midway, cycles a sample
    // β = 0.1102 (A − 8.7)
    let beta = 0.1102 * (ATTENUATION - 8.7);
    let weight = |j: usize| {
        let k = j as f64 - half as f64;
        let sinc = if j == half { 2.0 * cutoff } else { (2.0 * PI * cutoff * k).sin() / (PI * k) };
        let along = k / half as f64;
        sinc * bessel_i0(beta * (1.0 - along * along).max(0.0).sqrt())
    };
    let weights: Vec<f64> = (0..=2 * half).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|h| h / sum).collect()
}

/// Modified Bessel function I₀(x) = Σ ((x/2)^k / k!)².
fn bessel_i0(x: f64) -> f64 {
    let (mut sum, mut term, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-17 * sum {
        term *= (x / (2.0 * k)).powi(2);
        sum += term;
        k += 1.0;
    }
    sum
}

/// The filtered record, at the samples for which all weights apply.
pub(super) fn filter(record: &[f64], weights: &[f64]) -> Vec<f64> {
    let sum = |part: &[f64]| part.iter().zip(weights).map(|(x, h)| x * h).sum();
    record.windows(weights.len()).map(sum).collect()
}

/// Factor by which the filter multiplies exp(st): Σ h_j exp(s j·interval).
pub(super) fn gain(weights: &[f64], s: c64, interval: f64) -> c64 {
    let term = |(j, h): (usize, &f64)| (s * (j as f64 * interval)).exp() * *h;
    weights.iter().enumerate().map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_passes_and_what_folds_into_it_does_not() {
        let (high, stride, interval) = (2500.0, 20, 5e-6);
        let weights = low_pass(half_length(high, stride, interval), stride);
        let size = |f: f64| gain(&weights, c64::new(0.0, 2.0 * PI * f), interval).norm();
        for f in [0.0, 1000.0, 2500.0] {
            assert!((size(f) - 1.0).abs() < 2e-5, "{f} {}", size(f));
        }
        for f in [7500.0, 9800.0, 12800.0, 99e3] {
            assert!(size(f) < 2e-5, "{f} {}", size(f));
        }
    }

    #[test]
    fn a_decay_stays_a_decay_times_the_gain() {
        let (s, interval) = (c64::new(-300.0, 9000.0), 2e-5);
        let at = |k: usize| (s * (k as f64 * interval)).exp();
        let record: Vec<f64> = (0..400).map(|k| at(k).re).collect();
        let weights = low_pass(half_length(2000.0, 10, interval), 10);
        let factor = gain(&weights, s, interval);
        for (k, y) in filter(&record, &weights).iter().enumerate() {
            assert!((y - (factor * at(k)).re).abs() < 1e-14);
        }
    }

    #[test]
    fn bessel_function_has_its_tabled_value() {
        // Abramowitz & Stegun, table 9.8: e^-x I₀(x) at x = 5.
        assert!(((-5f64).exp() * bessel_i0(5.0) - 0.183_540_812_6).abs() < 1e-10);
    }
}
