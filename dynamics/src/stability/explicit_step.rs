//! Where the explicit central difference stops being stable.

use crate::benchmark_subjects::{IntegratorError, Scheme, amplification};

/// A spectral radius above this is growth; below it, rounding at the double root of the border.
const GROWS: f64 = 1e-6;

/// `[eq:explicit-limit]` The Δt·ω at which the measured spectral radius of central difference leaves 1, for a damping
/// ratio; theory: 2.
///
/// Source: closed form.
/// Checked by: `dynamics/tests/explicit_limit.rs::the_explicit_step_is_stable_up_to_two`.
///
/// Bisected on steps of the code.
///
/// # Errors
/// If a step cannot be made.
pub fn explicit_limit(ratio: f64) -> Result<f64, IntegratorError> {
    let grows = |omega_h: f64| {
        let found = amplification(&Scheme::CentralDifference, omega_h, ratio)?;
        Ok::<_, IntegratorError>(found.spectral_radius > 1.0 + GROWS)
    };
    let (mut low, mut high) = (0.1, 20.0);
    while high - low > 1e-9 * high {
        let middle = 0.5 * (low + high);
        if grows(middle)? { high = middle } else { low = middle }
    }
    Ok(0.5 * (low + high))
}
