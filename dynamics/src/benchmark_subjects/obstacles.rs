//! Obstacles as a factored step feels them.

use nalgebra::{DMatrix, DVector};

use super::complementarity::solve;
use super::error::IntegratorError;
use super::factor::Factor;
use super::system::VibratingSystem;

/// G, S⁻¹ Gᵀ and G S⁻¹ Gᵀ of a step with matrix S.
#[derive(Debug, Clone)]
pub(super) struct Obstacles {
    /// G, m×n.
    rows: DMatrix<f64>,
    /// d, m.
    clearance: DVector<f64>,
    /// S⁻¹ Gᵀ, n×m.
    response: DMatrix<f64>,
    /// G S⁻¹ Gᵀ, m×m.
    delassus: DMatrix<f64>,
}

impl Obstacles {
    pub(super) fn new(system: &VibratingSystem, factor: &Factor) -> Self {
        let rows = system.rows.clone();
        let response = factor.solve_all(&rows.transpose());
        let delassus = &rows * &response;
        Self { rows, clearance: system.clearance.clone(), response, delassus }
    }

    pub(super) fn count(&self) -> usize {
        self.clearance.len()
    }

    /// Moves x to x + s S⁻¹ Gᵀ λ with 0 ≤ λ ⟂ d + G x ≥ 0; returns λ.
    pub(super) fn push_out(
        &self,
        x: &mut DVector<f64>,
        s: f64,
    ) -> Result<DVector<f64>, IntegratorError> {
        if self.count() == 0 {
            return Ok(DVector::zeros(0));
        }
        let gap = &self.clearance + &self.rows * &*x;
        // In units of s λ, so that pivots do not depend on the step.
        let pushed = solve(&self.delassus, &gap)?;
        *x += &self.response * &pushed;
        Ok(pushed / s)
    }

    /// Gaps d + G x.
    pub(super) fn gaps(&self, x: &DVector<f64>) -> DVector<f64> {
        &self.clearance + &self.rows * x
    }

    /// G v.
    pub(super) fn closing(&self, v: &DVector<f64>) -> DVector<f64> {
        &self.rows * v
    }

    /// Impulses 0 ≤ p ⟂ G (v + S⁻¹ Gᵀ p) + r ≥ 0 of the obstacles `own`, the others 0; v is changed by them.
    pub(super) fn strike(
        &self,
        v: &mut DVector<f64>,
        own: &[usize],
        r: &DVector<f64>,
    ) -> Result<DVector<f64>, IntegratorError> {
        let mut impulses = DVector::zeros(self.count());
        if own.is_empty() {
            return Ok(impulses);
        }
        let block = self.delassus.select_rows(own).select_columns(own);
        let q = (self.closing(v) + r).select_rows(own);
        let solved = solve(&block, &q)?;
        own.iter().zip(solved.iter()).for_each(|(&i, p)| impulses[i] = *p);
        *v += &self.response * &impulses;
        Ok(impulses)
    }
}
