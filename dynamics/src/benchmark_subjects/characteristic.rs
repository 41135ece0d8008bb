//! Spectral radius, period error and numerical damping of the schemes in closed form.

use nalgebra::{Complex, DMatrix};

use super::amplification::Amplification;
use super::generalized_alpha::Weights;
use super::scheme::Scheme;

/// Of m ẍ + 2ξω m ẋ + ω² m x = 0 at ω Δt, from the scheme's characteristic equation.
///
/// `[eq:amplification]` μ = R(s Δt) of one-step rules for ẏ = s y with s = ω (−ξ ± i √(1−ξ²)): trapezoidal rule
/// R = (1 + z/2)/(1 − z/2), θ-method (1 + (1−θ) z)/(1 − θ z), Bathe's scheme (12 + 5z)/(12 − 7z + z²).
/// Source: derived here.
/// Checked by: `dynamics/tests/integrators.rs::steps_amplify_as_the_closed_forms_say`,
/// `dynamics/tests/integrators.rs::radii_at_infinite_frequency_are_the_published_ones`.
///
/// The trapezoidal rule is what average acceleration and contact-stabilised Newmark are without contact.
pub fn closed_form(scheme: &Scheme, omega_h: f64, ratio: f64) -> Amplification {
    let one = Complex::new(1.0, 0.0);
    let z = Complex::new(-ratio, (1.0 - ratio * ratio).sqrt()) * omega_h;
    let both = |r: Complex<f64>| vec![r, r.conj()];
    let values = match *scheme {
        Scheme::AverageAcceleration | Scheme::ContactStabilised => {
            both((one + z * 0.5) / (one - z * 0.5))
        }
        Scheme::MoreauJean { theta, .. } => both((one + z * (1.0 - theta)) / (one - z * theta)),
        Scheme::Bathe => both((one * 12.0 + z * 5.0) / (one * 12.0 - z * 7.0 + z * z)),
        Scheme::CentralDifference => explicit(omega_h, ratio),
        Scheme::Hht { alpha } => cubic(&Weights::hht(alpha), omega_h, ratio),
        Scheme::GeneralizedAlpha { rho_infinity } => {
            cubic(&Weights::chung_hulbert(rho_infinity), omega_h, ratio)
        }
    };
    Amplification::of(&values, omega_h, ratio)
}

/// `[eq:central-difference-amplification]` (1 + ξΩ) μ² − (2 − Ω²) μ + (1 − ξΩ) = 0.
///
/// Source: derived here.
/// Checked by: `dynamics/tests/integrators.rs::steps_amplify_as_the_closed_forms_say`.
fn explicit(omega_h: f64, ratio: f64) -> Vec<Complex<f64>> {
    let (a, b, c) = (1.0 + ratio * omega_h, 2.0 - omega_h * omega_h, 1.0 - ratio * omega_h);
    let root = Complex::new(b * b - 4.0 * a * c, 0.0).sqrt();
    [root, -root].map(|r| (r + b) / (2.0 * a)).to_vec()
}

/// `[eq:characteristic-cubic]` With x, v, a going as μ^n the Newmark relations and the balance of Chung & Hulbert give
/// ```text
/// ((1−α_m) μ + α_m) (μ−1)² + ((1−α_f) μ + α_f) (2ξΩ (γμ + 1−γ) (μ−1) + Ω² (β μ² + (½+γ−2β) μ + ½−γ+β)) = 0
/// ```
/// Source: derived here from Chung & Hulbert (1993).
/// Checked by: `dynamics/tests/integrators.rs::steps_amplify_as_the_closed_forms_say`.
fn cubic(weights: &Weights, omega_h: f64, ratio: f64) -> Vec<Complex<f64>> {
    let Weights { alpha_m, alpha_f, beta, gamma } = *weights;
    // Coefficients from the constant upwards.
    let inertia = product(&[alpha_m, 1.0 - alpha_m], &[1.0, -2.0, 1.0]);
    let damper = product(&[1.0 - gamma, gamma], &[-1.0, 1.0]);
    let spring = [0.5 - gamma + beta, 0.5 + gamma - 2.0 * beta, beta];
    let force: Vec<f64> =
        (0..3).map(|i| 2.0 * ratio * omega_h * damper[i] + omega_h * omega_h * spring[i]).collect();
    let force = product(&[alpha_f, 1.0 - alpha_f], &force);
    let p: Vec<f64> = inertia.iter().zip(&force).map(|(a, b)| a + b).collect();
    // Roots are eigenvalues of the companion matrix.
    let companion = DMatrix::from_fn(3, 3, |i, j| match (i, j) {
        (i, 2) => -p[i] / p[3],
        (i, j) if i == j + 1 => 1.0,
        _ => 0.0,
    });
    companion.complex_eigenvalues().iter().copied().collect()
}

/// Coefficients of the product of two polynomials.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}
