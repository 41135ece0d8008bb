//! Families of equations over one parameter.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Residual of F(y, λ) and its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// F, n entries.
    pub residual: DVector<f64>,
    /// ∂F/∂y, n×n.
    pub jacobian: DMatrix<f64>,
    /// ∂F/∂λ, n entries.
    pub derivative: DVector<f64>,
}

/// What a family says about one of its solutions.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Judgement {
    /// Whether the solution is stable, if the family knows.
    pub is_stable: Option<bool>,
    /// Test functions, the same number at every point, each continuous along a branch: a change of sign is a
    /// bifurcation and is located. Folds are found without one.
    pub tests: Vec<f64>,
}

/// Equations F(y, λ) = 0, as many as unknowns y.
pub trait Family {
    /// Why F cannot be evaluated.
    type Error: std::error::Error;

    /// Number n of unknowns and of equations.
    fn dimension(&self) -> usize;

    /// F and its derivatives at y (n entries) and λ.
    ///
    /// # Errors
    /// If F is not defined there; continuation then takes a shorter step.
    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, Self::Error>;

    /// Stability and test functions of a solution.
    ///
    /// # Errors
    /// If they cannot be computed.
    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, Self::Error> {
        let _ = (y, lambda);
        Ok(Judgement::default())
    }
}
