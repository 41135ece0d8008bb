//! The state between two steps.

use nalgebra::DVector;

/// Displacements, velocities, accelerations and contact forces at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct StepState {
    /// Time, s.
    pub time: f64,
    /// Displacements, n, m.
    pub x: DVector<f64>,
    /// Velocities, n, m/s.
    pub v: DVector<f64>,
    /// Accelerations, n, m/s². A scheme that knows none gives the mean over its last step.
    pub a: DVector<f64>,
    /// Contact force of each obstacle, N: at the end of the last step for implicit schemes, at its start for central
    /// difference, impulse over step for Moreau–Jean.
    pub forces: Vec<f64>,
}
