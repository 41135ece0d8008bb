//! The derivative of a map of one period, and Newton's correction from it.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::error::EigenError;

/// Derivative DΦ of the n coordinates at the end of a period with respect to those at its start.
///
/// Coordinates without columns either have no effect, or are gone within the period and follow from the active
/// ones, as they do before the start of every period: the columns then are the effects of changes of active
/// coordinates with all others following.
#[derive(Debug, Clone, PartialEq)]
pub struct MapDerivative {
    /// Coordinates whose columns are given, ascending.
    pub active: Vec<usize>,
    /// The columns of the active coordinates, n×(number of active coordinates).
    pub columns: DMatrix<f64>,
    /// Typical size of each coordinate beside that of a displacement, n: matrices are scaled by these before
    /// they are factorised.
    pub scales: Vec<f64>,
}

/// A change of the state at the start of a period, carried over its steps beside the derivative.
pub struct CarriedChange<'c> {
    /// Changes of all coordinates at the start, n.
    pub start: &'c [f64],
    /// Hears at the start of every step what has become of the displacements, the leading coordinates.
    pub hear: &'c mut dyn FnMut(&[f64]),
}

/// Newton's correction towards a fixed point of the map, (I − DΦ) factorised.
#[derive(Debug, Clone)]
pub struct Correction {
    derivative: MapDerivative,
    factor: LU<f64, Dyn, Dyn>,
    /// Coordinates without a column that change with the active ones, and their rows of DΦ one after another.
    following: Vec<usize>,
    rows: Vec<f64>,
}

impl MapDerivative {
    /// Derivative of two periods in a row: this one after `first`.
    pub fn after(&self, first: &Self) -> Self {
        let columns = &self.columns * first.columns.select_rows(&self.active);
        Self { active: first.active.clone(), columns, scales: first.scales.clone() }
    }

    /// The rows and columns of the active coordinates, scaled: S⁻¹ DΦ S.
    pub(super) fn scaled(&self) -> DMatrix<f64> {
        let (active, s) = (&self.active, &self.scales);
        DMatrix::from_fn(active.len(), active.len(), |i, j| {
            self.columns[(active[i], j)] * s[active[j]] / s[active[i]]
        })
    }

    /// Factorises I − DΦ.
    ///
    /// # Errors
    /// If an entry is not finite.
    pub fn correction(self) -> Result<Correction, EigenError> {
        let m = self.scaled();
        let n = m.nrows();
        for column in 0..n {
            for row in 0..n {
                if !m[(row, column)].is_finite() {
                    return Err(EigenError::NotFinite { row, column });
                }
            }
        }
        let shifted = DMatrix::identity(n, n) - m;
        let mut follows = vec![false; self.columns.nrows()];
        for column in self.columns.as_slice().chunks_exact(follows.len().max(1)) {
            follows.iter_mut().zip(column).for_each(|(follows, x)| *follows |= *x != 0.0);
        }
        self.active.iter().for_each(|i| follows[*i] = false);
        let following: Vec<usize> = (0..follows.len()).filter(|i| follows[*i]).collect();
        let mut rows = Vec::with_capacity(following.len() * n);
        following.iter().for_each(|i| rows.extend(&self.columns.row(*i)));
        Ok(Correction { factor: shifted.lu(), derivative: self, following, rows })
    }
}

impl Correction {
    /// `[eq:shooting]` Δy with (I − DΦ) Δy = r for r = Φ(y) − y, all n coordinates.
    ///
    /// Source: derived here.
    /// Checked by: `experiments/tests/shooting/derivative.rs::the_derivative_is_that_of_the_cycle`,
    /// `experiments/tests/shooting/agreement.rs`, `dynamics/tests/periodic.rs::shooting_lands_where_marching_does`.
    pub fn of(&self, residual: &[f64]) -> Vec<f64> {
        let MapDerivative { active, scales, .. } = &self.derivative;
        let scaled = active.iter().map(|a| residual[*a] / scales[*a]);
        let mut solved = DVector::from_iterator(active.len(), scaled);
        if !self.factor.solve_mut(&mut solved) {
            // A multiplier of 1 to the bit: no correction is finite.
            solved.fill(f64::INFINITY);
        }
        let along: Vec<f64> = solved.iter().zip(active).map(|(x, a)| x * scales[*a]).collect();
        // Coordinates without a column: Δy_j = r_j + Σ DΦ_ja Δy_a.
        let mut change = residual.to_vec();
        for (i, row) in self.following.iter().zip(self.rows.chunks_exact(along.len().max(1))) {
            change[*i] += row.iter().zip(&along).map(|(m, a)| m * a).sum::<f64>();
        }
        active.iter().zip(&along).for_each(|(a, along)| change[*a] = *along);
        change
    }

    /// The derivative it was made from.
    pub fn derivative(&self) -> &MapDerivative {
        &self.derivative
    }
}
