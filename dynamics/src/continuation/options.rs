//! Options of continuation.

use super::error::ContinuationError;

/// Scales that make unknowns and parameter comparable: arc length is measured in y_i/s_i and λ/s_λ.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    /// s_i, one per unknown, in its unit.
    pub unknowns: Vec<f64>,
    /// s_λ.
    pub parameter: f64,
}

/// Steps, tolerances and bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct ContinuationOptions {
    /// Least and greatest parameter; the branch ends exactly at them.
    pub bounds: [f64; 2],
    /// First step along the scaled arc.
    pub first_step: f64,
    /// Least and greatest step along the scaled arc.
    pub steps: [f64; 2],
    /// Most points of a branch, the first included.
    pub most_points: usize,
    /// Largest angle between the tangents of successive points, rad; a step that turns further is taken again at
    /// half its length.
    pub most_turn: f64,
    /// Newton iterations a step should take: fewer lengthen the next one, more shorten it.
    pub wanted_iterations: usize,
    /// Newton iterations after which a step is halved.
    pub most_iterations: usize,
    /// Newton's method ends when the largest entry of a scaled correction is below this.
    pub correction: f64,
    /// Folds and other bifurcations are located until two tries are closer along the scaled arc than this share of
    /// the scaled unknowns' norm or of one, whichever is more. At a fold λ is off by the square of it.
    pub location: f64,
}

impl ContinuationOptions {
    /// Between two parameters, with steps from 10⁻⁶ to 0.5 of the scaled arc, starting at 0.05.
    pub fn within(bounds: [f64; 2]) -> Self {
        Self {
            bounds,
            first_step: 0.05,
            steps: [1e-6, 0.5],
            most_points: 1000,
            most_turn: 0.3,
            wanted_iterations: 4,
            most_iterations: 10,
            correction: 1e-10,
            location: 1e-9,
        }
    }

    pub(super) fn check<E: std::error::Error>(&self) -> Result<(), ContinuationError<E>> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let [low, high] = self.bounds;
        let [least, greatest] = self.steps;
        let above = "it must be positive and finite";
        for (what, value, is_fine, allowed) in [
            ("the upper bound", high, low < high, "it must be above the lower bound"),
            ("the least step", least, positive(least), above),
            ("the greatest step", greatest, positive(greatest) && greatest >= least, above),
            ("the first step", self.first_step, positive(self.first_step), above),
            ("the turn", self.most_turn, positive(self.most_turn), above),
            ("the correction", self.correction, positive(self.correction), above),
            ("the location", self.location, positive(self.location), above),
            ("the number of iterations", 0.0, self.most_iterations > 1, "at least 2 are needed"),
            ("the number of points", 0.0, self.most_points > 1, "at least 2 are needed"),
        ] {
            if !is_fine {
                return Err(ContinuationError::Option { what, value, allowed });
            }
        }
        Ok(())
    }
}
