//! Sparse stiffness matrices and their Cholesky factors.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

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

    /// Factorises the n×n matrix.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn factorise(&self, n: usize, body: &'static str) -> Result<Factor, FeError> {
        let failed = |cause: String| FeError::Factorisation { body, cause };
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &self.entries)
            .map_err(|e| failed(format!("{e:?}")))?;
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower)
            .map_err(|e| failed(format!("{e:?}")))?;
        let llt = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower)
            .map_err(|e| failed(format!("{e:?}")))?;
        Ok(Factor { llt, matrix, size: n })
    }
}

/// A factorised matrix.
#[derive(Debug, Clone)]
pub struct Factor {
    llt: Llt<usize, f64>,
    matrix: SparseColMat<usize, f64>,
    /// Order of the matrix.
    pub size: usize,
}

impl Factor {
    /// Solves for all columns of `right`, in place.
    pub fn solve(&self, right: &mut Mat<f64>) {
        self.llt.solve_in_place(right.as_mut());
    }

    /// Non-zero entries of the lower triangle of the matrix.
    pub fn entries(&self) -> usize {
        self.matrix.compute_nnz()
    }
}
