//! Static equilibrium of a coupled system.
//!
//! The modal coordinates minimise the convex potential ½ qᵀΛq − fᵀq + Σ ∫ F dδ, since the forces grow
//! with deflection: Newton's method with a search along its direction.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::coupling::CouplingForce;
use super::error::CoupledError;
use super::system::Coupled;

/// Iterations after which the search for equilibrium fails.
const MOST_ITERATIONS: usize = 200;

/// Deflection of a coupling under the load by which its auxiliary stiffness is chosen where no other stiffness gives
/// a scale, m. It changes the way to the equilibrium, not the equilibrium.
const LENT_DEFLECTION: f64 = 1e-4;

/// Imbalance over the load that counts as zero.
const NIL: f64 = 1e-12;

impl<L: CouplingForce> Coupled<L> {
    /// Puts the system to rest under its external forces, at its current step of the cycle.
    ///
    /// # Errors
    /// If there is no equilibrium, or it is not found.
    pub fn rest(&mut self) -> Result<(), CoupledError> {
        let n = self.modes.count;
        let (usual, all) = (self.usual.count, self.all());
        let rows = DMatrix::from_fn(n, all.count, |j, k| all.rows[j * all.width + k]);
        let offsets = DVector::from_column_slice(&all.offsets[..all.count]);
        let lambda = DVector::from_column_slice(&self.modes.lambda[..n]);
        let step = self.state.step_in_cycle;
        let load = DVector::from_column_slice(&self.external(step)[..n]);
        // Auxiliary stiffness of couplings out of contact, N/m, for iterations in which nothing else holds
        // the system.
        let widest = rows.column_iter().map(|r| r.norm_squared()).fold(0.0, f64::max);
        let lent = match (widest > 0.0, lambda.amax() > 0.0) {
            (false, _) => 0.0,
            (true, true) => lambda.amax() / widest,
            // Nothing but couplings holds the system (a gear pair on rigid bearings).
            (true, false) => load.amax() / (widest.sqrt() * LENT_DEFLECTION),
        };
        let answer = |q: &DVector<f64>| -> (DVector<f64>, DVector<f64>, DVector<f64>) {
            let delta = rows.tr_mul(q) - &offsets;
            let one = |k: usize| self.law.answer(k, step, delta[k]);
            let (p, d): (Vec<f64>, Vec<f64>) = (0..delta.len()).map(one).unzip();
            let p = DVector::from_vec(p);
            let r = &load - lambda.component_mul(q) - &rows * &p;
            (r, DVector::from_vec(d), p)
        };
        let mut q = DVector::from_column_slice(&self.state.modal.x[..n]);
        if !q.iter().all(|q| q.is_finite()) {
            q.fill(0.0);
        }
        let (mut r, mut d, mut p) = answer(&q);
        let mut done = false;
        let mut residual = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let scale = load.amax().max((&rows * &p).amax());
            residual = if scale > 0.0 { r.amax() / scale } else { r.amax() };
            if residual <= NIL {
                done = true;
                break;
            }
            let hessian = |d: &DVector<f64>| {
                DMatrix::from_diagonal(&lambda)
                    + &rows * DMatrix::from_diagonal(d) * rows.transpose()
            };
            let factor = match definite(hessian(&d)) {
                Some(factor) => factor,
                None => {
                    for d in d.iter_mut().take(usual).filter(|d| **d == 0.0) {
                        *d = lent;
                    }
                    definite(hessian(&d)).ok_or(CoupledError::NothingHolds)?
                }
            };
            let along = factor.solve(&r);
            // The potential's slope along the direction is −slope at the start and −there at the trial, where
            // it should be near zero.
            let slope = along.dot(&r);
            let mut part = 1.0;
            (r, d, p) = loop {
                let trial = &q + part * &along;
                let found = answer(&trial);
                let there = along.dot(&found.0);
                if there >= -0.5 * slope || part < 1e-9 {
                    q = trial;
                    break found;
                }
                // The minimum is overshot: the step is shortened by the secant rule.
                part *= (slope / (slope - there)).clamp(0.1, 0.7);
            };
        }
        if !done {
            let iterations = MOST_ITERATIONS;
            return Err(CoupledError::NoEquilibrium { iterations, residual });
        }
        self.state.modal.x[..n].copy_from_slice(q.as_slice());
        self.state.modal.v.fill(0.0);
        self.state.modal.a.fill(0.0);
        let forces = p.as_slice().to_vec();
        self.state.forces = [forces.clone(), forces];
        Ok(())
    }
}

/// Cholesky factor of a matrix that is positive definite by more than rounding.
fn definite(matrix: DMatrix<f64>) -> Option<Cholesky<f64, nalgebra::Dyn>> {
    let (diagonal, largest) = (matrix.diagonal(), matrix.amax());
    let factor = Cholesky::new(matrix)?;
    let l = factor.l_dirty();
    let least = |i: usize| 1e-11 * diagonal[i].max(1e-4 * largest);
    (0..diagonal.len()).all(|i| l[(i, i)].powi(2) > least(i)).then_some(factor)
}
