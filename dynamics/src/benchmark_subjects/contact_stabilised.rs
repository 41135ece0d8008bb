//! Newmark's method with implicit contact forces and a predictor that is projected onto what obstacles allow.
//!
//! Without obstacles it is the trapezoidal rule; with them the energy never grows.

use nalgebra::DVector;

use super::error::IntegratorError;
use super::factor::{Factor, check_step};
use super::integrator::{Integrator, StepForces};
use super::obstacles::Obstacles;
use super::state::StepState;
use super::system::VibratingSystem;

const NAME: &str = "contact-stabilised Newmark";

/// `[eq:contact-stabilised-newmark]` Projected predictor y*, implicit contact force:
/// ```text
/// y* = argmin ½ ‖y − (x₀ + h v₀)‖²_M with d + G y ≥ 0,
/// M (x₁ − y*) = (h²/2) (f − C (x₁ − x₀)/h − K (x₀ + x₁)/2 + Gᵀ λ),   0 ≤ λ ⟂ d + G x₁ ≥ 0,
/// v₁ = v₀ + (2/h) (x₁ − y*).
/// ```
///
/// Source: Deuflhard, Krause & Ertel, Int. J. Numer. Meth. Eng. 73 (2008) 1274–1290.
/// Checked by: `dynamics/tests/integrators.rs::contact_changes_the_energy_by_what_theory_says`,
/// `dynamics/tests/bouncing_bar.rs::dissipative_contact_never_gains`.
#[derive(Debug)]
pub(super) struct ContactStabilised {
    system: VibratingSystem,
    h: f64,
    factor: Factor,
    /// As felt by the mass alone, for the projection.
    predicted: Obstacles,
    obstacles: Obstacles,
}

impl ContactStabilised {
    pub(super) fn new(system: &VibratingSystem, h: f64) -> Result<Self, IntegratorError> {
        check_step(h)?;
        let mass = Factor::new(NAME, "the mass matrix", system.mass.clone())?;
        // S = M + (h/2) C + (h²/4) K
        let s = &system.mass + &system.damping * (0.5 * h) + &system.stiffness * (0.25 * h * h);
        let factor = Factor::new(NAME, "the matrix of a step", s)?;
        let predicted = Obstacles::new(system, &mass);
        let obstacles = Obstacles::new(system, &factor);
        Ok(Self { system: system.clone(), h, factor, predicted, obstacles })
    }
}

impl Integrator for ContactStabilised {
    fn name(&self) -> &'static str {
        NAME
    }

    fn step_under(
        &self,
        state: &mut StepState,
        forces_beside: &StepForces,
    ) -> Result<Option<DVector<f64>>, IntegratorError> {
        let (h, system) = (self.h, &self.system);
        let (x0, v0) = (&state.x, &state.v);
        let mut y = x0 + v0 * h;
        self.predicted.push_out(&mut y, 1.0)?;
        let force = &system.load * (0.5 * h * h) - &system.stiffness * x0 * (0.25 * h * h)
            + &system.damping * x0 * (0.5 * h)
            + (&forces_beside.start + &forces_beside.end) * (0.25 * h * h);
        let mut x1 = self.factor.solve(&system.mass * &y + force);
        let forces = self.obstacles.push_out(&mut x1, 0.5 * h * h)?;
        let v1 = v0 + (&x1 - y) * (2.0 / h);
        state.a = (&v1 - v0) / h;
        (state.x, state.v) = (x1, v1);
        state.forces = forces.iter().copied().collect();
        state.time += h;
        Ok(None)
    }
}
