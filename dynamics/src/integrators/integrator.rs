//! What all schemes have in common.

use std::fmt::Debug;

use super::error::IntegratorError;
use super::state::StepState;

/// A scheme made ready for one system and one step.
pub trait Integrator: Debug {
    /// Name of the scheme in words.
    fn name(&self) -> &'static str;

    /// Δt, s.
    fn step_length(&self) -> f64;

    /// Replaces the state by that one step later.
    ///
    /// # Errors
    /// If the contact problem of the step is not solved.
    fn step(&self, state: &mut StepState) -> Result<(), IntegratorError>;

    /// So many steps.
    ///
    /// # Errors
    /// At the first that fails.
    fn march(&self, state: &mut StepState, steps: usize) -> Result<(), IntegratorError> {
        (0..steps).try_for_each(|_| self.step(state))
    }
}
