//! Limit of a sequence that an affine map makes, from a few of its members: reduced-rank extrapolation
//! (Mešina, Comput. Methods Appl. Mech. Eng. 10 (1977) 165–173; Eddy, in: Information Linkage between Applied
//! Mathematics and Industry, 1979, 387–396).
//!
//! Of sₖ₊₁ = A sₖ + b the members s₀ … s_K with differences uₖ = sₖ₊₁ − sₖ give
//!
//! ```text
//! s = Σ γₖ sₖ,  k = 0 … K−1,  Σ γₖ = 1,  |Σ γₖ uₖ| least
//! ```
//!
//! which is the fixed point if the differences lie in K − 1 dimensions that A keeps.

use nalgebra::{DMatrix, DVector};

/// Smallest part of the mean square of the differences that counts in the weights: below it rounding rules.
const RIDGE: f64 = 1e-14;

/// Weights γₖ, one a difference; `None` if there are fewer than two differences or they are not finite.
///
/// `differences`: vectors of one length in one unit, or scaled to be comparable.
///
/// ```
/// use dynamics::extrapolation_weights;
///
/// // s → 1 + (s − 1)/2 from 0: 0, ½, ¾ have the limit 1.
/// let weights = extrapolation_weights(&[vec![0.5], vec![0.25]]).unwrap();
/// assert!((weights[0] * 0.0 + weights[1] * 0.5 - 1.0).abs() < 1e-6);
/// ```
pub fn extrapolation_weights(differences: &[Vec<f64>]) -> Option<Vec<f64>> {
    let count = differences.len();
    if count < 2 {
        return None;
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut gram = DMatrix::from_fn(count, count, |i, j| dot(&differences[i], &differences[j]));
    // Differences shrink from one to the next: each by its own size, or the last would not count.
    let size: Vec<f64> = (0..count).map(|i| gram[(i, i)].sqrt()).collect();
    if size.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
        return None;
    }
    for i in 0..count {
        for j in 0..count {
            gram[(i, j)] /= size[i] * size[j];
        }
        gram[(i, i)] += RIDGE;
    }
    // G c = 1 in scaled weights, then Σ γ = 1.
    let right = DVector::from_iterator(count, size.iter().map(|s| size[count - 1] / s));
    let scaled = gram.cholesky()?.solve(&right);
    let weights: Vec<f64> = scaled.iter().zip(&size).map(|(c, s)| c / s).collect();
    let sum: f64 = weights.iter().sum();
    let weights: Vec<f64> = weights.iter().map(|w| w / sum).collect();
    weights.iter().all(|w| w.is_finite()).then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two damped rotations and a decay about a point: seven members say where they end.
    #[test]
    fn few_modes_end_at_their_fixed_point() {
        let limit = [3.0, -1.0, 0.5, 2.0, 7.0];
        let turn = |x: [f64; 2], rho: f64, phi: f64| {
            let (sin, cos) = phi.sin_cos();
            [rho * (cos * x[0] - sin * x[1]), rho * (sin * x[0] + cos * x[1])]
        };
        let step = |s: &[f64]| -> Vec<f64> {
            let d: Vec<f64> = s.iter().zip(&limit).map(|(s, l)| s - l).collect();
            let (a, b) = (turn([d[0], d[1]], 0.9, 1.0), turn([d[2], d[3]], 0.85, 2.1));
            let moved = [a[0], a[1], b[0], b[1], 0.7 * d[4]];
            moved.iter().zip(&limit).map(|(d, l)| d + l).collect()
        };
        let mut states = vec![vec![0.0; 5]];
        for k in 0..7 {
            states.push(step(&states[k]));
        }
        let differences: Vec<Vec<f64>> = states
            .windows(2)
            .map(|w| w[1].iter().zip(&w[0]).map(|(b, a)| b - a).collect())
            .collect();
        let weights = extrapolation_weights(&differences).unwrap();
        for (c, limit) in limit.iter().enumerate() {
            let found: f64 = weights.iter().zip(&states).map(|(w, s)| w * s[c]).sum();
            assert!((found - limit).abs() < 1e-5, "{found} {limit}");
        }
    }

    #[test]
    fn what_cannot_be_extrapolated_is_left_alone() {
        assert_eq!(extrapolation_weights(&[]), None);
        assert_eq!(extrapolation_weights(&[vec![1.0]]), None);
        assert_eq!(extrapolation_weights(&[vec![0.0], vec![1.0]]), None);
        assert_eq!(extrapolation_weights(&[vec![f64::NAN], vec![1.0]]), None);
    }
}
