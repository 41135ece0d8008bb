//! One-sided amplitude spectrum of an evenly sampled real record.

use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::Arc;

use faer::c64;
use rustfft::{Fft, FftPlanner};

use crate::error::SpectrumError;

/// Longest transform, samples; its buffer takes 4 GiB.
const LONGEST: usize = 1 << 28;

/// Weights a record is multiplied with before its transform.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Window {
    /// All weights are one: exact for a whole number of periods.
    #[default]
    Rectangular,
    /// w_k = sin²(πk/n): less leakage for any number of periods; the main lobe is four lines wide.
    Hann,
}

impl Window {
    /// Weight of sample k of n.
    fn weight(self, k: usize, n: usize) -> f64 {
        match self {
            Window::Rectangular => 1.0,
            Window::Hann => (PI * k as f64 / n as f64).sin().powi(2),
        }
    }
}

/// One-sided complex amplitude spectrum: x(t) ≈ Re Σ X_j exp(i 2π f_j t), t from the first sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Spacing of the lines, Hz: f_j = j · step.
    pub step: f64,
    /// X_j in the record's unit, ⌊N/2⌋ + 1 of them for N samples with padding.
    pub lines: Vec<c64>,
}

impl Spectrum {
    /// Frequencies of the lines, Hz.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> {
        (0..self.lines.len()).map(|j| j as f64 * self.step)
    }
}

/// Longest transform whose plan is kept, samples: mesh cycles at any number of steps.
const KEPT: usize = 1 << 14;

/// The plan of a transform of some length, which takes longer to make than to use once.
fn transform(length: usize) -> Arc<dyn Fft<f64>> {
    thread_local! {
        static KNOWN: RefCell<FftPlanner<f64>> = RefCell::new(FftPlanner::new());
    }
    match length <= KEPT {
        true => KNOWN.with_borrow_mut(|known| known.plan_fft_forward(length)),
        false => FftPlanner::new().plan_fft_forward(length),
    }
}

