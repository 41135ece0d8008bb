//! Position of a set in its mesh cycles, and its time step.

use dynamics::AverageAcceleration;

use super::rotation::NominalRotation;
use crate::error::FeError;

/// Steps and mesh cycles of a set in time.
#[derive(Debug)]
pub(super) struct Clock {
    pub(super) rotation: NominalRotation,
    pub(super) rule: AverageAcceleration,
    pub(super) step_in_cycle: usize,
    /// Whole mesh cycles by which the gears have turned, less than 0 in backward direction.
    pub(super) cycles: i64,
    /// Steps taken.
    pub(super) steps: u64,
}

impl Clock {
    pub(super) fn new(rotation: NominalRotation) -> Result<Self, FeError> {
        let step = match rotation {
            NominalRotation::Standing { step, .. } => step,
            NominalRotation::Turning { mesh_frequency, steps_per_cycle, .. } => {
                1.0 / (mesh_frequency * steps_per_cycle as f64)
            }
        };
        let rule = AverageAcceleration::new(step).map_err(|e| FeError::Unfit {
            key: "step".into(),
            value: format!("{} s", e.0),
            allowed: "a positive length of time".into(),
            why: "speed and steps a cycle, or the step itself, give none".into(),
        })?;
        Ok(Self { rotation, rule, step_in_cycle: 0, cycles: 0, steps: 0 })
    }

    /// Time since the start, s.
    pub(super) fn time(&self) -> f64 {
        self.steps as f64 * self.rule.step()
    }

    /// Advances by a step.
    pub(super) fn tick(&mut self) {
        self.steps += 1;
        if let NominalRotation::Turning { steps_per_cycle, .. } = self.rotation {
            self.step_in_cycle += 1;
            if self.step_in_cycle == steps_per_cycle {
                self.step_in_cycle = 0;
                self.cycles += self.rotation.direction().whole();
            }
        }
    }

    /// Position of a step in the cycle, cycles.
    pub(super) fn position(&self, step_in_cycle: usize) -> f64 {
        self.rotation.position(step_in_cycle)
    }

    /// Mesh cycles by which the gears have turned since the start; 0 for a standing set.
    pub(super) fn turned(&self) -> f64 {
        match self.rotation {
            NominalRotation::Standing { .. } => 0.0,
            NominalRotation::Turning { .. } => {
                self.cycles as f64 + self.position(self.step_in_cycle)
            }
        }
    }

    /// Step in the cycle before a given one.
    pub(super) fn before(&self, step_in_cycle: usize) -> usize {
        let count = self.rotation.count();
        (step_in_cycle + count - 1) % count
    }
}
