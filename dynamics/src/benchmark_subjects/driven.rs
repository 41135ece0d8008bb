//! Steps under forces that depend on displacements: the force at the end of a step and its displacements are iterated
//! until they agree.
//!
//! The forces f(t, x) stand beside the linear part of a system. The iteration contracts for forces of springs between
//! nothing and twice a mean stiffness that the system's stiffness K contains ([`driven_step`]).

use nalgebra::DVector;

use super::error::IntegratorError;
use super::integrator::{Integrator, StepForces};
use super::state::StepState;

/// Where in a step a force is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instant {
    /// Half a step after the start.
    Middle,
    /// The end.
    End,
}

/// Change of the forces over the largest at which the iteration ends.
const SETTLED: f64 = 1e-12;

/// Most iterations of a step.
const MOST: usize = 400;

/// One step under the forces `force` (n, N) at the displacements (n, m) there, which are `at_start` at the start and on
/// return those at the end; returns the number of solutions.
///
/// `[eq:driven-step]` x ← x(f(x)), whose tangent is (h²/4) S⁻¹ ∂f with the matrix S of the step: contracts if |φᵀ ∂f
/// φ| ≤ φᵀ K φ.
/// Source: derived here.
/// Checked by: `lumped/tests/scheme_set.rs::average_acceleration_is_that_of_the_program`,
/// `lumped/tests/scheme_set.rs::every_scheme_converges_to_harmonic_balance_with_its_order`.
///
/// # Errors
/// If the step fails or the iteration does not settle.
pub fn driven_step(
    integrator: &dyn Integrator,
    state: &mut StepState,
    at_start: &mut DVector<f64>,
    force: &mut dyn FnMut(Instant, &DVector<f64>) -> DVector<f64>,
) -> Result<usize, IntegratorError> {
    let mut forces =
        StepForces { start: at_start.clone(), middle: at_start.clone(), end: at_start.clone() };
    let mut change = f64::INFINITY;
    for solutions in 1..=MOST {
        let mut trial = state.clone();
        let middle = integrator.step_under(&mut trial, &forces)?;
        let end = force(Instant::End, &trial.x);
        let middle = middle.map(|x| force(Instant::Middle, &x));
        let size = end.amax().max(f64::MIN_POSITIVE);
        change = (&end - &forces.end).amax() / size;
        if let Some(middle) = &middle {
            change = change.max((middle - &forces.middle).amax() / size);
        }
        forces.end = end;
        if let Some(middle) = middle {
            forces.middle = middle;
        }
        if change <= SETTLED {
            *state = trial;
            *at_start = forces.end;
            return Ok(solutions);
        }
        // NaN and infinity never settle.
        if !change.is_finite() {
            break;
        }
    }
    Err(IntegratorError::Unsettled { scheme: integrator.name(), change })
}
