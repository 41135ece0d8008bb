//! The factored matrix of an implicit step.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::error::IntegratorError;

/// S = L Lᵀ of a scheme.
#[derive(Debug, Clone)]
pub(super) struct Factor(Cholesky<f64, Dyn>);

impl Factor {
    /// # Errors
    /// If the matrix is not positive definite.
    pub(super) fn new(
        scheme: &'static str,
        matrix: &'static str,
        s: DMatrix<f64>,
    ) -> Result<Self, IntegratorError> {
        s.cholesky().map(Self).ok_or(IntegratorError::Indefinite { scheme, matrix })
    }

    /// S⁻¹ r.
    pub(super) fn solve(&self, mut r: DVector<f64>) -> DVector<f64> {
        self.0.solve_mut(&mut r);
        r
    }

    /// S⁻¹ R, column by column.
    pub(super) fn solve_all(&self, r: &DMatrix<f64>) -> DMatrix<f64> {
        self.0.solve(r)
    }
}

/// Refuses a step that is not positive and finite.
pub(super) fn check_step(h: f64) -> Result<(), IntegratorError> {
    match h > 0.0 && h.is_finite() {
        true => Ok(()),
        false => Err(IntegratorError::Step(h)),
    }
}
