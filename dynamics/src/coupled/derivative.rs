//! The derivative of the steps of a coupled system with respect to displacements and velocities of its modes at
//! the start of a period.
//!
//! ```text
//! x₁' = A⁻¹ (a*' + C v*') − A⁻¹ Rᵀ D z',   (I + g Y D) z' = g R A⁻¹ (a*' + C v*') − τ R v*',   g = 1 + 2τ/h
//! ```
//!
//! with D the tangents of the couplings that act in the step, at the displacements found for its end.

use nalgebra::{DMatrix, DVector};

use super::condensed::Condensed;
use super::coupling::CouplingForce;
use super::error::CoupledError;
use super::system::Coupled;
use crate::periodic::MapDerivative;

/// Gradients of displacements, velocities and accelerations of the modes: one column for each mode, one row for
/// each of the 2n coordinates (displacements, velocities) at the start.
#[derive(Debug, Clone)]
pub struct CoupledDerivative {
    x: DMatrix<f64>,
    v: DMatrix<f64>,
    a: DMatrix<f64>,
}

impl<L: CouplingForce> Coupled<L> {
    /// Displacements and velocities of the modes, 2n: they determine the motion that follows.
    pub fn coordinates(&self) -> Vec<f64> {
        let n = self.modes.count;
        [&self.state.modal.x[..n], &self.state.modal.v[..n]].concat()
    }

    /// Continues from displacements and velocities of the modes at the present step of the cycle; accelerations
    /// follow from the balance of forces.
    ///
    /// # Errors
    /// If there are not 2n finite numbers.
    pub fn set_coordinates(&mut self, y: &[f64]) -> Result<(), CoupledError> {
        let n = self.modes.count;
        if y.len() != 2 * n {
            return Err(CoupledError::Size { what: "the state", got: y.len(), wanted: 2 * n });
        }
        if let Some(value) = y.iter().copied().find(|value| !value.is_finite()) {
            let (time_s, coordinate) = (self.time(), 0);
            return Err(CoupledError::Diverged { time_s, coordinate, value });
        }
        self.state.modal.x[..n].copy_from_slice(&y[..n]);
        self.state.modal.v[..n].copy_from_slice(&y[n..]);
        self.balance();
        Ok(())
    }

    /// Coordinates of the system that the displacements in `y` (2n, as [`Coupled::coordinates`]) amount to, n, m.
    pub fn displacements_of(&self, y: &[f64]) -> Vec<f64> {
        (0..self.modes.count).map(|i| self.modes.coordinate(i, y)).collect()
    }

    /// The derivative at the start of a period: one in the coordinates themselves.
    pub fn start_derivative(&self) -> CoupledDerivative {
        let n = self.modes.count;
        let x = DMatrix::from_fn(2 * n, n, |row, j| f64::from(u8::from(row == j)));
        let v = DMatrix::from_fn(2 * n, n, |row, j| f64::from(u8::from(row == n + j)));
        let all = self.all();
        // a' = −Λ x' − C v' − Rᵀ D (R x' + τ R v')
        let mut a = -self.damped(&v);
        for (j, lambda) in self.modes.lambda.iter().enumerate().take(n) {
            a.column_mut(j).axpy(-lambda, &x.column(j), 1.0);
        }
        for (k, tangent) in self.tangents(all).into_iter().enumerate() {
            if tangent != 0.0 {
                let z = all.along(k, &x) + all.along(k, &v) * all.lags[k];
                for j in 0..n {
                    a.column_mut(j).axpy(-tangent * all.rows[j * all.width + k], &z, 1.0);
                }
            }
        }
        CoupledDerivative { x, v, a }
    }

