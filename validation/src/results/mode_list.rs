//! A list of natural frequencies of one set, whose rows need not name it.

use std::path::Path;

use scene::Scene;

use super::contradictions::{self, Contradiction, Facts};
use super::known_scenes::KnownScenes;
use super::rows::{ModeRow, SceneNames};
use super::table::{Remark, TableError};
use crate::compare::ListedMode;
use crate::model_kind::ModelKind;

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
    /// Reads a list of natural frequencies of `scene`, whose id is `id`: columns of `modes.csv`, of which `scene` is
    /// not needed. Rows of other shipped scenes are left out.
    ///
    /// # Errors
    /// [`TableError`] with file, line, column and remedy of the first fault.
    pub fn read(path: &Path, id: &str, scene: &Scene) -> Result<Self, TableError> {
        let mut known = KnownScenes::shipped();
        known.add(id.to_owned(), scene.clone());
        let (mut rows, mut remarks) = ModeRow::read(path, SceneNames::new(&known, Some(id)))?;
        let first = rows.first().map_or(0, |row| row.line);
        let all = rows.len();
        rows.retain(|row| row.scene.scene == *scene);
        if rows.len() < all {
            remarks.push(Remark {
                path: path.to_owned(),
                line: first,
                columns: vec!["scene".to_owned()],
                text: format!("{} rows are of other scenes and left out", all - rows.len()),
            });
        }
        let kind = Some(ModelKind::Lumped);
        let contradictions = contradictions::modes(path, &rows, kind, &mut Facts::new(kind));
        Ok(Self { modes: rows.iter().map(ModeRow::listed).collect(), remarks, contradictions })
    }
}
