//! Central difference, explicit in stiffness: M (x₁ − 2x₀ + x₋₁)/h² + C (x₁ − x₋₁)/2h + K x₀ = f + Gᵀ λ with velocities
//! and accelerations kept; v and a are those without the contact force of the instant.

use nalgebra::DVector;

use super::error::IntegratorError;
use super::factor::{Factor, check_step};
use super::integrator::{Integrator, StepForces};
use super::obstacles::Obstacles;
use super::state::StepState;
use super::system::VibratingSystem;
use crate::symmetric::symmetric_eigen;

const NAME: &str = "central difference";

/// Rounding of Δt·ω_max: a step at the limit itself is not refused for it.
const ROUNDING: f64 = 1e-12;

/// `[eq:central-difference]` Stable up to Δt·ω_max = 2:
/// ```text
/// v_½ = v₀ + ½ h a₀ + h (M + ½ h C)⁻¹ Gᵀ λ,   x₁ = x₀ + h v_½,   0 ≤ λ ⟂ d + G x₁ ≥ 0,
/// (M + ½ h C) a₁ = f − C v_½ − K x₁,   v₁ = v_½ + ½ h a₁.
/// ```
///
/// Source: closed form; contact as in Carpenter, Taylor & Katona, Int. J. Numer. Meth. Eng. 32 (1991).
/// Checked by: `dynamics/tests/integrators.rs::central_difference_is_refused_beyond_its_limit_only`,
/// `dynamics/tests/integrators.rs::schemes_are_of_their_order`.
#[derive(Debug)]
pub(super) struct CentralDifference {
    system: VibratingSystem,
    h: f64,
    factor: Factor,
    obstacles: Obstacles,
}

impl CentralDifference {
    /// # Errors
    /// If the step is beyond the limit of stability, or the mass matrix is not positive definite.
    pub(super) fn new(system: &VibratingSystem, h: f64) -> Result<Self, IntegratorError> {
        let made = Self::unguarded(system, h)?;
        let omega_max = highest_frequency(system)?;
        let product = h * omega_max;
        if product > 2.0 * (1.0 + ROUNDING) {
            let largest = 2.0 / omega_max;
            return Err(IntegratorError::Unstable { product, omega_max, step: h, largest });
        }
        Ok(made)
    }

    /// At any step, to show what happens beyond the limit.
    pub(super) fn unguarded(system: &VibratingSystem, h: f64) -> Result<Self, IntegratorError> {
        check_step(h)?;
        let s = &system.mass + &system.damping * (0.5 * h);
        let factor = Factor::new(NAME, "M + ½ h C", s)?;
        let obstacles = Obstacles::new(system, &factor);
        Ok(Self { system: system.clone(), h, factor, obstacles })
    }
}

/// ω_max of K φ = ω² M φ, rad/s.
pub(super) fn highest_frequency(system: &VibratingSystem) -> Result<f64, IntegratorError> {
    let no_mass = || IntegratorError::Indefinite { scheme: NAME, matrix: "the mass matrix" };
    // L⁻¹ K L⁻ᵀ with M = L Lᵀ
    let l = system.mass.clone().cholesky().ok_or_else(no_mass)?.l();
    let half = l.solve_lower_triangular(&system.stiffness).ok_or_else(no_mass)?;
    let scaled = l.solve_lower_triangular(&half.transpose()).ok_or_else(no_mass)?;
    let (lambda, _) = symmetric_eigen(system.count(), |i, j| scaled[(i.max(j), i.min(j))])?;
    Ok(lambda.last().copied().unwrap_or(0.0).max(0.0).sqrt())
}

impl Integrator for CentralDifference {
    fn name(&self) -> &'static str {
        NAME
    }

    fn step_under(
        &self,
        state: &mut StepState,
        forces_beside: &StepForces,
    ) -> Result<Option<DVector<f64>>, IntegratorError> {
        let (h, system) = (self.h, &self.system);
        let (x0, v0, a0) = (&state.x, &state.v, &state.a);
        let mut x1 = x0 + v0 * h + a0 * (0.5 * h * h);
        let forces = self.obstacles.push_out(&mut x1, h * h)?;
        let half = match self.obstacles.count() {
            0 => v0 + a0 * (0.5 * h),
            _ => (&x1 - x0) / h,
        };
        let a1 = self.factor.solve(
            &system.load + &forces_beside.end - &system.damping * &half - &system.stiffness * &x1,
        );
        state.v = half + &a1 * (0.5 * h);
        (state.x, state.a) = (x1, a1);
        state.forces = forces.iter().copied().collect();
        state.time += h;
        Ok(None)
    }
}
