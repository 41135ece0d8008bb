//! Further solutions at one parameter, by deflation of those known.

use super::error::ContinuationError;
use super::family::Family;
use super::options::Scales;
use super::space::Space;

/// How solutions are deflated and when the iteration ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deflation {
    /// p in M = Π (|y − y_k|⁻ᵖ + 1), distances in scaled unknowns.
    pub power: f64,
    /// The iteration ends when the largest entry of a scaled correction is below this.
    pub correction: f64,
    /// Most iterations.
    pub most_iterations: usize,
    /// Corrections are shortened until no scaled unknown changes by more.
    pub longest: f64,
}

impl Default for Deflation {
    fn default() -> Self {
        Self { power: 2.0, correction: 1e-10, most_iterations: 200, longest: 0.5 }
    }
}

/// A solution at λ = `lambda` other than those `known`, by Newton's method on M F from `start`, which must differ from
/// them (Farrell, Birkisson & Funke, SIAM J. Sci. Comput. 37 (2015) A2026–A2045).
///
/// # Errors
/// If sizes or options are out of range, F cannot be evaluated, or no further solution is found.
pub fn deflated_solution<F: Family>(
    family: &mut F,
    lambda: f64,
    start: &[f64],
    known: &[Vec<f64>],
    scales: &Scales,
    deflation: &Deflation,
) -> Result<Vec<f64>, ContinuationError<F::Error>> {
    let wanted = family.dimension();
    let lists = known.iter().map(|k| ("a known solution", k.len()));
    for (what, got) in lists.chain([("the start", start.len())]) {
        if got != wanted {
            return Err(ContinuationError::Size { what, got, wanted });
        }
    }
    for (what, value) in [("the power", deflation.power), ("the longest step", deflation.longest)] {
        if !(value > 0.0 && value.is_finite()) {
            let allowed = "it must be positive and finite";
            return Err(ContinuationError::Option { what, value, allowed });
        }
    }
    let mut space = Space::new(family, scales)?;
    let fixed = space.fixed_parameter();
    let known: Vec<Vec<f64>> = known.iter().map(|k| space.scaled(k, lambda)).collect();
    let mut u = space.scaled(start, lambda);
    let mut last = f64::NAN;
    for _ in 1..=deflation.most_iterations {
        let change = space.newton_correction(&u, &fixed)?;
        // (∇M/M)ᵀ d = −p Σ (u − u_k)ᵀ d / (|u − u_k|² (1 + |u − u_k|ᵖ))
        let mut along = 0.0;
        for k in &known {
            let gap = u.iter().zip(k).map(|(u, k)| u - k);
            let (square, slope) =
                gap.zip(&change).fold((0.0, 0.0), |(s, d), (g, c)| (s + g * g, d + g * c));
            along -=
                deflation.power * slope / (square * (1.0 + square.powf(0.5 * deflation.power)));
        }
        // The rank-one change of the Jacobian by ∇M only scales Newton's correction (Sherman–Morrison).
        let factor = 1.0 / (1.0 - along);
        last = change.iter().map(|d| d.abs()).fold(0.0, f64::max);
        let length = last * factor.abs();
        if !length.is_finite() {
            break;
        }
        if last <= deflation.correction {
            return Ok(space.plain(&u).0);
        }
        let share = factor * (deflation.longest / length).min(1.0);
        u.iter_mut().zip(&change).for_each(|(u, d)| *u += share * d);
    }
    let iterations = deflation.most_iterations;
    Err(ContinuationError::NotConverged { lambda, iterations, correction: last })
}
