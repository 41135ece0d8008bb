//! Kinematic rest at a sample of positions of a mesh cycle.

use fe_contact::statics::KinematicRest;

use super::marching::Marching;
use super::record::{Record, SUN};

/// Number of positions of a mesh cycle at which exact kinematics are evaluated.
const SAMPLED: usize = 14;

/// The largest kinematic rest at the positions of one cycle, or of a part of it after which the set is itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct RestSamples {
    /// Steps from one position to the next.
    every: usize,
    /// Largest rest so far, m.
    largest: f64,
    /// Base radius of the sun, m.
    base_radius: f64,
}

impl RestSamples {
    /// None yet, of a cycle of some `steps`; `None` for a set without kinematic rest.
    pub(super) fn new(set: &dyn Marching, steps: usize) -> Option<Self> {
        let every = (steps / SAMPLED).max(1);
        set.has_kinematic_rest().then_some(Self { every, largest: 0.0, base_radius: 0.0 })
    }

    /// Takes the state after a step, counted from 0, if it is among the sample.
    pub(super) fn take(&mut self, set: &dyn Marching, step: usize) {
        if !step.is_multiple_of(self.every) {
            return;
        }
        if let Some([rest, base_radius]) = set.kinematic_rest() {
            self.base_radius = base_radius;
            // NaN is kept.
            self.largest =
                if self.largest.is_nan() || self.largest >= rest { self.largest } else { rest };
        }
    }

    /// The largest, also relative to the sun's largest peak-to-peak motion over the recorded cycle. This includes x and
    /// y, since the transmission error (rotation at the base circle) is small at resonances of translational modes.
    pub(super) fn rest(&self, record: &Record) -> KinematicRest {
        let [x, y, rotation] = SUN.map(|channel| record.range(channel));
        KinematicRest::new(self.largest, x.max(y).max(self.base_radius * rotation))
    }
}
