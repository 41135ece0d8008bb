//! Sparse symmetric matrices and their Cholesky factors.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, Mat, MatMut, Par, Side, get_global_parallelism};

use crate::error::FeError;

/// Entries of a symmetric matrix, lower triangle, repeated entries added.
#[derive(Debug, Clone, Default)]
pub struct Triplets {
    entries: Vec<Triplet<usize, usize, f64>>,
}

impl Triplets {
    /// Adds to (i, j); entries above the diagonal are dropped, being mirrors of those below.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        if i >= j {
            self.entries.push(Triplet::new(i, j, value));
        }
    }

    /// The n×n matrix.
    ///
    /// # Errors
    /// If an entry lies outside.
    pub fn matrix(&self, n: usize, body: &'static str) -> Result<Sparse, FeError> {
        let lower = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &self.entries)
            .map_err(|e| FeError::Factorisation { body, cause: format!("{e:?}") })?;
        Ok(Sparse { lower })
    }
}

/// A sparse symmetric matrix, lower triangle kept.
#[derive(Debug, Clone)]
pub struct Sparse {
    lower: SparseColMat<usize, f64>,
}

impl Sparse {
    /// Order.
    pub fn size(&self) -> usize {
        self.lower.nrows()
    }

    /// Non-zero entries of the lower triangle.
    pub fn entries(&self) -> usize {
        self.lower.compute_nnz()
    }

    /// a A + b B; both of one order.
    ///
    /// # Errors
    /// If the sum cannot be formed.
    pub fn combined(&self, a: f64, other: &Self, b: f64) -> Result<Self, FeError> {
        let failed = |cause: String| FeError::Factorisation { body: "body", cause };
        let list = [(a, &self.lower), (b, &other.lower)];
        let entries: Vec<Triplet<usize, usize, f64>> = list
            .iter()
            .flat_map(|(factor, matrix)| {
                matrix.triplet_iter().map(move |t| Triplet::new(t.row, t.col, factor * t.val))
            })
            .collect();
        let n = self.size();
        let lower = SparseColMat::try_new_from_triplets(n, n, &entries)
            .map_err(|e| failed(format!("{e:?}")))?;
        Ok(Self { lower })
    }

    /// y += factor · A x.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let (starts, rows) = (self.lower.symbolic().col_ptr(), self.lower.symbolic().row_idx());
        let values = self.lower.val();
        for column in 0..x.len() {
            let (mut sum, moved) = (0.0, factor * x[column]);
            for k in starts[column]..starts[column + 1] {
                let (row, value) = (rows[k], values[k]);
                y[row] += value * moved;
                if row != column {
                    sum += value * x[row];
                }
            }
            y[column] += factor * sum;
        }
    }

    /// Factorises it, by columns or by dense blocks of them as its fill suggests.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn factorise(&self, body: &'static str) -> Result<Factor, FeError> {
        self.factorised(body, SupernodalThreshold::AUTO, get_global_parallelism())
    }

    /// Factorises it by dense blocks of columns (supernodes), whatever its fill: many right-hand sides at once are then
    /// solved by products of dense matrices, on one thread.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub(crate) fn factorise_for_many(&self, body: &'static str) -> Result<Factor, FeError> {
        self.factorised(body, SupernodalThreshold::FORCE_SUPERNODAL, Par::Seq)
    }

    fn factorised(
        &self,
        body: &'static str,
        supernodal_flop_ratio_threshold: SupernodalThreshold,
        parallel: Par,
    ) -> Result<Factor, FeError> {
        let failed = |cause: String| FeError::Factorisation { body, cause };
        let params =
            CholeskySymbolicParams { supernodal_flop_ratio_threshold, ..Default::default() };
        let (pattern, side) = (self.lower.symbolic(), Side::Lower);
        let symbolic = factorize_symbolic_cholesky(pattern, side, Default::default(), params)
            .map_err(|e| failed(format!("{e:?}")))?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(parallel, Default::default());
        let mut buffer = MemBuffer::try_new(scratch).map_err(|e| failed(format!("{e:?}")))?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                self.lower.as_ref(),
                side,
                Default::default(),
                parallel,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|e| failed(format!("{e:?}")))?;
        Ok(Factor { symbolic: Arc::new(symbolic), values, parallel, size: self.size() })
    }
}

/// A factorised matrix.
#[derive(Debug, Clone)]
pub struct Factor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    parallel: Par,
    /// Order of the matrix.
    pub size: usize,
}

impl Factor {
    /// Solves for all columns of `right`, in place.
    pub(crate) fn solve(&self, right: &mut Mat<f64>) {
        self.solve_in_place(right.as_mut());
    }

    /// Solves for one right-hand side, in place.
    pub fn solve_one(&self, right: &mut [f64]) {
        let n = right.len();
        self.solve_in_place(MatMut::from_column_major_slice_mut(right, n, 1));
    }

    fn solve_in_place(&self, right: MatMut<'_, f64>) {
        let parallel = self.parallel;
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(right.ncols(), parallel);
        let factor = LltRef::new(&self.symbolic, &self.values);
        let mut buffer = MemBuffer::new(scratch);
        factor.solve_in_place_with_conj(Conj::No, right, parallel, MemStack::new(&mut buffer));
    }
}
