//! Bathe's composite scheme: half a step by the trapezoidal rule, half by three-point backward differences.

use nalgebra::DVector;

use super::error::IntegratorError;
use super::factor::{Factor, check_step};
use super::integrator::{Integrator, StepForces};
use super::obstacles::Obstacles;
use super::state::StepState;
use super::system::VibratingSystem;

const NAME: &str = "Bathe composite";

/// One of the substeps: a = p x − …, v = q x − …, so that S = p M + q C + K.
#[derive(Debug)]
struct Substep {
    factor: Factor,
    obstacles: Obstacles,
}

impl Substep {
    fn new(system: &VibratingSystem, p: f64, q: f64) -> Result<Self, IntegratorError> {
        let s = &system.mass * p + &system.damping * q + &system.stiffness;
        let factor = Factor::new(NAME, "the matrix of a substep", s)?;
        Ok(Self { obstacles: Obstacles::new(system, &factor), factor })
    }

    /// S x = f + M a* + C v* + Gᵀ λ.
    fn solve(
        &self,
        system: &VibratingSystem,
        a_star: &DVector<f64>,
        v_star: &DVector<f64>,
        beside: &DVector<f64>,
    ) -> Result<(DVector<f64>, DVector<f64>), IntegratorError> {
        let force = &system.load + beside + &system.mass * a_star + &system.damping * v_star;
        let mut x = self.factor.solve(force);
        let forces = self.obstacles.push_out(&mut x, 1.0)?;
        Ok((x, forces))
    }
}

/// `[eq:bathe-scheme]` Balance and gap ≥ 0 at both instants:
/// ```text
/// x_m = x₀ + (h/4)(v₀ + v_m),   v_m = v₀ + (h/4)(a₀ + a_m),
/// v₁ = (x₀ − 4 x_m + 3 x₁)/h,   a₁ = (v₀ − 4 v_m + 3 v₁)/h.
/// ```
///
/// Source: Bathe, Comput. Struct. 85 (2007) 437–445.
/// Checked by: `dynamics/tests/integrators.rs::steps_amplify_as_the_closed_forms_say`,
/// `dynamics/tests/integrators.rs::schemes_are_of_their_order`.
#[derive(Debug)]
pub(super) struct Bathe {
    system: VibratingSystem,
    h: f64,
    trapezoidal: Substep,
    backward: Substep,
}

impl Bathe {
    pub(super) fn new(system: &VibratingSystem, h: f64) -> Result<Self, IntegratorError> {
        check_step(h)?;
        let trapezoidal = Substep::new(system, 16.0 / (h * h), 4.0 / h)?;
        let backward = Substep::new(system, 9.0 / (h * h), 3.0 / h)?;
        Ok(Self { system: system.clone(), h, trapezoidal, backward })
    }
}

impl Integrator for Bathe {
    fn name(&self) -> &'static str {
        NAME
    }

    fn step_under(
        &self,
        state: &mut StepState,
        forces_beside: &StepForces,
    ) -> Result<Option<DVector<f64>>, IntegratorError> {
        let h = self.h;
        let StepState { x: x0, v: v0, a: a0, .. } = &*state;
        // a_m = (16/h²) x_m − a*, v_m = (4/h) x_m − v*
        let a_star = x0 * (16.0 / (h * h)) + v0 * (8.0 / h) + a0;
        let v_star = x0 * (4.0 / h) + v0;
        let (xm, _) =
            self.trapezoidal.solve(&self.system, &a_star, &v_star, &forces_beside.middle)?;
        let vm = &xm * (4.0 / h) - v_star;
        // a₁ = (9/h²) x₁ − a*, v₁ = (3/h) x₁ − v*
        let v_star = (&xm * 4.0 - x0) / h;
        let a_star = (&v_star * 3.0 + &vm * 4.0 - v0) / h;
        let (x1, forces) =
            self.backward.solve(&self.system, &a_star, &v_star, &forces_beside.end)?;
        state.v = &x1 * (3.0 / h) - v_star;
        state.a = &x1 * (9.0 / (h * h)) - a_star;
        state.x = x1;
        state.forces = forces.iter().copied().collect();
        state.time += h;
        Ok(Some(xm))
    }
}
