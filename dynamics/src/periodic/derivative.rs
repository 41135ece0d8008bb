//! The derivative of a map of one period, and Newton's correction from it.

use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use nalgebra::DMatrix;

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

/// Newton's correction towards a fixed point of the map, (I − DΦ) factorised.
#[derive(Debug, Clone)]
pub struct Correction {
    derivative: MapDerivative,
    factor: PartialPivLu<f64>,
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
    pub(super) fn scaled(&self) -> Mat<f64> {
        let (active, s) = (&self.active, &self.scales);
        Mat::from_fn(active.len(), active.len(), |i, j| {
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
        let shifted = Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) - m[(i, j)]);
        let mut follows = vec![false; self.columns.nrows()];
        for column in self.columns.as_slice().chunks_exact(follows.len().max(1)) {
            follows.iter_mut().zip(column).for_each(|(follows, x)| *follows |= *x != 0.0);
        }
        self.active.iter().for_each(|i| follows[*i] = false);
        let following: Vec<usize> = (0..follows.len()).filter(|i| follows[*i]).collect();
        let mut rows = Vec::with_capacity(following.len() * n);
        following.iter().for_each(|i| rows.extend(&self.columns.row(*i)));
        Ok(Correction { factor: shifted.partial_piv_lu(), derivative: self, following, rows })
    }
}

impl Correction {
    /// Δy with (I − DΦ) Δy = r for r = Φ(y) − y, all n coordinates.
    pub fn of(&self, residual: &[f64]) -> Vec<f64> {
        let MapDerivative { active, scales, .. } = &self.derivative;
        let scaled = Mat::from_fn(active.len(), 1, |i, _| residual[active[i]] / scales[active[i]]);
        let solved = self.factor.solve(&scaled);
        let along: Vec<f64> =
            active.iter().enumerate().map(|(k, a)| solved[(k, 0)] * scales[*a]).collect();
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
