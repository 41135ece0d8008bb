//! The interface of this crate uses nalgebra's matrices; they are copied to faer's where faer computes.

use faer::Mat;
use nalgebra::DMatrix;

/// faer's matrix from nalgebra's.
pub(crate) fn to_faer(a: &DMatrix<f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}

/// nalgebra's matrix from faer's.
pub(crate) fn from_faer(a: &Mat<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}
