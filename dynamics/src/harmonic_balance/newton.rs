//! Newton's method with a monotonicity test that no scaling of the equations changes.

use faer::Mat;
use faer::prelude::Solve;
use nalgebra::DVector;

use super::equations::{Answers, BalanceEquations};
use super::error::BalanceError;
use crate::coupled::CouplingForce;
use crate::matrix::to_faer;

/// Least share of a correction that is tried.
const LEAST_SHARE: f64 = 1.0 / 1024.0;

/// A solution of the equations.
pub(super) struct Solved {
    pub(super) unknowns: Vec<f64>,
    pub(super) iterations: usize,
    pub(super) corrections: Vec<f64>,
    pub(super) residual: f64,
}

/// Solves from `start` until the largest entry of a correction is below `limit` of the largest deflection.
///
/// A step is shortened until the simplified correction J(y)⁻¹ r(trial) is shorter than the correction itself
/// (Deuflhard, *Newton Methods for Nonlinear Problems*, Springer 2004, § 3.3).
pub(super) fn solve<L: CouplingForce>(
    equations: &BalanceEquations<'_, L>,
    start: &[f64],
    limit: f64,
    most: usize,
    added_damping: f64,
) -> Result<Solved, BalanceError> {
    equations.fits(start)?;
    let failed = |iterations, correction| BalanceError::NotConverged {
        harmonics: equations.harmonics(),
        frequency: equations.frequency(),
        iterations,
        correction,
        added_damping,
    };
    let mut y = start.to_vec();
    let mut answers = equations.answers(&y);
    let mut r = equations.residual(&y, &answers);
    let mut corrections = Vec::new();
    let mut last = f64::NAN;
    for iteration in 1..=most {
        let factor = to_faer(&equations.jacobian(&answers)).partial_piv_lu();
        let correct = |r: &DVector<f64>| -> Vec<f64> {
            let right = Mat::from_fn(r.len(), 1, |i, _| -r[i]);
            let out = factor.solve(right);
            (0..r.len()).map(|i| out[(i, 0)]).collect()
        };
        let change = correct(&r);
        let length = norm(&change);
        if !length.is_finite() {
            return Err(failed(iteration, f64::NAN));
        }
        let mut share = 1.0;
        let (trial, found, left) = loop {
            let trial: Vec<f64> = y.iter().zip(&change).map(|(y, d)| y + share * d).collect();
            let found = equations.answers(&trial);
            let left = equations.residual(&trial, &found);
            let scale = equations.size(&trial);
            let next = norm(&correct(&left));
            // Corrections at the level of rounding need not become shorter.
            if next <= (1.0 - 0.5 * share) * length || largest(&change) <= limit * scale {
                break (trial, found, left);
            }
            share *= 0.5;
            if share < LEAST_SHARE {
                return Err(failed(iteration, largest(&change) / scale));
            }
        };
        (y, answers, r) = (trial, found, left);
        let scale = equations.size(&y);
        last = if scale > 0.0 { largest(&change) / scale } else { largest(&change) };
        corrections.push(last);
        if last <= limit && share == 1.0 {
            let residual = relative(equations, &y, &answers, &r);
            return Ok(Solved { unknowns: y, iterations: iteration, corrections, residual });
        }
    }
    Err(failed(most, last))
}

fn relative<L: CouplingForce>(
    equations: &BalanceEquations<'_, L>,
    y: &[f64],
    answers: &Answers,
    r: &DVector<f64>,
) -> f64 {
    let means = equations.means();
    let force = answers.forces.iter().map(|p| p[0].abs()).fold(0.0, f64::max);
    let over = |part: &[f64], scale: f64| {
        let left = largest(part);
        if left == 0.0 { 0.0 } else { left / scale }
    };
    let (forces, deflections) = r.as_slice().split_at(means);
    let force = force.max(equations.mean_force());
    over(forces, force).max(over(deflections, equations.size(y)))
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().map(|x| x.abs()).fold(0.0, f64::max)
}
