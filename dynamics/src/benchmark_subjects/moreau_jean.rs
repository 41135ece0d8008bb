//! Moreau–Jean time stepping: the θ-method with impulses on velocities and Newton's impact law.

use nalgebra::DVector;

use super::error::IntegratorError;
use super::factor::{Factor, check_step};
use super::integrator::{Integrator, StepForces};
use super::obstacles::Obstacles;
use super::state::StepState;
use super::system::VibratingSystem;

const NAME: &str = "Moreau–Jean";

/// `[eq:moreau-jean]` Impulses with Newton's impact law; without damping the energy changes by ½ (1 − e) (G v₀)ᵀ
/// p ≤ 0 in a step for θ = ½:
/// ```text
/// M (v₁ − v₀) + h C v_θ + h K x_θ = h f + Gᵀ p,   x₁ = x₀ + h v_θ,   y_θ = (1−θ) y₀ + θ y₁,
/// 0 ≤ p ⟂ G v₁ + e G v₀ ≥ 0 where d + G (x₀ + ½ h v₀) ≤ 0, else p = 0.
/// ```
///
/// Source: Acary, Z. Angew. Math. Mech. 96 (2016) 585–603.
/// Checked by: `dynamics/tests/integrators.rs::contact_changes_the_energy_by_what_theory_says`,
/// `dynamics/tests/bouncing_bar.rs`.
#[derive(Debug)]
pub(super) struct MoreauJean {
    system: VibratingSystem,
    h: f64,
    theta: f64,
    restitution: f64,
    factor: Factor,
    obstacles: Obstacles,
}

impl MoreauJean {
    pub(super) fn new(
        theta: f64,
        restitution: f64,
        system: &VibratingSystem,
        h: f64,
    ) -> Result<Self, IntegratorError> {
        check_step(h)?;
        // An impulse needs inertia to act on.
        if !system.clearance.is_empty() {
            Factor::new(NAME, "the mass matrix", system.mass.clone())?;
        }
        // S = M + h θ C + h² θ² K
        let s = &system.mass
            + &system.damping * (h * theta)
            + &system.stiffness * (h * h * theta * theta);
        let factor = Factor::new(NAME, "the matrix of a step", s)?;
        let obstacles = Obstacles::new(system, &factor);
        Ok(Self { system: system.clone(), h, theta, restitution, factor, obstacles })
    }
}

impl Integrator for MoreauJean {
    fn name(&self) -> &'static str {
        NAME
    }

    fn step_under(
        &self,
        state: &mut StepState,
        forces_beside: &StepForces,
    ) -> Result<Option<DVector<f64>>, IntegratorError> {
        let (h, theta, system) = (self.h, self.theta, &self.system);
        let (x0, v0) = (&state.x, &state.v);
        let rest = 1.0 - theta;
        // S v₁ = M v₀ + h (f − (1−θ) C v₀ − K (x₀ + h θ (1−θ) v₀)) + Gᵀ p
        let force = &system.load
            - &system.damping * v0 * rest
            - &system.stiffness * (x0 + v0 * (h * theta * rest))
            + &forces_beside.end * theta
            + &forces_beside.start * rest;
        let mut v1 = self.factor.solve(&system.mass * v0 + force * h);
        let ahead = self.obstacles.gaps(&(x0 + v0 * (0.5 * h)));
        let own: Vec<usize> = (0..ahead.len()).filter(|&i| ahead[i] <= 0.0).collect();
        let returned = self.obstacles.closing(v0) * self.restitution;
        let impulses = self.obstacles.strike(&mut v1, &own, &returned)?;
        let x1 = x0 + (v0 * rest + &v1 * theta) * h;
        state.a = (&v1 - v0) / h;
        (state.x, state.v) = (x1, v1);
        state.forces = impulses.iter().map(|p| p / h).collect();
        state.time += h;
        Ok(None)
    }
}
