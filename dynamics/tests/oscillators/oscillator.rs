//! Oscillators with one degree of freedom, their forced first harmonic, and their motion by other means than the
//! library's.

use std::f64::consts::TAU;

use dynamics::harmonic_balance::HarmonicBalance;
use dynamics::{AverageAcceleration, Coupled, Coupling, CouplingForce, LinearPart};
use nalgebra::DMatrix;

/// Force law of one coupling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Law {
    /// k δ.
    Linear { stiffness: f64 },
    /// γ δ³.
    Cubic { gamma: f64 },
    /// k (|δ| − b) sign δ beyond a gap of ±b.
    Gap { stiffness: f64, half: f64 },
    /// k(θ) δ for δ > 0: k (1 + part · cos θ).
    OneSided { stiffness: f64, part: f64, steps: usize },
}

impl CouplingForce for Law {
    fn answer(&self, _: usize, step: usize, z: f64) -> (f64, f64) {
        match *self {
            Law::Linear { stiffness } => (stiffness * z, stiffness),
            Law::Cubic { gamma } => (gamma * z * z * z, 3.0 * gamma * z * z),
            Law::Gap { stiffness, half } if z.abs() > half => {
                (stiffness * (z - half * z.signum()), stiffness)
            }
            Law::Gap { .. } => (0.0, 0.0),
            Law::OneSided { stiffness, part, steps } if z > 0.0 => {
                let k = stiffness * (1.0 + part * (TAU * step as f64 / steps as f64).cos());
                (k * z, k)
            }
            Law::OneSided { .. } => (0.0, 0.0),
        }
    }
}

/// m ẍ + c ẋ + k x + F(x + τ ẋ) = f₀ + f₁ cos ωt.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Oscillator {
    pub(crate) mass: f64,
    pub(crate) damping: f64,
    pub(crate) stiffness: f64,
    pub(crate) lag: f64,
    pub(crate) law: Law,
    pub(crate) steady: f64,
    pub(crate) harmonic: f64,
}

impl Oscillator {
    pub(crate) fn linear(&self) -> LinearPart {
        LinearPart {
            mass: vec![self.mass],
            damping: DMatrix::from_element(1, 1, self.damping),
            stiffness: DMatrix::from_element(1, 1, self.stiffness),
        }
    }

    pub(crate) fn couplings(&self) -> Vec<Coupling> {
        vec![Coupling { row: vec![1.0], offset: 0.0, lag: self.lag }]
    }

    fn force(&self, step: usize, steps: usize) -> f64 {
        self.harmonic * (TAU * step as f64 / steps as f64).cos()
    }

    pub(crate) fn balance(&self, steps: usize) -> HarmonicBalance<Law> {
        let law = self.at(steps).law;
        let mut out = HarmonicBalance::new(&self.linear(), &self.couplings(), law, steps).unwrap();
        out.set_external(&[self.steady]).unwrap();
        for step in 0..steps {
            out.add_in_cycle(step, &[self.force(step, steps)]).unwrap();
        }
        out
    }

    pub(crate) fn coupled(&self, omega: f64, steps: usize) -> Coupled<Law> {
        let rule = AverageAcceleration::new(TAU / omega / steps as f64).unwrap();
        let law = self.at(steps).law;
        let mut out =
            Coupled::new(&self.linear(), &self.couplings(), &[], law, rule, steps).unwrap();
        out.set_external(&[self.steady]).unwrap();
        for step in 0..steps {
            out.add_in_cycle(step, &[self.force(step, steps)]).unwrap();
        }
        out
    }

    /// With its law tabulated at another number of steps.
    fn at(&self, count: usize) -> Self {
        let law = match self.law {
            Law::OneSided { stiffness, part, .. } => {
                Law::OneSided { stiffness, part, steps: count }
            }
            other => other,
        };
        Self { law, ..*self }
    }

    /// The cycle's displacements at every `stride`-th step after marching from a motion at step 0.
    pub(crate) fn marched(
        &self,
        omega: f64,
        steps: usize,
        cycles: usize,
        [x, v]: [f64; 2],
        stride: usize,
    ) -> Vec<f64> {
        let mut set = self.coupled(omega, steps);
        set.set_motion(0, &[x], &[v]).unwrap();
        for _ in 0..(cycles - 1) * steps {
            set.step().unwrap();
        }
        let mut out = Vec::new();
        for step in 0..steps {
            if step % stride == 0 {
                out.push(set.displacement(0));
            }
            set.step().unwrap();
        }
        out
    }

    /// The same, extrapolated from two numbers of steps to none: (4 x_{2S} − x_S)/3.
    pub(crate) fn extrapolated(
        &self,
        omega: f64,
        steps: usize,
        cycles: usize,
        start: [f64; 2],
    ) -> Vec<f64> {
        let coarse = self.marched(omega, steps, cycles, start, steps / 64);
        let fine = self.marched(omega, 2 * steps, cycles, start, steps / 32);
        coarse.iter().zip(&fine).map(|(c, f)| (4.0 * f - c) / 3.0).collect()
    }
}

/// Duffing's oscillator ẍ + 2ζẋ + x + γx³ = f cos ωt in metres: displacements of the order of 0.1 mm to 1 mm.
pub(crate) fn duffing(zeta: f64, force: f64) -> Oscillator {
    Oscillator {
        mass: 1.0,
        damping: 2.0 * zeta,
        stiffness: 1.0,
        lag: 0.0,
        law: Law::Cubic { gamma: 1e6 },
        steady: 0.0,
        harmonic: 1e-3 * force,
    }
}

/// First harmonic of Duffing's oscillator: with a = A², Ω = ω² and F, c, m, k, γ as in [`Oscillator`]
///
/// ```text
/// G(a, Ω) = a [(k + ¾γa − mΩ)² + c²Ω] − F² = 0,   folds: ∂G/∂a = (k + ¾γa − mΩ)(k + 9/4 γa − mΩ) + c²Ω = 0
/// ```
///
/// (Nayfeh & Mook, Nonlinear Oscillations, 1979, § 4.1). The frequency of the fold nearest a guess of (A, ω).
pub(crate) fn duffing_fold(own: &Oscillator, gamma: f64, amplitude: f64, omega: f64) -> f64 {
    let (k, m, c, f) = (own.stiffness, own.mass, own.damping, own.harmonic);
    let (mut a, mut s) = (amplitude * amplitude, omega * omega);
    for _ in 0..60 {
        let (p, q) = (k + 0.75 * gamma * a - m * s, k + 2.25 * gamma * a - m * s);
        let g = [a * (p * p + c * c * s) - f * f, p * q + c * c * s];
        let by_a = [p * q + c * c * s, 0.75 * gamma * q + 2.25 * gamma * p];
        let by_s = [a * (-2.0 * m * p + c * c), -m * (p + q) + c * c];
        let det = by_a[0] * by_s[1] - by_a[1] * by_s[0];
        a -= (g[0] * by_s[1] - g[1] * by_s[0]) / det;
        s -= (by_a[0] * g[1] - by_a[1] * g[0]) / det;
    }
    s.sqrt()
}
