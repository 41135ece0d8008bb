//! Free decays made from modal parameters: sums of damped cosines.

use std::f64::consts::TAU;

/// Modal parameters of a decay.
#[derive(Clone)]
pub(crate) struct Damped {
    /// Undamped frequency, Hz.
    pub(crate) frequency: f64,
    /// Damping ratio.
    pub(crate) damping: f64,
    /// Shape, one entry per output.
    pub(crate) shape: Vec<f64>,
    /// Amplitude of the mode under each input.
    pub(crate) participation: Vec<f64>,
    /// Phase at the first sample, rad.
    pub(crate) phase: f64,
}

/// Pseudo-random numbers (splitmix64), the same on every run.
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Numbers(seed)
    }

    /// Uniform between −1 and 1.
    pub(crate) fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn many(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.even()).collect()
    }

    /// Normal of unit variance, by Box and Muller.
    pub(crate) fn normal(&mut self) -> f64 {
        let (a, b) = (0.5 * (self.even() + 1.0), self.even());
        (-2.0 * a.max(1e-300).ln()).sqrt() * (0.5 * TAU * b).cos()
    }
}

/// records[input][output] of modes, with x = Σ φ_o p_i exp(−ζωt) cos(ω√(1−ζ²) t + phase).
pub(crate) fn decays(modes: &[Damped], samples: usize, interval: f64) -> Vec<Vec<Vec<f64>>> {
    let (inputs, outputs) = (modes[0].participation.len(), modes[0].shape.len());
    let mut records = vec![vec![vec![0.0; samples]; outputs]; inputs];
    for mode in modes {
        let omega = TAU * mode.frequency;
        let swinging = omega * (1.0 - mode.damping * mode.damping).sqrt();
        let course: Vec<f64> = (0..samples)
            .map(|k| k as f64 * interval)
            .map(|t| (-mode.damping * omega * t).exp() * (swinging * t + mode.phase).cos())
            .collect();
        for (row, p) in records.iter_mut().zip(&mode.participation) {
            for (record, phi) in row.iter_mut().zip(&mode.shape) {
                record.iter_mut().zip(&course).for_each(|(x, q)| *x += p * phi * q);
            }
        }
    }
    records
}

/// Adds normal noise with a standard deviation of `level` times the largest sample of all records.
pub(crate) fn disturb(records: &mut [Vec<Vec<f64>>], level: f64, seed: u64) {
    let peak = records.iter().flatten().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
    let mut numbers = Numbers::new(seed);
    for x in records.iter_mut().flatten().flatten() {
        *x += level * peak * numbers.normal();
    }
}
