//! Vectors that a step works in, kept so that steps need no new memory.

use nalgebra::DVector;

/// Workspace of a step; n: the races' coordinates.
#[derive(Debug)]
pub(super) struct Workspace {
    /// Load on the races, n, N.
    pub(super) load: DVector<f64>,
    /// What of it the tooth pairs leave to the races, n, N.
    pub(super) left: DVector<f64>,
    /// Displacements under the load alone, n, m.
    pub(super) free: DVector<f64>,
    /// Where the races are expected at the end of the step, n, m.
    pub(super) expected: Vec<f64>,
    /// Free approaches of the pairs, m; as long as the most pairs met so far.
    pub(super) b: DVector<f64>,
    /// Displacements at the end of the step, n, m.
    pub(super) x: DVector<f64>,
    /// What velocities are counted from at the end of the step, n, m/s.
    pub(super) history: Vec<f64>,
    /// Ids of the maps that hold.
    pub(super) ids: Vec<u64>,
}

impl Workspace {
    pub(super) fn new(n: usize) -> Self {
        let zero = DVector::zeros(n);
        Self {
            load: zero.clone(),
            left: zero.clone(),
            free: zero.clone(),
            expected: vec![0.0; n],
            b: DVector::zeros(0),
            x: zero,
            history: vec![0.0; n],
            ids: Vec::new(),
        }
    }
}
