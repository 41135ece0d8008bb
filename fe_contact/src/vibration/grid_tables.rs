//! Tables of contact on a grid of phases, where kinematics are exact at every step.

use std::collections::HashMap;

use crate::statics::NeighbourTables;

/// Tables of the grid that were needed so far.
#[derive(Debug, Default)]
pub(super) struct GridTables {
    /// Index of the table, by group of meshes and number of the phase on the grid.
    pub(super) place: HashMap<(usize, i64), usize>,
    pub(super) beside: HashMap<usize, NeighbourTables>,
}
