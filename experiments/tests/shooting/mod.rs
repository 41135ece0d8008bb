//! Steady states by shooting.

mod agreement;
mod derivative;
mod next_cycle;
mod sets;
mod symmetry;

use dynamics::Multiplier;

/// Difference of two multipliers by half the sum and by the product of each with its conjugate, which the derivative
/// determines: near the real axis the imaginary part itself is the root of a small difference.
fn apart(a: Multiplier, b: Multiplier) -> f64 {
    (a.re - b.re).abs().max((a.size().powi(2) - b.size().powi(2)).abs())
}
