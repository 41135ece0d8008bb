//! Errors of eigenproblems and spectra.

/// Why an eigenproblem has no solution, or none of sufficient accuracy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EigenError {
    /// A matrix that is not square, or not of the size of the mass matrix.
    #[error("a {rows}×{columns} matrix does not go with {masses} masses")]
    Size {
        /// Rows of the matrix.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Number of masses.
        masses: usize,
    },
    /// A mass that is not positive and finite.
    #[error("mass {value} of coordinate {index} is not positive and finite")]
    Mass {
        /// Coordinate.
        index: usize,
        /// Its mass.
        value: f64,
    },
    /// A matrix entry that is not finite.
    #[error("matrix entry ({row}, {column}) is not finite")]
    NotFinite {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
    },
    /// The iteration did not converge.
    #[error("the eigenvalue iteration did not converge (size {size})")]
    NoConvergence {
        /// Size of the matrix.
        size: usize,
    },
    /// The solution does not satisfy the equations.
    #[error("eigenvector residual {residual:e} is above {limit:e} (size {size})")]
    Residual {
        /// Largest ‖Kφ − λMφ‖ in mass-normalised form, relative to the largest |λ|.
        residual: f64,
        /// What is allowed.
        limit: f64,
        /// Size of the matrix.
        size: usize,
    },
}

/// Why a record has no spectrum.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// A record of fewer than two samples.
    #[error("a record of {samples} samples is too short for a spectrum")]
    TooShort {
        /// Number of samples.
        samples: usize,
    },
    /// A sample interval that is not positive and finite.
    #[error("sample interval {value} s is not positive and finite")]
    Interval {
        /// The interval, s.
        value: f64,
    },
    /// A sample that is not finite.
    #[error("sample {sample} is not finite")]
    NotFinite {
        /// Its index.
        sample: usize,
    },
    /// A padded length of zero, or above the limit.
    #[error("padding to {value} times the length is not possible")]
    Padding {
        /// The factor.
        value: usize,
    },
}
