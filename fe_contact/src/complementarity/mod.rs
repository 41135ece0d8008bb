//! Frictionless contact as a linear complementarity problem.
//!
//! Given a symmetric positive (semi-)definite compliance C (n×n) and gaps g (n), find forces p that solve the
//! [`Problem`]. Any consistent units will do; in contact p is in N, C in m/N, and g and the separation w in m.
//! The problem is the optimality condition of min ½ pᵀ C p + gᵀ p, p ≥ 0, so w is unique wherever a
//! solution exists, and p too if C is definite.
//!
//! Three independent solvers: [`ActiveSet`] (the default), [`Lemke`] and, with the feature
//! `interior_point`, `InteriorPoint`.

mod active_set;
#[cfg(feature = "interior_point")]
mod interior_point;
mod lemke;

pub use active_set::ActiveSet;
#[cfg(feature = "interior_point")]
pub use interior_point::InteriorPoint;
pub use lemke::Lemke;

use nalgebra::{Cholesky, DMatrix, Dyn};

/// A solution with a larger [`kkt_residual`] is refused rather than returned.
const RESIDUAL_LIMIT: f64 = 1e-6;

/// A problem, borrowed.
///
/// `[eq:complementarity]` p ≥ 0, w = C p + g ≥ 0, pᵀ w = 0.
/// Source: Cottle, Pang & Stone, The Linear Complementarity Problem, Academic Press (1992), ch. 3.
/// Checked by: `fe_contact/tests/complementarity.rs::the_solvers_agree_on_random_and_degenerate_problems`,
/// `fe_contact/tests/complementarity.rs::a_problem_solved_by_hand_comes_out`, `fe.convergence.solvers`.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// Compliance C, n×n, symmetric positive semidefinite, e.g. m/N. Neither property is checked.
    pub compliance: &'a DMatrix<f64>,
    /// Gaps g of the unloaded state, n, e.g. m; negative where bodies would overlap.
    pub gaps: &'a [f64],
}

/// A solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Forces p ≥ 0, n, e.g. N.
    pub forces: Vec<f64>,
    /// Whether each cell is in contact (n): w = 0 where it is, p = 0 where it is not. Where both
    /// are 0, either value is possible.
    pub active: Vec<bool>,
    /// Pivots ([`Lemke`]), factorisations ([`ActiveSet`], plus pivots if it had to fall back) or
    /// interior-point iterations (`InteriorPoint`).
    pub iterations: usize,
}

impl Solution {
    /// No contact anywhere.
    fn zero(n: usize) -> Self {
        Self { forces: vec![0.0; n], active: vec![false; n], iterations: 0 }
    }
}

/// Why there is no solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ComplementarityError {
    /// The compliance is not square.
    #[error("the compliance is {rows}×{columns}, not square")]
    NotSquare {
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
    },
    /// Compliance and gaps differ in size.
    #[error("the compliance is of order {order}, but there are {gaps} gaps")]
    SizeMismatch {
        /// Order of the compliance.
        order: usize,
        /// Number of gaps.
        gaps: usize,
    },
    /// A compliance is infinite or not a number.
    #[error("compliance ({row}, {column}) is not finite")]
    ComplianceNotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// A gap is infinite or not a number.
    #[error("gap {index} is not finite")]
    GapNotFinite {
        /// Index, from 0.
        index: usize,
    },
    /// Lemke's path ended in a ray: with a semidefinite compliance no forces close the overlap.
    #[error("no forces can close the gaps: ray after {pivots} pivots")]
    RayTermination {
        /// Pivots until then.
        pivots: usize,
    },
    /// Too many pivots.
    #[error("no solution within {pivots} pivots")]
    PivotLimit {
        /// The limit.
        pivots: usize,
    },
    /// The solution is not accurate enough: the compliance is nearly singular, or not semidefinite.
    #[error("the solution is off by {residual:e} of the problem's scale")]
    Inaccurate {
        /// Its [`kkt_residual`].
        residual: f64,
    },
    /// The interior-point method found no accurate solution.
    #[error("interior point: {0}")]
    InteriorPoint(String),
}

/// A way to solve a [`Problem`].
pub trait ComplementaritySolver {
    /// Short name.
    fn name(&self) -> &'static str;

    /// Solves `problem`. `warm` guesses which cells are in contact; it speeds some solvers up and
    /// changes no result. A guess of another length is ignored.
    ///
    /// # Errors
    /// For unusable input, if no solution exists, or if none is found.
    fn solve(
        &self,
        problem: &Problem<'_>,
        warm: Option<&[bool]>,
    ) -> Result<Solution, ComplementarityError>;

