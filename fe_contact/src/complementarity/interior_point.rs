//! The equivalent quadratic program by an interior-point method.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::{ComplementarityError, ComplementaritySolver, Problem, RESIDUAL_LIMIT, Solution};
use super::{check, kkt_residual, scales, separations};

/// Tolerance of duality gap and feasibility of the scaled program; double precision allows no
/// smaller one.
const TOLERANCE: f64 = 1e-12;

/// Regularisation of the linear systems. With Clarabel's default of 1e-8, residuals rise in the
/// last iterations of easy problems, which stops it early.
const REGULARISATION: f64 = 1e-12;
/// Added to the scaled diagonal in the second attempt, to bound forces that a singular compliance
/// does not determine.
const RIDGE: f64 = 1e-12;
/// Largest KKT residual that needs no second attempt.
const SOUND: f64 = 1e-9;

/// `[eq:interior-point]` Solves min ½ pᵀ C p + gᵀ p, p ≥ 0, whose conditions of optimality are the complementarity
/// problem, by the interior-point method of Clarabel.
///
/// Source: Goulart & Chen, Clarabel (2024); Cottle, Pang & Stone (1992), ch. 1.
/// Checked by: `fe_contact/tests/complementarity.rs::the_solvers_agree_on_random_and_degenerate_problems`,
/// `fe_contact/tests/complementarity.rs::a_problem_solved_by_hand_comes_out`, `fe.convergence.solvers`.
///
/// It shares no algebra with the pivoting solvers and is the independent check on them. Where
/// contact is just lost, the error of the forces is of the order of √(tolerance/smallest eigenvalue
/// of C); outside contact forces may be tiny instead of 0. Ignores the warm start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct InteriorPoint;

impl ComplementaritySolver for InteriorPoint {
    fn name(&self) -> &'static str {
        "interior point"
    }

    fn solve(
        &self,
        problem: &Problem<'_>,
        _warm: Option<&[bool]>,
    ) -> Result<Solution, ComplementarityError> {
        check(problem)?;
        let n = problem.gaps.len();
        if problem.gaps.iter().all(|g| *g >= 0.0) {
            return Ok(Solution::zero(n));
        }
        let mut best = attempt(problem, 0.0)?;
        if !best.usable || best.residual > SOUND {
            let other = attempt(problem, RIDGE)?;
            if other.rank() < best.rank() {
                best = other;
            }
        }
        if best.usable {
            return Ok(best.solution);
        }
        let cause = format!("{}, residual {:e}", best.status, best.residual);
        Err(ComplementarityError::InteriorPoint(cause))
    }
}

/// Result of one run of Clarabel.
struct Attempt {
    solution: Solution,
    status: SolverStatus,
    residual: f64,
    usable: bool,
}

impl Attempt {
    /// Smaller is better.
    fn rank(&self) -> (bool, f64) {
        (!self.usable, self.residual)
    }
}

fn attempt(problem: &Problem<'_>, ridge: f64) -> Result<Attempt, ComplementarityError> {
    let n = problem.gaps.len();
    let (compliance, gap) = scales(problem);
    let gaps: Vec<f64> = problem.gaps.iter().map(|g| g / gap).collect();
    let mut minus_one = CscMatrix::identity(n);
    minus_one.nzval.fill(-1.0);
    let mut solver = DefaultSolver::new(
        &upper_triangle(problem, compliance, ridge),
        &gaps,
        &minus_one,
        &vec![0.0; n],
        &[NonnegativeConeT(n)],
        settings(),
    )
    .map_err(|cause| ComplementarityError::InteriorPoint(cause.to_string()))?;
    solver.solve();
    let forces: Vec<f64> =
        solver.solution.x.iter().map(|p| (p * gap / compliance).max(0.0)).collect();
    let status = solver.solution.status;
    let residual = kkt_residual(problem, &forces);
    // With singular compliances the largest forces contain rounding errors that Clarabel's status
    // does not show, hence the residual.
    let usable = matches!(
        status,
        SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
    ) && residual <= RESIDUAL_LIMIT;
    // At an interior point neither p nor w is exactly 0: a cell is in contact if its scaled p
    // exceeds w.
    let active = separations(problem, &forces)
        .iter()
        .zip(&forces)
        .map(|(w, p)| p * compliance > *w)
        .collect();
    let iterations = solver.solution.iterations as usize;
    Ok(Attempt { solution: Solution { forces, active, iterations }, status, residual, usable })
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        tol_gap_abs: TOLERANCE,
        tol_gap_rel: TOLERANCE,
        tol_feas: TOLERANCE,
        static_regularization_constant: REGULARISATION,
        ..DefaultSettings::default()
    }
}

/// Upper triangle of C over `scale`, all entries, with `ridge` on the diagonal.
fn upper_triangle(problem: &Problem<'_>, scale: f64, ridge: f64) -> CscMatrix<f64> {
    let n = problem.gaps.len();
    let mut columns = vec![0];
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for j in 0..n {
        for i in 0..=j {
            rows.push(i);
            let own = if i == j { ridge } else { 0.0 };
            values.push(problem.compliance[(i, j)] / scale + own);
        }
        columns.push(rows.len());
    }
    CscMatrix::new(n, n, columns, rows, values)
}
