//! A model with more or less damping than its scene gives it.

use scene::LoadCase;

use super::error::SweepError;
use super::marching::Marching;
use super::set_shape::SetShape;
use super::sweep_model::SweepModel;

/// Another model with every damping multiplied by a factor; it shares what that one has computed.
pub struct DampedModel<'a> {
    /// The model.
    pub model: &'a dyn SweepModel,
    /// The factor, finite and not negative.
    pub factor: f64,
}

impl SweepModel for DampedModel<'_> {
    fn name(&self) -> String {
        self.model.name()
    }

    fn case(&self) -> LoadCase {
        self.model.case()
    }

    fn shape(&self) -> SetShape {
        self.model.shape()
    }

    fn first_planet_rad(&self) -> f64 {
        self.model.first_planet_rad()
    }

    fn steps_per_cycle(&self) -> usize {
        self.model.steps_per_cycle()
    }

    fn prepare(&self) -> Result<(), SweepError> {
        self.model.prepare()
    }

    fn in_short_cycles(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.model.in_short_cycles(case, self.factor * damping_factor, size)
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.model.turning_damped(case, self.factor * damping_factor, size)
    }
}