    /// The same with the Cholesky factor of the compliance between the cells in contact, in ascending
    /// order, if the method has it. Compliances of cells that never carry a force may go unread: it
    /// is for compliances known to be finite.
    ///
    /// # Errors
    /// As [`ComplementaritySolver::solve`].
    fn solve_with_factor(
        &self,
        problem: &Problem<'_>,
        warm: Option<&[bool]>,
    ) -> Result<(Solution, Option<Cholesky<f64, Dyn>>), ComplementarityError> {
        Ok((self.solve(problem, warm)?, None))
    }
}

/// How far `forces` (n) are from solving `problem`, dimensionless: the largest of −p/p₀, −w/g₀ and
/// |p w|/(p₀ g₀) with p₀ = max p and g₀ = max |g| (1 where these are 0). Infinite if `forces` are
/// not finite or not n.
pub fn kkt_residual(problem: &Problem<'_>, forces: &[f64]) -> f64 {
    if forces.len() != problem.gaps.len() || forces.iter().any(|p| !p.is_finite()) {
        return f64::INFINITY;
    }
    let force_scale = or_one(forces.iter().fold(0.0, |a, p| p.max(a)));
    let gap_scale = or_one(largest(problem.gaps));
    let mut worst = 0.0f64;
    for (p, w) in forces.iter().zip(separations(problem, forces)) {
        if !w.is_finite() {
            return f64::INFINITY;
        }
        let (p, w) = (p / force_scale, w / gap_scale);
        worst = worst.max(-p).max(-w).max((p * w).abs());
    }
    worst
}

/// Refuses a problem with a compliance that is not square, with sizes that differ, or with values
/// that are not finite.
fn check(problem: &Problem<'_>) -> Result<(), ComplementarityError> {
    check_sizes(problem)?;
    let rows = problem.gaps.len();
    // Whole columns are looked at without a branch for each entry.
    let is_whole = |column: &[f64]| column.iter().fold(true, |whole, c| whole & c.is_finite());
    let all = problem.compliance.as_slice();
    if !all.chunks_exact(rows.max(1)).all(is_whole)
        && let Some(k) = all.iter().position(|c| !c.is_finite())
    {
        // Column-major.
        return Err(ComplementarityError::ComplianceNotFinite { row: k % rows, column: k / rows });
    }
    Ok(())
}

/// Refuses a problem with a compliance that is not square, with sizes that differ, or with gaps that are
/// not finite.
fn check_sizes(problem: &Problem<'_>) -> Result<(), ComplementarityError> {
    let (rows, columns) = problem.compliance.shape();
    if rows != columns {
        return Err(ComplementarityError::NotSquare { rows, columns });
    }
    if rows != problem.gaps.len() {
        let gaps = problem.gaps.len();
        return Err(ComplementarityError::SizeMismatch { order: rows, gaps });
    }
    match problem.gaps.iter().position(|g| !g.is_finite()) {
        Some(index) => Err(ComplementarityError::GapNotFinite { index }),
        None => Ok(()),
    }
}

/// Returns `solution` if its residual is within [`RESIDUAL_LIMIT`].
fn accept(problem: &Problem<'_>, solution: Solution) -> Result<Solution, ComplementarityError> {
    let residual = kkt_residual(problem, &solution.forces);
    if residual <= RESIDUAL_LIMIT {
        Ok(solution)
    } else {
        Err(ComplementarityError::Inaccurate { residual })
    }
}

/// w = C p + g.
fn separations(problem: &Problem<'_>, forces: &[f64]) -> Vec<f64> {
    const AT_ONCE: usize = 4;
    let mut w = problem.gaps.to_vec();
    let (n, c) = (w.len(), problem.compliance.as_slice());
    let column = |j: usize| &c[j * n..(j + 1) * n];
    let loaded: Vec<usize> = (0..n).filter(|j| forces[*j] != 0.0).collect();
    let blocks = loaded.chunks_exact(AT_ONCE);
    for j in blocks.remainder() {
        w.iter_mut().zip(column(*j)).for_each(|(w, c)| *w += c * forces[*j]);
    }
    // Several columns for each pass over w.
    for j in blocks {
        let [p, q, r, s] = [0, 1, 2, 3].map(|k| forces[j[k]]);
        let columns =
            column(j[0]).iter().zip(column(j[1])).zip(column(j[2]).iter().zip(column(j[3])));
        for (w, ((a, b), (c, d))) in w.iter_mut().zip(columns) {
            *w += (a * p + b * q) + (c * r + d * s);
        }
    }
    w
}

/// Scales that bring C and g to order one: largest diagonal (largest entry if that is 0) and
/// largest |g|.
fn scales(problem: &Problem<'_>) -> (f64, f64) {
    let c = problem.compliance;
    let diagonal = (0..c.nrows()).fold(0.0, |a: f64, i| a.max(c[(i, i)]));
    let compliance = if diagonal > 0.0 { diagonal } else { or_one(largest(c.as_slice())) };
    (compliance, or_one(largest(problem.gaps)))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, v| a.max(v.abs()))
}

fn or_one(scale: f64) -> f64 {
    if scale > 0.0 { scale } else { 1.0 }
}
