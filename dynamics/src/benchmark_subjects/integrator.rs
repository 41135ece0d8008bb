//! What all schemes have in common.

use std::fmt::Debug;

use nalgebra::DVector;

use super::error::IntegratorError;
use super::state::StepState;

/// Forces on the coordinates (n, N) beside those of the system at start, middle and end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct StepForces {
    /// At the start.
    pub start: DVector<f64>,
    /// In the middle; only Bathe's scheme uses it.
    pub middle: DVector<f64>,
    /// At the end.
    pub end: DVector<f64>,
}

impl StepForces {
    /// None at all on n coordinates.
    pub fn none(n: usize) -> Self {
        let zero = DVector::zeros(n);
        Self { start: zero.clone(), middle: zero.clone(), end: zero }
    }
}

/// A scheme made ready for one system and one step.
pub trait Integrator: Debug {
    /// Name of the scheme in words.
    fn name(&self) -> &'static str;

    /// Replaces the state by that one step later under further forces; returns displacements in the middle of the step
    /// (n, m) of a scheme that balances forces there.
    ///
    /// # Errors
    /// If the contact problem of the step is not solved.
    fn step_under(
        &self,
        state: &mut StepState,
        forces: &StepForces,
    ) -> Result<Option<DVector<f64>>, IntegratorError>;

    /// Replaces the state by that one step later.
    ///
    /// # Errors
    /// If the contact problem of the step is not solved.
    fn step(&self, state: &mut StepState) -> Result<(), IntegratorError> {
        self.step_under(state, &StepForces::none(state.x.len())).map(|_| ())
    }
}
