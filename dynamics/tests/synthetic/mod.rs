//! Free decays made from modal parameters: sums of damped cosines.

use std::f64::consts::TAU;

/// Modal parameters of a decay.
#[derive(Clone)]
pub struct Damped {
    /// Undamped frequency, Hz.
    pub frequency: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Shape, one entry per output.
    pub shape: Vec<f64>,
    /// Amplitude of the mode under each input.
    pub participation: Vec<f64>,
    /// Phase at the first sample, rad.
    pub phase: f64,
}

/// Pseudo-random numbers (splitmix64), the same on every run.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Numbers(seed)
    }

    /// Uniform between −1 and 1.
    pub fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn many(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.even()).collect()
    }

    /// Normal of unit variance, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let (a, b) = (0.5 * (self.even() + 1.0), self.even());
        (-2.0 * a.max(1e-300).ln()).sqrt() * (0.5 * TAU * b).cos()
    }
}

/// records[input][output] of modes, with x = Σ φ_o p_i exp(−ζωt) cos(ω√(1−ζ²) t + phase).
pub fn decays(modes: &[Damped], samples: usize, interval: f64) -> Vec<Vec<Vec<f64>>> {
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
pub fn disturb(records: &mut [Vec<Vec<f64>>], level: f64, seed: u64) {
    let peak = records.iter().flatten().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
    let mut numbers = Numbers::new(seed);
    for x in records.iter_mut().flatten().flatten() {
        *x += level * peak * numbers.normal();
    }
}
