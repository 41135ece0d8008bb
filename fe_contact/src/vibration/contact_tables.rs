//! Contact tables of a set in time, the contact maps found on them, and the slopes of its flanks.

use std::sync::Arc;

use super::frame::Frame;
use super::grid_tables::GridTables;
use super::leaning::Leaning;
use crate::complementarity::ActiveSet;
use crate::contact::{ContactMaps, MeshTable};
use crate::error::FeError;
use crate::statics::SetTables;

/// Everything that the contact problems of a set in time are solved with.
#[derive(Debug)]
pub(super) struct ContactTables {
    pub(super) tables: SetTables,
    /// Contact maps of each table.
    pub(super) maps: Vec<ContactMaps>,
    /// Slopes of the flanks, by step in the cycle.
    pub(super) leaning: Arc<[Leaning]>,
    /// Tables on a grid of phases; `None` unless kinematics are exact at every step.
    pub(super) grid: Option<GridTables>,
}

impl ContactTables {
    pub(super) fn new(tables: SetTables, leaning: Arc<[Leaning]>, is_exact: bool) -> Self {
        let of = |shared| ContactMaps::new(&tables.settings, Arc::clone(shared));
        let maps = tables.maps.iter().map(of).collect();
        Self { tables, maps, leaning, grid: is_exact.then(GridTables::default) }
    }

    /// Adds a table without maps; returns its index.
    pub(super) fn add(&mut self, table: Arc<MeshTable>) -> usize {
        self.tables.list.push(table);
        self.maps.push(ContactMaps::new(&self.tables.settings, Arc::default()));
        self.maps.len() - 1
    }

    /// Finds maps at some approaches (m) for the meshes of a frame that have none, or whose map was
    /// replaced by another.
    pub(super) fn find_lost(
        &mut self,
        frame: &mut Frame,
        approaches: &[f64],
    ) -> Result<(), FeError> {
        let Self { tables, maps, .. } = self;
        for mesh in &mut frame.meshes {
            if mesh.map(maps).is_none() {
                let delta = &approaches[mesh.first..mesh.first + mesh.count];
                let table = &tables.list[mesh.table];
                maps[mesh.table].find(table, delta, &mut mesh.held, &ActiveSet)?;
            }
        }
        Ok(())
    }

    /// Contact problems solved so far, and maps kept.
    pub(super) fn counts(&self) -> [usize; 2] {
        [self.maps.iter().map(|m| m.solved).sum(), self.maps.iter().map(ContactMaps::count).sum()]
    }

    /// Memory of tables and of maps, bytes.
    pub(super) fn bytes(&self) -> [usize; 2] {
        [self.tables.bytes(), self.maps.iter().map(ContactMaps::bytes).sum()]
    }
}
