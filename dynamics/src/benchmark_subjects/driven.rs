//! Steps under forces that depend on displacements: the force at the end of a step and its displacements are iterated
//! until they agree.
//!
//! The forces f(t, x) stand beside the linear part of a system. A step maps forces to displacements with the tangent
//! (h²/4) S⁻¹, S the matrix of the step, so that the iteration contracts if the system's stiffness K bounds their
//! derivative, |φᵀ ∂f φ| ≤ φᵀ K φ: forces of springs between nothing and twice a mean stiffness that K contains.

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
