//! How a branch is followed.

use super::error::BranchError;

/// Range, first point and steps of a branch over speed.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchSettings {
    /// Least and greatest speed of the input member, rpm.
    pub speeds_rpm: [f64; 2],
    /// Speed of the first point, rpm: its motion is found from rest. From there the branch is followed both ways.
    pub start_rpm: f64,
    /// Most points each way.
    pub most_points: usize,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// Longest step along the branch, where 1 is a change of the motion by its own peak-to-peak vibration at the
    /// first point, or of the speed by 2 % of the middle of the range.
    pub longest_step: f64,
}

impl BranchSettings {
    /// Over a range of speeds from its middle, up to 500 points each way, harmonics 1 to 5, steps of at most 0.5.
    pub fn over(speeds_rpm: [f64; 2]) -> Self {
        let start_rpm = 0.5 * (speeds_rpm[0] + speeds_rpm[1]);
        Self { speeds_rpm, start_rpm, most_points: 500, harmonics: 5, longest_step: 0.5 }
    }

    /// Refuses speeds and numbers that make no branch.
    ///
    /// # Errors
    /// [`BranchError::Speeds`] or [`BranchError::Points`].
    pub fn check(&self) -> Result<(), BranchError> {
        let [from, to] = self.speeds_rpm;
        let start = self.start_rpm;
        let refuse = |allowed| Err(BranchError::Speeds { from, to, start, allowed });
        if ![from, to, start].iter().all(|s| gearset::is_speed(*s)) {
            return refuse("speeds must be finite and above 0, from 0.001 to 1e7 rpm");
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
