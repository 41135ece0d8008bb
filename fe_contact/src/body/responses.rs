//! What a gear keeps of its elastic solution: displacements of its teeth under unit loads on one of them.

use nalgebra::DMatrix;

use crate::fe_mesh::{FeGearMesh, Sector};

/// Neighbouring teeth on either side whose response to a loaded tooth is kept.
const REACH: i64 = 4;

/// Neighbours on either side whose response at all their nodes is kept, of a gear of so many teeth.
pub(super) fn reach(teeth: usize) -> i64 {
    REACH.min((teeth as i64 - 1) / 2)
}

/// Teeth whose response at all their nodes is kept, of a gear of so many teeth.
pub(crate) fn kept_teeth(teeth: u32) -> u32 {
    2 * reach(teeth as usize) as u32 + 1
}

/// Nodes of tooth 0's flanks that take load.
#[derive(Debug, Clone)]
pub(super) struct LoadNodes {
    /// Both sides, in the sector's numbering.
    pub(super) list: Vec<usize>,
    /// First of the two columns of each node of the sector, `usize::MAX` if it takes no load.
    pub(super) column_of: Vec<usize>,
}

impl LoadNodes {
    pub(super) fn of(sector: &Sector) -> Self {
        let (mut list, mut column_of) = (Vec::new(), vec![usize::MAX; sector.points.len()]);
        for node in sector.flanks.iter().flatten().flat_map(|stretch| stretch.nodes) {
            if column_of[node] == usize::MAX {
                column_of[node] = 2 * list.len();
                list.push(node);
            }
        }
        Self { list, column_of }
    }

    /// Number of unit loads: along x and along y at each node.
    pub(super) fn columns(&self) -> usize {
        2 * self.list.len()
    }
}

/// Displacements of a gear with its race held under unit loads at the load nodes of tooth 0 (2 columns
/// each, x and y of the frame of tooth 0).
#[derive(Debug, Clone)]
pub(super) struct Responses {
    /// Of all nodes of a sector (2 rows each, in the frame of the displaced tooth), one matrix for
    /// each of the teeth −reach…reach, m/N.
    pub(super) near: Vec<DMatrix<f64>>,
    /// Of the load nodes only (2 rows each), for every tooth, counted from the loaded one; for
    /// tooth 0 only where teeth are meshed differently, m/N.
    pub(super) around: Vec<DMatrix<f64>>,
}

impl Responses {
    /// Teeth to which the matrices of [`Responses::near`] belong.
    pub(super) fn near_teeth(mesh: &FeGearMesh) -> impl Iterator<Item = usize> + use<> {
        let teeth = mesh.nodes.len();
        let reach = reach(teeth);
        (-reach..=reach).map(move |offset| offset.rem_euclid(teeth as i64) as usize)
    }
}
