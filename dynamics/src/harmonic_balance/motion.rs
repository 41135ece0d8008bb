//! A periodic motion found by harmonic balance.

use super::fourier::FourierSeries;
use crate::newmark::Motion;

/// A periodic motion of a system with couplings.
#[derive(Debug, Clone, PartialEq)]
pub struct BalancedMotion {
    /// Fundamental frequency ω, rad/s: θ = ω t.
    pub frequency: f64,
    /// Number of harmonics H.
    pub harmonics: usize,
    /// Coordinates, m.
    pub coordinates: Vec<FourierSeries>,
    /// Deflections δ of the couplings, m.
    pub deflections: Vec<FourierSeries>,
    /// Forces of the couplings, N.
    pub forces: Vec<FourierSeries>,
    /// Unknowns of [`BalanceEquations`](super::BalanceEquations), m.
    pub unknowns: Vec<f64>,
    /// Newton iterations of all stages.
    pub iterations: usize,
    /// Sizes of the corrections of the last stage, the largest entry over the largest deflection.
    pub corrections: Vec<f64>,
    /// What is left of the deflections' equations over the largest deflection, and of the mean forces over the
    /// largest of them; the larger of both.
    pub residual: f64,
    /// Amplitude of the highest quarter of the harmonics (at least two) over the largest amplitude.
    pub tail: f64,
}

impl BalancedMotion {
    /// Displacements, velocities and accelerations of the coordinates at phase θ, rad: at 2π s/S what
    /// [`Coupled::set_motion`](crate::Coupled::set_motion) takes at step s.
    pub fn motion(&self, theta: f64) -> Motion {
        // d/dt = ω d/dθ
        let all = |order: u32| {
            let rate = self.frequency.powf(f64::from(order));
            self.coordinates.iter().map(|x| rate * x.derivative(order, theta)).collect()
        };
        Motion { x: all(0), v: all(1), a: all(2) }
    }
}

/// Amplitude of the highest quarter of the lines over the largest amplitude, mean left out; over all series.
pub(super) fn tail(series: &[FourierSeries], harmonics: usize) -> f64 {
    let last = (harmonics / 4).max(2).min(harmonics);
    let amplitude = |from: usize| -> f64 {
        let of = |s: &FourierSeries| s.lines[from..].iter().map(|x| x.norm()).fold(0.0, f64::max);
        series.iter().map(of).fold(0.0, f64::max)
    };
    let all = amplitude(1);
    if all == 0.0 { 0.0 } else { amplitude(harmonics + 1 - last) / all }
}
