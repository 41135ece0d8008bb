//! How a branch is followed.

use serde::{Deserialize, Serialize};

use super::error::BranchError;
use super::parameter::BranchParameter;

/// Parameter, range, first point and steps of a branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchSettings {
    /// What is varied.
    pub over: BranchParameter,
    /// Least and greatest value, in its unit (rpm, N·m, 1). Torques have one sign.
    pub range: [f64; 2],
    /// Value at the first point: its motion is found from rest. From there the branch is followed both ways.
    pub start: f64,
    /// Most points each way.
    pub most_points: usize,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// Longest step along the branch, where 1 is a change of the motion by its own peak-to-peak vibration at the
    /// first point, of the speed by 2 % of the middle of the range, or of torque or damping by 20 % of it.
    pub longest_step: f64,
}

impl BranchSettings {
    /// Over a range of speeds (rpm) from its middle, up to 500 points each way, harmonics 1 to 5, steps of at most 0.5.
    pub fn over(speeds_rpm: [f64; 2]) -> Self {
        Self::along(BranchParameter::Speed, speeds_rpm)
    }

    /// The same over a range of any parameter.
    pub fn along(over: BranchParameter, range: [f64; 2]) -> Self {
        let start = 0.5 * (range[0] + range[1]);
        Self { over, range, start, most_points: 500, harmonics: 5, longest_step: 0.5 }
    }

    /// About how many points a branch over the range has: steps of the longest that is allowed, if only the parameter
    /// changes, and as many again for changes of the motion.
    pub fn points(&self) -> usize {
        let [from, to] = self.range;
        let unit = self.over.share() * 0.5 * (from + to).abs();
        (2.0 * (to - from) / (unit * self.longest_step)).ceil() as usize
    }

    /// Refuses values and numbers that make no branch.
    ///
    /// # Errors
    /// [`BranchError::Range`] or [`BranchError::Points`].
    pub fn check(&self) -> Result<(), BranchError> {
        let Self { over, range: [from, to], start, .. } = *self;
        let refuse = |allowed| Err(BranchError::Range { over, from, to, start, allowed });
        let are = |fine: fn(f64) -> bool| [from, to, start].into_iter().all(fine);
        match over {
            BranchParameter::Speed if !are(scene::is_speed) => {
                return refuse("speeds must be finite and above 0, from 0.001 to 1e7 rpm");
            }
            BranchParameter::Torque
                if !(are(|t| t.is_finite() && t > 0.0) || are(|t| t.is_finite() && t < 0.0)) =>
            {
                return refuse(
                    "torques must be finite and of one sign: at 0 no flank is pressed, and the other sense presses others",
                );
            }
            BranchParameter::Key(_) if !are(|v| v.is_finite() && v > 0.0) => {
                return refuse(
                    "values must be finite and above 0: the derivative in the key is a difference over a share of its value",
                );
            }
            BranchParameter::Damping if !are(|d| d.is_finite() && d > 0.0) => {
                return refuse(
                    "factors must be finite and above 0: without damping periodic motions are not isolated",
                );
            }
            _ => {}
        }
        if from >= to {
            return refuse("the first must be below the last");
        }
        if start < from || start > to {
            return refuse("the start must lie between them");
        }
        if self.most_points < 2 {
            return Err(BranchError::Points(self.most_points));
        }
        Ok(())
    }
}
