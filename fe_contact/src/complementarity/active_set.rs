//! Block principal pivoting with a warm start.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::{ComplementarityError, ComplementaritySolver, Lemke, Problem, Solution};
use super::{check, check_sizes, kkt_residual, largest, or_one, separations};

/// Violations below this, relative to the largest force or gap, are rounding.
const FLOOR: f64 = 1e-13;
/// Block exchanges in a row that may fail to reduce the violations.
const PATIENCE: usize = 3;
/// Largest KKT residual of an accepted solution; above it, Lemke's method is used instead.
const SOUND: f64 = 1e-9;

/// Guesses the cells in contact, solves for their forces, exchanges all violating cells at once,
/// and repeats. It is the default because one or two factorisations suffice with a good guess.
///
/// Block principal pivoting exchanges whole blocks while the number of violations falls. After
/// three block exchanges without a new minimum it exchanges one cell at a time by Murty's
/// least-index rule, which ends for every positive definite compliance. If a block is singular, or
/// rounding keeps the method from ending, [`Lemke`] is used. Without a guess it starts from the
/// cells with negative gaps.
///
/// `[eq:block-principal-pivoting]` C_AA p_A = −g_A on the cells A in contact; all cells with p < 0 or w < 0 change
/// sides until there are none.
/// Source: Júdice & Pires, Comput. Oper. Res. 21 (1994) 587–596; Murty, Opsearch 11 (1974) 123–130.
/// Checked by: `fe_contact/tests/complementarity.rs::the_solvers_agree_on_random_and_degenerate_problems`,
/// `fe_contact/tests/complementarity.rs::a_problem_solved_by_hand_comes_out`, `fe.convergence.solvers`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ActiveSet;

impl ComplementaritySolver for ActiveSet {
    fn name(&self) -> &'static str {
        "active set"
    }

    fn solve(
        &self,
        problem: &Problem<'_>,
        warm: Option<&[bool]>,
    ) -> Result<Solution, ComplementarityError> {
        check(problem)?;
        Ok(self.solve_with_factor(problem, warm)?.0)
    }

    fn solve_with_factor(
        &self,
        problem: &Problem<'_>,
        warm: Option<&[bool]>,
    ) -> Result<(Solution, Option<Cholesky<f64, Dyn>>), ComplementarityError> {
        check_sizes(problem)?;
        let n = problem.gaps.len();
        if problem.gaps.iter().all(|g| *g >= 0.0) {
            return Ok((Solution::zero(n), None));
        }
        let start = match warm {
            Some(guess) if guess.len() == n => guess.to_vec(),
            _ => problem.gaps.iter().map(|g| *g < 0.0).collect(),
        };
        match pivot(problem, start) {
            Ok((solution, factor)) => Ok((solution, Some(factor))),
            Err(factorisations) => {
                let mut solution = Lemke.solve(problem, None)?;
                solution.iterations += factorisations;
                Ok((solution, None))
            }
        }
    }
}

/// Block principal pivoting from `active`, with the last block's factor; on failure the number of
/// factorisations done.
fn pivot(
    problem: &Problem<'_>,
    mut active: Vec<bool>,
) -> Result<(Solution, Cholesky<f64, Dyn>), usize> {
    let n = problem.gaps.len();
    // Block exchanges end within about ten iterations, single exchanges within about n.
    let limit = 50 + 4 * n;
    let (mut fewest, mut patience) = (n + 1, PATIENCE);
    for iterations in 1..=limit {
        let block = Block::new(problem, &active).ok_or(iterations)?;
        let violators = block.violators(problem, &active);
        if violators.is_empty() {
            let forces = block.refined(problem);
            let sound = kkt_residual(problem, &forces) <= SOUND;
            return if sound {
                Ok((Solution { forces, active, iterations }, block.factor))
            } else {
                Err(iterations)
            };
        }
        let exchanged = if violators.len() < fewest {
            (fewest, patience) = (violators.len(), PATIENCE);
            &violators[..]
        } else if patience > 0 {
            patience -= 1;
            &violators[..]
        } else {
            &violators[..1]
        };
        for i in exchanged {
            active[*i] = !active[*i];
        }
    }
    Err(limit)
}

/// Cells in contact, with the forces that make w = 0 there.
struct Block {
    index: Vec<usize>,
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    forces: DVector<f64>,
}

impl Block {
    /// None if the compliance of the block is singular to rounding.
    fn new(problem: &Problem<'_>, active: &[bool]) -> Option<Self> {
        let index: Vec<usize> = (0..active.len()).filter(|i| active[*i]).collect();
        let m = index.len();
        let mut entries = Vec::with_capacity(m * m);
        for j in &index {
            let column = problem.compliance.column(*j);
            let column = column.as_slice();
            entries.extend(index.iter().map(|i| column[*i]));
        }
        let matrix = DMatrix::from_vec(m, m, entries);
        let right = DVector::from_fn(m, |i, _| -problem.gaps[index[i]]);
        let factor = Cholesky::new(matrix.clone())?;
        // A pivot of the size of rounding errors may be positive although the block is singular.
        let floor = m as f64 * f64::EPSILON;
        if (0..m).any(|i| factor.l_dirty()[(i, i)].powi(2) <= floor * matrix[(i, i)]) {
            return None;
        }
        let forces = factor.solve(&right);
        Some(Self { index, matrix, right, factor, forces })
    }

    /// Indices of active cells with a tensile force and of inactive cells that overlap, ascending.
    fn violators(&self, problem: &Problem<'_>, active: &[bool]) -> Vec<usize> {
        let forces = self.spread(&self.forces, active.len());
        let separations = separations(problem, &forces);
        let force_floor = FLOOR * largest(&forces);
        let gap_floor = FLOOR * or_one(largest(problem.gaps));
        // Where C has entries of both signs, terms of C p cancel, and the rounding error is that of
        // Σ |C| |p|.
        let terms = |i: usize| -> f64 {
            let column = problem.compliance.column(i);
            column.iter().zip(&forces).map(|(c, p)| c.abs() * p.abs()).sum()
        };
        (0..active.len())
            .filter(|i| {
                if active[*i] {
                    forces[*i] < -force_floor
                } else {
                    separations[*i] < -gap_floor
                        && separations[*i] < -2.0 * f64::EPSILON * terms(*i)
                }
            })
            .collect()
    }

    /// Forces after one step of iterative refinement.
    fn refined(&self, problem: &Problem<'_>) -> Vec<f64> {
        let residual = &self.right - &self.matrix * &self.forces;
        let forces = &self.forces + self.factor.solve(&residual);
        let mut forces = self.spread(&forces, problem.gaps.len());
        forces.iter_mut().for_each(|p| *p = p.max(0.0));
        forces
    }

    /// Values of the block at their cells among n, 0 elsewhere.
    fn spread(&self, block: &DVector<f64>, n: usize) -> Vec<f64> {
        let mut all = vec![0.0; n];
        for (i, value) in self.index.iter().zip(block.iter()) {
            all[*i] = *value;
        }
        all
    }
}
