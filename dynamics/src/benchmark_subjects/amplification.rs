//! Spectral radius, period error and numerical damping of a scheme, measured from its steps.

use nalgebra::{Complex, DMatrix, DVector, Matrix3};

use super::error::IntegratorError;
use super::scheme::Scheme;
use super::state::StepState;
use super::system::VibratingSystem;

/// What a step makes of an oscillation of frequency ω.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amplification {
    /// Largest |μ| of the amplification matrix: above 1 the scheme is unstable.
    pub spectral_radius: f64,
    /// Period of the discrete oscillation over the true one, minus 1; `None` where it does not oscillate.
    pub period_error: Option<f64>,
    /// Damping ratio ξ̄ = −ln|μ| / arg μ of the oscillating pair, including physical damping.
    pub damping_ratio: Option<f64>,
}

impl Amplification {
    /// From eigenvalues of the step at ω Δt: the oscillating pair is the largest that is complex.
    pub(super) fn of(values: &[Complex<f64>], omega_h: f64, ratio: f64) -> Self {
        let spectral_radius = values.iter().map(|m| m.norm()).fold(0.0, f64::max);
        let pair = values
            .iter()
            .filter(|m| m.im > 1e-9 * m.norm())
            .max_by(|a, b| a.norm().total_cmp(&b.norm()));
        let damped = omega_h * (1.0 - ratio * ratio).sqrt();
        Self {
            spectral_radius,
            period_error: pair.map(|m| damped / m.arg() - 1.0),
            damping_ratio: pair.map(|m| -m.norm().ln() / m.arg().hypot(m.norm().ln())),
        }
    }
}

/// Of m ẍ + 2ξω m ẋ + ω² m x = 0 at ω Δt, from one step of the code on each of x, Δt v and Δt² a.
///
/// # Errors
/// If the scheme cannot be prepared.
pub fn amplification(
    scheme: &Scheme,
    omega_h: f64,
    ratio: f64,
) -> Result<Amplification, IntegratorError> {
    let system = VibratingSystem::oscillator(1.0, 2.0 * ratio * omega_h, omega_h * omega_h)?;
    let integrator = scheme.prepare_at_any_step(&system, 1.0)?;
    let mut columns = Vec::with_capacity(3);
    for j in 0..3 {
        let one = |i| DVector::from_element(1, if i == j { 1.0 } else { 0.0 });
        let mut state =
            StepState { time: 0.0, x: one(0), v: one(1), a: one(2), forces: Vec::new() };
        integrator.step(&mut state)?;
        columns.push([state.x[0], state.v[0], state.a[0]]);
    }
    let matrix = Matrix3::from_fn(|i, j| columns[j][i]);
    Ok(Amplification::of(&eigenvalues(&matrix), omega_h, ratio))
}

/// Eigenvalues of a 3×3 matrix.
fn eigenvalues(matrix: &Matrix3<f64>) -> Vec<Complex<f64>> {
    DMatrix::from_fn(3, 3, |i, j| matrix[(i, j)]).complex_eigenvalues().iter().copied().collect()
}