    /// Carries the derivative over the last step.
    pub fn carry_derivative(&self, d: &mut CoupledDerivative) {
        let n = self.modes.count;
        let group = if self.took_rare { self.all() } else { &self.usual };
        let (inertia, rate) = (self.rule.inertia(), self.rule.damping());
        let acceleration = &d.x * inertia + &d.v * (2.0 * rate) + &d.a;
        let velocity = &d.x * rate + &d.v;
        let load = &acceleration + self.damped(&velocity);
        let mut next = match &self.modes.own_damping {
            Some(_) => {
                let mut free = load;
                for (j, inverse) in self.modes.own_inverse.iter().enumerate().take(n) {
                    free.column_mut(j).scale_mut(*inverse);
                }
                free
            }
            // (A⁻¹ g)ᵀ = gᵀ A⁻ᵀ
            None => load * DMatrix::from_fn(n, n, |i, j| self.modes.inverse[(j, i)]),
        };
        let tangents = self.tangents(group);
        let acting: Vec<usize> = (0..group.count).filter(|k| tangents[*k] != 0.0).collect();
        if !acting.is_empty() {
            let gain = |k: usize| 1.0 + group.lags[k] * rate;
            let mut z = DMatrix::zeros(acting.len(), 2 * n);
            for (row, k) in acting.iter().enumerate() {
                let mut own = group.along(*k, &next) * gain(*k);
                if group.lags[*k] != 0.0 {
                    own.axpy(-group.lags[*k], &group.along(*k, &velocity), 1.0);
                }
                z.row_mut(row).tr_copy_from(&own);
            }
            let matrix = DMatrix::from_fn(acting.len(), acting.len(), |i, j| {
                let (k, l) = (acting[i], acting[j]);
                let own = gain(k) * group.receptance[l * group.width + k] * tangents[l];
                own + f64::from(u8::from(i == j))
            });
            // The matrix is as well-conditioned as that of the step, which was solved.
            let _ = matrix.lu().solve_mut(&mut z);
            let padded = self.steady.len();
            for (row, k) in acting.iter().enumerate() {
                let force = z.row(row).transpose() * tangents[*k];
                let answer = &group.answers[k * padded..k * padded + n];
                for (j, share) in answer.iter().enumerate() {
                    next.column_mut(j).axpy(-share, &force, 1.0);
                }
            }
        }
        d.v = &next * rate - velocity;
        d.a = &next * inertia - acceleration;
        d.x = next;
    }

    /// The derivative of the map from the start to now; frequencies are of the order of `rate` (rad/s).
    pub fn map_derivative(&self, d: &CoupledDerivative, rate: f64) -> MapDerivative {
        let n = self.modes.count;
        let of = |i: usize, j: usize| if i < n { d.x[(j, i)] } else { d.v[(j, i - n)] };
        MapDerivative {
            active: (0..2 * n).collect(),
            columns: DMatrix::from_fn(2 * n, 2 * n, of),
            scales: (0..2 * n).map(|i| if i < n { 1.0 } else { rate }).collect(),
        }
    }

    /// (C v)' by columns.
    fn damped(&self, v: &DMatrix<f64>) -> DMatrix<f64> {
        let n = self.modes.count;
        match &self.modes.own_damping {
            Some(own) => {
                let mut out = v.clone();
                for (j, c) in own.iter().enumerate().take(n) {
                    out.column_mut(j).scale_mut(*c);
                }
                out
            }
            None => v * DMatrix::from_fn(n, n, |i, j| self.modes.damping[(j, i)]),
        }
    }

    /// Tangents of a group's couplings at the present state, N/m.
    fn tangents(&self, group: &Condensed) -> Vec<f64> {
        let (n, step) = (self.modes.count, self.state.step_in_cycle);
        let mut reach = vec![0.0; group.count];
        group.deflections(&self.state.modal.x, &mut reach);
        for (k, reach) in reach.iter_mut().enumerate() {
            let v = &self.state.modal.v;
            let rate: f64 = (0..n).map(|j| group.rows[j * group.width + k] * v[j]).sum();
            *reach += group.lags[k] * rate;
        }
        reach.iter().enumerate().map(|(k, z)| self.law.answer(k, step, *z).1).collect()
    }
}

impl Condensed {
    /// Gradient of R x of one coupling, for gradients of the modes by columns.
    fn along(&self, coupling: usize, x: &DMatrix<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(x.nrows());
        for (j, column) in x.column_iter().enumerate() {
            out.axpy(self.rows[j * self.width + coupling], &column, 1.0);
        }
        out
    }
}
