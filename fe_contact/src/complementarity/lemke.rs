//! Lemke's complementary pivoting.

use nalgebra::{DMatrix, DVector};

use super::{ComplementarityError, ComplementaritySolver, Problem, Solution};
use super::{accept, check, kkt_residual, scales};

/// Pivots below this are taken as 0, relative to the larger of the scaled compliance (1) and the
/// largest entry of their column: with singular compliances smaller pivots amplify rounding errors
/// into forces.
const PIVOT_FLOOR: f64 = 1e-9;
/// Ratios that differ by less than this, relative to 1 plus their size, count as equal.
const TIE: f64 = 1e-13;
/// A ray is accepted as a solution if the overlap it leaves is at most this part of the largest
/// gap: where a solution only just exists, rounding errors would otherwise decide.
const SOLVABLE: f64 = 1e-10;

/// Lemke's complementary pivoting on a dense tableau, with ones as covering vector and the
/// lexicographic ratio test, which rules out cycling.
///
/// For a positive semidefinite compliance it ends at a solution, or in a ray if there is none. The
/// final forces are computed again from the original compliance, so that they do not contain the
/// rounding errors of the tableau. Ignores the warm start.
///
/// `[eq:lemke-pivoting]` w − C p − 1 z₀ = g: z₀ enters first, then the complement of what left, until z₀ leaves.
/// Source: Lemke, Management Science 11 (1965) 681–689; Cottle, Pang & Stone (1992), ch. 4.
/// Checked by: `fe_contact/tests/complementarity.rs::the_solvers_agree_on_random_and_degenerate_problems`,
/// `fe_contact/tests/complementarity.rs::a_problem_solved_by_hand_comes_out`, `fe.convergence.solvers`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Lemke;

impl ComplementaritySolver for Lemke {
    fn name(&self) -> &'static str {
        "Lemke"
    }

    fn solve(
        &self,
        problem: &Problem<'_>,
        _warm: Option<&[bool]>,
    ) -> Result<Solution, ComplementarityError> {
        check(problem)?;
        // Contact problems take one or two pivots per cell; the worst case is exponential.
        solve_within(problem, 100 + 50 * problem.gaps.len())
    }
}

/// Solves a checked problem within `limit` pivots.
fn solve_within(problem: &Problem<'_>, limit: usize) -> Result<Solution, ComplementarityError> {
    let n = problem.gaps.len();
    if problem.gaps.iter().all(|g| *g >= 0.0) {
        return Ok(Solution::zero(n));
    }
    let mut tableau = Tableau::new(problem);
    let mut entering = tableau.start();
    let mut pivots = 1;
    while entering != tableau.artificial() {
        if pivots >= limit {
            return Err(ComplementarityError::PivotLimit { pivots });
        }
        let Some(row) = tableau.leaving_row(entering) else {
            if tableau.overlap() <= SOLVABLE {
                break;
            }
            return Err(ComplementarityError::RayTermination { pivots });
        };
        let left = tableau.basis[row];
        tableau.pivot(row, entering);
        pivots += 1;
        entering = tableau.complement(left);
    }
    let (forces, active) = tableau.solution(problem);
    accept(
        problem,
        Solution { forces: refreshed(problem, &active, forces), active, iterations: pivots },
    )
}

/// w − C p − 1 z₀ = g, row by row. Columns: w (n, the inverse of the basis), p (n), z₀, right side.
struct Tableau {
    n: usize,
    width: usize,
    rows: Vec<f64>,
    /// Variable of each row, by column.
    basis: Vec<usize>,
    /// Force that corresponds to 1 in the scaled problem.
    force_unit: f64,
}

impl Tableau {
    /// The slack basis, scaled so that a covering vector of ones suits.
    fn new(problem: &Problem<'_>) -> Self {
        let n = problem.gaps.len();
        let width = 2 * n + 2;
        let (compliance, gap) = scales(problem);
        let mut rows = vec![0.0; n * width];
        for (i, row) in rows.chunks_exact_mut(width).enumerate() {
            row[i] = 1.0;
            for j in 0..n {
                row[n + j] = -problem.compliance[(i, j)] / compliance;
            }
            row[2 * n] = -1.0;
            row[2 * n + 1] = problem.gaps[i] / gap;
        }
        Self { n, width, rows, basis: (0..n).collect(), force_unit: gap / compliance }
    }

    /// Column of z₀.
    fn artificial(&self) -> usize {
        2 * self.n
    }

