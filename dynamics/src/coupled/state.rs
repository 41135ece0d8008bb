//! The motion of a coupled system: reading it and setting it.

use super::coupling::CouplingForce;
use super::error::CoupledError;
use super::system::{Coupled, CoupledState};
use crate::newmark::Motion;

impl<L: CouplingForce> Coupled<L> {
    /// Number of coordinates.
    pub fn count(&self) -> usize {
        self.modes.count
    }

    /// The force law of the couplings.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// Coordinate i, m.
    pub fn displacement(&self, i: usize) -> f64 {
        self.modes.coordinate(i, &self.state.modal.x)
    }

    /// All coordinates, m.
    pub fn displacements(&self) -> Vec<f64> {
        (0..self.modes.count).map(|i| self.displacement(i)).collect()
    }

    /// Displacements, velocities and accelerations of all coordinates.
    pub fn motion(&self) -> Motion {
        let modal = &self.state.modal;
        let all = |q: &[f64]| (0..self.modes.count).map(|i| self.modes.coordinate(i, q)).collect();
        Motion { x: all(&modal.x), v: all(&modal.v), a: all(&modal.a) }
    }

    /// Sets displacements and velocities at a step of the cycle; accelerations follow from the balance of
    /// forces.
    ///
    /// # Errors
    /// If there is not one number for each coordinate.
    pub fn set_motion(
        &mut self,
        step_in_cycle: usize,
        x: &[f64],
        v: &[f64],
    ) -> Result<(), CoupledError> {
        self.fits("the displacement", x)?;
        self.fits("the velocity", v)?;
        self.state.step_in_cycle = step_in_cycle % self.steps_per_cycle;
        self.modes.modal(x, &mut self.state.modal.x);
        self.modes.modal(v, &mut self.state.modal.v);
        self.balance();
        Ok(())
    }

    /// Computes coupling forces and accelerations from displacements and velocities.
    pub(super) fn balance(&mut self) {
        let all = self.rare.as_ref().map_or(&self.usual, |(_, all)| all);
        let Motion { x, v, a } = &mut self.state.modal;
        let step = self.state.step_in_cycle;
        let (n, count) = (self.modes.count, all.count);
        let padded = self.steady.len();
        let external = &self.cycle[step * padded..(step + 1) * padded];
        let mut reach = vec![0.0; count];
        all.deflections(x, &mut reach);
        for (k, reach) in reach.iter_mut().enumerate() {
            let rate: f64 = (0..n).map(|j| all.rows[j * all.width + k] * v[j]).sum();
            *reach += all.lags[k] * rate;
        }
        let forces: Vec<f64> =
            reach.iter().enumerate().map(|(k, z)| self.law.answer(k, step, *z).0).collect();
        // q̈ = f − Λ q − ΦᵀCΦ q̇ − Rᵀ P
        let mut damped = vec![0.0; n];
        self.modes.add_damping(v, &mut damped);
        for (j, a) in a.iter_mut().enumerate().take(n) {
            let own = &all.rows[j * all.width..];
            let pressed: f64 = own.iter().zip(&forces).map(|(r, p)| r * p).sum();
            *a = external[j] - self.modes.lambda[j] * x[j] - damped[j] - pressed;
        }
        self.state.forces = [forces.clone(), forces];
    }

    /// The state from which the motion can be continued exactly.
    pub fn state(&self) -> &CoupledState {
        &self.state
    }

    /// Continues exactly from an earlier state of this system.
    ///
    /// # Errors
    /// If the state is of another system.
    pub fn set_state(&mut self, state: &CoupledState) -> Result<(), CoupledError> {
        let padded = self.steady.len();
        let Motion { x, v, a } = &state.modal;
        for (what, got, wanted) in [
            ("the state", x.len(), padded),
            ("the state", v.len(), padded),
            ("the state", a.len(), padded),
            ("the state's forces", state.forces[0].len(), self.all().count),
            ("the state's forces", state.forces[1].len(), self.all().count),
        ] {
            if got != wanted {
                return Err(CoupledError::Size { what, got, wanted });
            }
        }
        self.state.clone_from(state);
        self.state.step_in_cycle %= self.steps_per_cycle;
        Ok(())
    }

    /// Forces of the couplings at the end of the last step, N.
    pub fn forces(&self) -> &[f64] {
        &self.state.forces[0]
    }

    /// Deflections of the couplings at the end of the last step, m.
    pub fn deflections(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.all().count];
        self.all().deflections(&self.state.modal.x, &mut out);
        out
    }

    /// Kinetic energy, and strain energy of the linear part, J; that of the couplings is not included.
    pub fn energies(&self) -> [f64; 2] {
        let Motion { x, v, .. } = &self.state.modal;
        let strain = x.iter().zip(&self.modes.lambda).map(|(q, l)| 0.5 * l * q * q).sum();
        [v.iter().map(|v| 0.5 * v * v).sum(), strain]
    }
}