/// Spectrum of `record` (any length), sampled every `interval` s, padded with zeros to `padding`
/// times its length (1: not padded).
///
/// `[eq:spectrum]` X_j = (2 or 1) Σ w_k x_k exp(−i 2π jk/N) / Σ w_k.
/// Source: definition.
/// Checked by: `dynamics/src/spectrum.rs::a_sine_of_whole_periods_gives_its_amplitude_and_phase`,
/// `dynamics/src/spectrum.rs::the_highest_line_is_not_doubled`, `sweep.static_limit`.
///
/// Amplitudes are those of sines, not their halves and not their rms: A cos(2πft + φ) over whole
/// periods gives A exp(iφ) at its line. The lines at zero and, for an even padded length, at half
/// the sampling rate have no conjugate and are not doubled: a constant c gives c. Lines are divided by the
/// sum of the weights, so that neither window nor padding changes the height of a line.
///
/// # Errors
/// For fewer than two samples, one that is not finite, an interval that is not positive, a padding
/// of zero, or one to more than 2²⁸ samples.
pub fn spectrum(
    record: &[f64],
    interval: f64,
    window: Window,
    padding: usize,
) -> Result<Spectrum, SpectrumError> {
    let n = record.len();
    if n < 2 {
        return Err(SpectrumError::TooShort { samples: n });
    }
    if !(interval > 0.0 && interval.is_finite()) {
        return Err(SpectrumError::Interval { value: interval });
    }
    if let Some(sample) = record.iter().position(|x| !x.is_finite()) {
        return Err(SpectrumError::NotFinite { sample });
    }
    let padded = n.checked_mul(padding).filter(|p| (1..=LONGEST).contains(p));
    let padded = padded.ok_or(SpectrumError::Padding { value: padding })?;
    let mut buffer = vec![c64::new(0.0, 0.0); padded];
    let mut sum = 0.0;
    for (k, x) in record.iter().enumerate() {
        let weight = window.weight(k, n);
        buffer[k] = c64::new(weight * x, 0.0);
        sum += weight;
    }
    transform(padded).process(&mut buffer);
    buffer.truncate(padded / 2 + 1);
    for (j, line) in buffer.iter_mut().enumerate() {
        let alone = j == 0 || 2 * j == padded;
        *line *= if alone { 1.0 / sum } else { 2.0 / sum };
    }
    Ok(Spectrum { step: 1.0 / (padded as f64 * interval), lines: buffer })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// c + A cos(2π·line·k/n + φ)
    fn sine(n: usize, line: f64, amplitude: f64, phase: f64, constant: f64) -> Vec<f64> {
        let angle = |k: usize| 2.0 * PI * line * k as f64 / n as f64 + phase;
        (0..n).map(|k| constant + amplitude * angle(k).cos()).collect()
    }

    #[test]
    fn a_sine_of_whole_periods_gives_its_amplitude_and_phase() {
        // Even, odd and prime lengths.
        for n in [240, 225, 241] {
            for (window, padding) in
                [(Window::Rectangular, 1), (Window::Rectangular, 4), (Window::Hann, 1)]
            {
                let record = sine(n, 12.0, 3.0, 0.7, -5.0);
                let found = spectrum(&record, 1e-4, window, padding).unwrap();
                assert!((found.step * (n * padding) as f64 * 1e-4 - 1.0).abs() < 1e-12);
                let line = found.lines[12 * padding];
                assert!((line - c64::from_polar(3.0, 0.7)).norm() < 1e-11, "{n} {line}");
                assert!((found.lines[0] - c64::new(-5.0, 0.0)).norm() < 1e-11);
                let frequency = found.frequencies().nth(12 * padding).unwrap();
                assert!((frequency - 12.0 / (n as f64 * 1e-4)).abs() < 1e-9);
                assert_eq!(found.lines.len(), n * padding / 2 + 1);
            }
        }
    }

    #[test]
    fn lines_between_are_empty_without_a_window_and_three_wide_with_hann() {
        let record = sine(200, 20.0, 2.0, 0.0, 0.0);
        let plain = spectrum(&record, 0.1, Window::Rectangular, 1).unwrap();
        let hann = spectrum(&record, 0.1, Window::Hann, 1).unwrap();
        for (j, (a, b)) in plain.lines.iter().zip(&hann.lines).enumerate() {
            let expected = [2.0, 1.0].get(j.abs_diff(20)).copied().unwrap_or(0.0);
            assert!((a.norm() - if j == 20 { 2.0 } else { 0.0 }).abs() < 1e-12);
            assert!((b.norm() - expected).abs() < 1e-12, "{j} {b}");
        }
    }

    #[test]
    fn the_highest_line_is_not_doubled() {
        let record: Vec<f64> = (0..64).map(|k| if k % 2 == 0 { 1.5 } else { -1.5 }).collect();
        let found = spectrum(&record, 1.0, Window::Rectangular, 1).unwrap();
        assert!((found.lines[32].re - 1.5).abs() < 1e-14 && found.step * 32.0 == 0.5);
    }

    #[test]
    fn hann_holds_down_a_sine_that_does_not_close() {
        let record = sine(400, 40.5, 1.0, 0.3, 0.0);
        let far = |window| spectrum(&record, 1.0, window, 1).unwrap().lines[100].norm();
        assert!(far(Window::Hann) < 1e-3 * far(Window::Rectangular));
    }

    #[test]
    fn unusable_input_is_refused() {
        let run = |x: &[f64], s, padding| spectrum(x, s, Window::Rectangular, padding).unwrap_err();
        assert_eq!(run(&[1.0], 1.0, 1), SpectrumError::TooShort { samples: 1 });
        assert_eq!(run(&[1.0, 2.0], 0.0, 1), SpectrumError::Interval { value: 0.0 });
        assert_eq!(run(&[1.0, f64::NAN], 1.0, 1), SpectrumError::NotFinite { sample: 1 });
        assert_eq!(run(&[1.0, 2.0], 1.0, 0), SpectrumError::Padding { value: 0 });
        let huge = run(&[1.0, 2.0], 1.0, usize::MAX);
        assert_eq!(huge, SpectrumError::Padding { value: usize::MAX });
        assert!(matches!(run(&[1.0, 2.0], f64::NAN, 1), SpectrumError::Interval { .. }));
    }
}
