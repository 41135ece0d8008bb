//! Tables of contact on a grid of phases, where kinematics are exact at every step.

use std::collections::HashMap;

use crate::statics::NeighbourTables;

/// Tables of the grid that were needed so far.
#[derive(Debug, Default)]
pub(super) struct GridTables {
    /// By group of meshes and place on the grid.
    pub(super) place: HashMap<(usize, i64), usize>,
    pub(super) beside: HashMap<usize, NeighbourTables>,
}