    /// Column of the complementary variable, p_i for w_i and w_i for p_i; z₀ is its own.
    fn complement(&self, variable: usize) -> usize {
        if variable == self.artificial() {
            variable
        } else if variable < self.n {
            variable + self.n
        } else {
            variable - self.n
        }
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row * self.width + column]
    }

    /// Pivots z₀ into the row of the largest overlap; returns the column that enters next.
    fn start(&mut self) -> usize {
        let right = self.width - 1;
        // Of equal overlaps the last row is taken, which keeps all rows lexicographically positive.
        let row =
            (0..self.n).fold(0, |a, i| if self.at(i, right) <= self.at(a, right) { i } else { a });
        let left = self.basis[row];
        self.pivot(row, self.artificial());
        self.complement(left)
    }

    /// Value of z₀, the overlap that is left, in units of the largest gap.
    fn overlap(&self) -> f64 {
        let row = self.basis.iter().position(|variable| *variable == self.artificial());
        row.map_or(0.0, |i| self.at(i, self.width - 1))
    }

    /// The row of the lexicographically smallest ratio; none on a ray.
    fn leaving_row(&self, entering: usize) -> Option<usize> {
        let top = (0..self.n).fold(0.0f64, |a, i| a.max(self.at(i, entering).abs()));
        let mut rows: Vec<usize> =
            (0..self.n).filter(|i| self.at(*i, entering) > PIVOT_FLOOR * top.max(1.0)).collect();
        self.keep_smallest(&mut rows, entering, self.width - 1);
        if let Some(end) = rows.iter().find(|i| self.basis[**i] == self.artificial()) {
            // Of equal ratios that of z₀ is taken: once z₀ leaves the basis, the problem is solved.
            return Some(*end);
        }
        for column in 0..self.n {
            if rows.len() < 2 {
                break;
            }
            self.keep_smallest(&mut rows, entering, column);
        }
        rows.first().copied()
    }

    /// Keeps the rows whose ratio of `column` to the pivot column is smallest.
    fn keep_smallest(&self, rows: &mut Vec<usize>, entering: usize, column: usize) {
        let ratio = |i: usize| self.at(i, column) / self.at(i, entering);
        let least = rows.iter().fold(f64::INFINITY, |a, i| a.min(ratio(*i)));
        rows.retain(|i| ratio(*i) <= least + TIE * (1.0 + least.abs()));
    }

    fn pivot(&mut self, row: usize, entering: usize) {
        let (width, right) = (self.width, self.width - 1);
        let divisor = self.at(row, entering);
        let mut pivot_row = self.rows[row * width..(row + 1) * width].to_vec();
        for value in &mut pivot_row {
            *value /= divisor;
        }
        pivot_row[entering] = 1.0;
        for (i, target) in self.rows.chunks_exact_mut(width).enumerate() {
            let factor = target[entering];
            if i == row {
                target.copy_from_slice(&pivot_row);
            } else if factor != 0.0 {
                for (value, p) in target.iter_mut().zip(&pivot_row) {
                    *value -= factor * p;
                }
                target[entering] = 0.0;
                // A right side within rounding of 0 is set to 0, so that it does not become
                // negative.
                target[right] = if target[right].abs() < TIE { 0.0 } else { target[right] };
            }
        }
        self.basis[row] = entering;
    }

    /// Forces and cells in contact of the present basis.
    fn solution(&self, problem: &Problem<'_>) -> (Vec<f64>, Vec<bool>) {
        let mut solution = Solution::zero(problem.gaps.len());
        for (row, variable) in self.basis.iter().enumerate() {
            if (self.n..2 * self.n).contains(variable) {
                let i = variable - self.n;
                solution.forces[i] = (self.at(row, self.width - 1) * self.force_unit).max(0.0);
                solution.active[i] = true;
            }
        }
        (solution.forces, solution.active)
    }
}

/// Forces solved from the original compliance at the cells in contact; the `forces` of the tableau
/// if their residual is smaller, as with a block that is singular to rounding.
fn refreshed(problem: &Problem<'_>, active: &[bool], forces: Vec<f64>) -> Vec<f64> {
    let index: Vec<usize> = (0..active.len()).filter(|i| active[*i]).collect();
    let m = index.len();
    let block = DMatrix::from_fn(m, m, |i, j| problem.compliance[(index[i], index[j])]);
    let right = DVector::from_fn(m, |i, _| -problem.gaps[index[i]]);
    let factors = block.clone().lu();
    let Some(mut p) = factors.solve(&right) else { return forces };
    if let Some(step) = factors.solve(&(&right - &block * &p)) {
        p += step;
    }
    let mut fresh = vec![0.0; active.len()];
    for (i, p) in index.iter().zip(p.iter()) {
        fresh[*i] = p.max(0.0);
    }
    if kkt_residual(problem, &fresh) <= kkt_residual(problem, &forces) { fresh } else { forces }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_few_pivots_are_an_error() {
        let compliance = DMatrix::from_diagonal_element(3, 3, 1.0);
        let problem = Problem { compliance: &compliance, gaps: &[-1.0, -2.0, -3.0] };
        let cut = solve_within(&problem, 2);
        assert_eq!(cut, Err(ComplementarityError::PivotLimit { pivots: 2 }));
        assert_eq!(solve_within(&problem, 9).map(|s| s.forces), Ok(vec![1.0, 2.0, 3.0]));
    }
}
