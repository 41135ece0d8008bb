//! The generalised-α family: average acceleration, HHT-α and Chung & Hulbert's scheme.

use nalgebra::DVector;

use super::error::IntegratorError;
use super::factor::{Factor, check_step};
use super::integrator::{Integrator, StepForces};
use super::obstacles::Obstacles;
use super::state::StepState;
use super::system::VibratingSystem;

/// α_m, α_f, β, γ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights {
    pub(super) alpha_m: f64,
    pub(super) alpha_f: f64,
    pub(super) beta: f64,
    pub(super) gamma: f64,
}

impl Weights {
    /// Second order and largest damping of high frequencies: γ = ½ − α_m + α_f, β = ¼ (1 − α_m + α_f)²
    /// (Chung & Hulbert).
    fn of(alpha_m: f64, alpha_f: f64) -> Self {
        let shift = alpha_f - alpha_m;
        let beta = 0.25 * (1.0 + shift) * (1.0 + shift);
        Self { alpha_m, alpha_f, beta, gamma: 0.5 + shift }
    }

    /// Newmark's γ = ½, β = ¼.
    pub(super) fn average_acceleration() -> Self {
        Self::of(0.0, 0.0)
    }

    /// −⅓ ≤ α ≤ 0: α_m = 0, α_f = −α.
    pub(super) fn hht(alpha: f64) -> Self {
        Self::of(0.0, -alpha)
    }

    /// By the spectral radius ρ_∞ at infinite frequency: α_m = (2ρ_∞ − 1)/(ρ_∞ + 1), α_f = ρ_∞/(ρ_∞ + 1).
    pub(super) fn chung_hulbert(rho: f64) -> Self {
        Self::of((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }
}

/// `[eq:generalised-alpha]` Average acceleration (α_m = α_f = 0, γ = ½, β = ¼), HHT-α and Chung & Hulbert's scheme:
/// ```text
/// M a_(1−α_m) + C v_(1−α_f) + K x_(1−α_f) = f + Gᵀ λ_(1−α_f),   y_(1−α) = (1−α) y₁ + α y₀,
/// x₁ = x₀ + h v₀ + h² ((½−β) a₀ + β a₁),   v₁ = v₀ + h ((1−γ) a₀ + γ a₁),
/// 0 ≤ λ₁ ⟂ d + G x₁ ≥ 0.
/// ```
///
/// Source: Chung & Hulbert, J. Appl. Mech. 60 (1993) 371–375; Hilber, Hughes & Taylor, Earthq. Eng. Struct. Dyn. 5
/// (1977) 283–292.
/// Checked by: `dynamics/tests/integrators.rs::steps_amplify_as_the_closed_forms_say`,
/// `dynamics/tests/integrators.rs::schemes_are_of_their_order`.
#[derive(Debug)]
pub(super) struct GeneralizedAlpha {
    name: &'static str,
    system: VibratingSystem,
    h: f64,
    weights: Weights,
    factor: Factor,
    obstacles: Obstacles,
}

impl GeneralizedAlpha {
    pub(super) fn new(
        name: &'static str,
        weights: Weights,
        system: &VibratingSystem,
        h: f64,
    ) -> Result<Self, IntegratorError> {
        check_step(h)?;
        let Weights { alpha_m, alpha_f, beta, gamma } = weights;
        // S = (1−α_m) M + (1−α_f) (γ h C + β h² K)
        let s = &system.mass * (1.0 - alpha_m)
            + (&system.damping * (gamma * h) + &system.stiffness * (beta * h * h))
                * (1.0 - alpha_f);
        let factor = Factor::new(name, "the matrix of a step", s)?;
        let obstacles = Obstacles::new(system, &factor);
        Ok(Self { name, system: system.clone(), h, weights, factor, obstacles })
    }
}

impl Integrator for GeneralizedAlpha {
    fn name(&self) -> &'static str {
        self.name
    }

    fn step_under(
        &self,
        state: &mut StepState,
        forces_beside: &StepForces,
    ) -> Result<Option<DVector<f64>>, IntegratorError> {
        let Weights { alpha_m, alpha_f, beta, gamma } = self.weights;
        let (h, system) = (self.h, &self.system);
        let StepState { x, v, a, forces, .. } = &*state;
        let xp = x + v * h + a * (h * h * (0.5 - beta));
        let vp = v + a * (h * (1.0 - gamma));
        // What a₁ = 0 leaves of C v_(1−α_f) and K x_(1−α_f).
        let xf = &xp * (1.0 - alpha_f) + x * alpha_f;
        let vf = &vp * (1.0 - alpha_f) + v * alpha_f;
        let mut force = &system.load - &system.mass * a * alpha_m;
        force += &forces_beside.end * (1.0 - alpha_f) + &forces_beside.start * alpha_f;
        force -= &system.damping * vf + &system.stiffness * xf;
        if alpha_f != 0.0 && self.obstacles.count() > 0 {
            let before = DVector::from_column_slice(forces);
            force += system.rows.transpose() * before * alpha_f;
        }
        let free = self.factor.solve(force);
        let mut x1 = &xp + &free * (beta * h * h);
        let scale = beta * h * h * (1.0 - alpha_f);
        let forces = self.obstacles.push_out(&mut x1, scale)?;
        // x₁ = x_p + β h² a₁
        let a1 = match self.obstacles.count() {
            0 => free,
            _ => (&x1 - &xp) / (beta * h * h),
        };
        state.v = vp + &a1 * (h * gamma);
        (state.x, state.a) = (x1, a1);
        state.forces = forces.iter().copied().collect();
        state.time += h;
        Ok(None)
    }
}
