//! A list of natural frequencies of one set, whose rows need not name it.

use std::path::Path;

use scene::Scene;

use super::contradictions::{self, Contradiction, Facts};
use super::known_scenes::KnownScenes;
use super::rows::{ModeRow, SceneNames};
use super::table::{Remark, TableError};
use crate::compare::ListedMode;
use crate::model_kind::ModelKind;

/// Id of the set of a list in the reader.
const ID: &str = "scene";

/// What a list holds.
#[derive(Debug, Clone)]
pub struct ModeList {
    /// Its modes, in the order of the file.
    pub modes: Vec<ListedMode>,
    /// What was read in another way than it is written.
    pub remarks: Vec<Remark>,
    /// What in it cannot be true.
    pub contradictions: Vec<Contradiction>,
}

impl ModeList {
    /// Reads a list of natural frequencies of `scene`: columns of `modes.csv`, of which `scene` is not needed.
    ///
    /// # Errors
    /// [`TableError`] with file, line, column and remedy of the first fault.
    pub fn read(path: &Path, scene: &Scene) -> Result<Self, TableError> {
        let mut known = KnownScenes::default();
        known.add(ID.to_owned(), scene.clone());
        let (rows, remarks) = ModeRow::read(path, SceneNames::new(&known, Some(ID)))?;
        let kind = Some(ModelKind::Lumped);
        let contradictions = contradictions::modes(path, &rows, kind, &mut Facts::new(kind));
        Ok(Self { modes: rows.iter().map(ModeRow::listed).collect(), remarks, contradictions })
    }
}
