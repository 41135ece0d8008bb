//! What a gear keeps of its elastic solution: displacements of its teeth under unit loads on one of them.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;

use super::sector_ring::RingOfSectors;
use crate::fe_mesh::{FeGearMesh, Sector, Side};

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
    /// Columns of the nodes of each flank, by [`Side::index`].
    pub(super) of_sides: [Range<usize>; 2],
}

impl LoadNodes {
    pub(super) fn of(sector: &Sector) -> Self {
        let (mut list, mut column_of) = (Vec::new(), vec![usize::MAX; sector.points.len()]);
        let of_sides = [0, 1].map(|side| {
            let first = 2 * list.len();
            for node in sector.flanks[side].iter().flat_map(|stretch| stretch.nodes) {
                if column_of[node] == usize::MAX {
                    column_of[node] = 2 * list.len();
                    list.push(node);
                }
            }
            first..2 * list.len()
        });
        Self { list, column_of, of_sides }
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
    near: Vec<OnceLock<DMatrix<f64>>>,
    /// The same under loads on one flank, by [`Side::index`], as far as it is computed by itself.
    near_sides: Vec<[OnceLock<DMatrix<f64>>; 2]>,
    /// Columns of the loads on either flank; not needed where all responses are known.
    of_sides: [Range<usize>; 2],
    /// Of the load nodes only (2 rows each), for every tooth, counted from the loaded one; for
    /// tooth 0 only where teeth are meshed differently, m/N.
    around: Vec<OnceLock<DMatrix<f64>>>,
    /// Teeth of the gear.
    teeth: i64,
    /// What they are computed from when they are first asked for: most contact needs those of a tooth and its two
    /// neighbours alone.
    ring: Option<Arc<RingOfSectors>>,
}

impl Responses {
    /// Those of equal teeth, of which none is computed yet.
    pub(super) fn of_ring(mesh: &FeGearMesh, loads: &LoadNodes, ring: RingOfSectors) -> Self {
        let none = |count: usize| (0..count).map(|_| OnceLock::new()).collect();
        let (near, around) = (Self::near_teeth(mesh).count(), mesh.nodes.len());
        Self {
            near: none(near),
            near_sides: (0..near).map(|_| Default::default()).collect(),
            of_sides: loads.of_sides.clone(),
            around: none(around),
            teeth: around as i64,
            ring: Some(Arc::new(ring)),
        }
    }

    /// Those of a gear, all of which are known.
    pub(super) fn known(
        mesh: &FeGearMesh,
        near: Vec<DMatrix<f64>>,
        around: Vec<DMatrix<f64>>,
    ) -> Self {
        let kept = |list: Vec<DMatrix<f64>>| list.into_iter().map(OnceLock::from).collect();
        Self {
            near: kept(near),
            near_sides: Vec::new(),
            of_sides: Default::default(),
            around: kept(around),
            teeth: mesh.nodes.len() as i64,
            ring: None,
        }
    }

    /// What they are computed from; `None` where teeth are meshed differently or the whole gear was solved.
    pub(super) fn ring(&self) -> Option<&Arc<RingOfSectors>> {
        self.ring.as_ref()
    }

    /// Response at all nodes of the tooth `offset` teeth on from the loaded one; `None` beyond the kept ones.
    pub(super) fn near(&self, offset: i64) -> Option<&DMatrix<f64>> {
        let slot = &self.near[self.place(offset)?];
        match &self.ring {
            Some(ring) => Some(slot.get_or_init(|| ring.of_all_nodes(offset, None))),
            None => slot.get(),
        }
    }

    /// The same under loads on one flank, with the column of the whole response that is its first: contact needs one
    /// flank alone, half of the work.
    pub(super) fn near_under(&self, offset: i64, side: Side) -> Option<(&DMatrix<f64>, usize)> {
        let (place, columns) = (self.place(offset)?, &self.of_sides[side.index()]);
        match &self.ring {
            Some(ring) => {
                let slot = &self.near_sides[place][side.index()];
                let own = slot.get_or_init(|| ring.of_all_nodes(offset, Some(columns)));
                Some((own, columns.start))
            }
            None => Some((self.near[place].get()?, 0)),
        }
    }

    /// Place of the tooth `offset` teeth on among the near ones.
    fn place(&self, offset: i64) -> Option<usize> {
        let reach = (self.near.len() as i64 - 1) / 2;
        usize::try_from(offset + reach).ok().filter(|place| *place < self.near.len())
    }

    /// Response at the load nodes of the tooth `offset` teeth on from the loaded one.
    pub(super) fn around(&self, offset: i64) -> Option<&DMatrix<f64>> {
        let slot = self.around.get(offset.rem_euclid(self.teeth) as usize)?;
        match &self.ring {
            Some(ring) => Some(slot.get_or_init(|| ring.of_load_nodes(offset))),
            None => slot.get(),
        }
    }

    /// Teeth to which the matrices of the near teeth belong.
    pub(super) fn near_teeth(mesh: &FeGearMesh) -> impl Iterator<Item = usize> + use<> {
        let teeth = mesh.nodes.len();
        let reach = reach(teeth);
        (-reach..=reach).map(move |offset| offset.rem_euclid(teeth as i64) as usize)
    }
}
