//! Vectors used within a step, kept so that steps allocate no memory.

use nalgebra::DVector;

use super::combining::CombiningWork;

/// Workspace of a step; n: the races' coordinates.
#[derive(Debug)]
pub(super) struct Workspace {
    /// Load on the races, n, N.
    pub(super) load: DVector<f64>,
    /// The load less the forces of the tooth pairs, n, N.
    pub(super) left: DVector<f64>,
    /// Expected displacements of the races at the end of the step, n, m.
    pub(super) expected: Vec<f64>,
    /// Approaches b of the pairs with the races at their origin and without pair forces, m; sized for the largest
    /// number of pairs so far, as `next`.
    pub(super) b: DVector<f64>,
    /// Approaches of the pairs while the present maps hold, m.
    pub(super) next: DVector<f64>,
    /// Displacements at the end of the step, n, m.
    pub(super) x: DVector<f64>,
    /// v* of Newmark's rule (velocity at the end of the step = 2x/h − v*), n, m/s.
    pub(super) history: Vec<f64>,
    /// Ids of the maps that hold.
    pub(super) ids: Vec<u64>,
    pub(super) combining: CombiningWork,
}

impl Workspace {
    pub(super) fn new(n: usize) -> Self {
        let zero = DVector::zeros(n);
        Self {
            load: zero.clone(),
            left: zero.clone(),
            expected: vec![0.0; n],
            b: DVector::zeros(0),
            next: DVector::zeros(0),
            x: zero,
            history: vec![0.0; n],
            ids: Vec::new(),
            combining: CombiningWork::default(),
        }
    }
}
