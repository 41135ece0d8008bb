//! Kinematic rest at a sample of positions of a mesh cycle.

use fe_contact::statics::KinematicRest;
use fe_contact::vibration::LoadedStep;

use super::marching::Marching;
use super::record::{CARRIER, RING, Record, SUN};

/// Number of positions of a mesh cycle at which exact kinematics are evaluated.
const SAMPLED: usize = 14;

/// States at the positions of one cycle, or of a part of it after which the set is itself.
#[derive(Debug, Clone)]
pub(super) struct RestSamples {
    /// Steps from one position to the next.
    every: usize,
    steps: Vec<LoadedStep>,
}

impl RestSamples {
    /// None yet, of a cycle of some `steps`.
    pub(super) fn new(steps: usize) -> Self {
        Self { every: (steps / SAMPLED).max(1), steps: Vec::new() }
    }

    /// Forgets the states of an earlier cycle.
    pub(super) fn clear(&mut self) {
        self.steps.clear();
    }

    /// Takes the state after a step, counted from 0, if it is among the sample.
    pub(super) fn take(&mut self, set: &dyn Marching, step: usize) {
        if step.is_multiple_of(self.every) {
            self.steps.extend(set.loaded_step());
        }
    }

    /// The largest kinematic rest, also relative to the largest peak-to-peak motion of the sun, or of the member
    /// that turns in its place, over the recorded cycle, the last one that the set marched; `None` for a set
    /// without. The motion includes x and y, since the transmission error (rotation at the base circle) is small
    /// at resonances of translational modes.
    pub(super) fn rest(&self, set: &dyn Marching, record: &Record) -> Option<KinematicRest> {
        let (mut largest, mut radius) = (0.0f64, None);
        for step in &self.steps {
            let [rest, base_radius] = set.kinematic_rest(step)?;
            // NaN is kept.
            largest = if largest.is_nan() || largest >= rest { largest } else { rest };
            radius = Some(base_radius);
        }
        // A sun that is held does not turn: the torque then acts on the ring or the carrier.
        let turns = |body: &[usize; 3]| record.range(body[2]) > 0.0;
        let body = [SUN, RING, CARRIER].into_iter().find(turns).unwrap_or(SUN);
        let [x, y, rotation] = body.map(|channel| record.range(channel));
        radius.map(|radius| KinematicRest::new(largest, x.max(y).max(radius * rotation)))
    }
}
