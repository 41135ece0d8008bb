//! A scene as the file that stands beside tables of results.

use std::path::Path;

use scene::{Scene, read_text};

use crate::results::folder::FolderError;
use crate::results::known_scenes::{KnownScene, KnownScenes, UnknownScene};

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 10_000_000;

/// A scene with the text of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    /// Stem of the file: `oh58_4p`.
    pub id: String,
    /// The scene.
    pub scene: Scene,
    /// What the file holds.
    pub text: String,
}

impl SceneFile {
    /// A scene that the program holds, or a variant of it that suites ask about, by id, file name or title.
    ///
    /// # Errors
    /// [`UnknownScene`] with the nearest name.
    pub fn shipped(name: &str) -> Result<Self, UnknownScene> {
        KnownScenes::shipped().find(name).map(|known| Self::of_known(&known))
    }

    /// A file of somebody's own.
    ///
    /// # Errors
    /// [`FolderError`] if it cannot be read or is no scene.
    pub fn read(path: &Path) -> Result<Self, FolderError> {
        let refuse = |source| FolderError::Scene { path: path.to_owned(), source };
        let scene = Scene::from_file(path).map_err(refuse)?;
        let text = read_text(path, MOST_BYTES)
            .map_err(|source| FolderError::Unreadable { path: path.to_owned(), source })?;
        let id = path.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
        Ok(Self { id, scene, text })
    }

    pub(super) fn of_known(known: &KnownScene) -> Self {
        let path = format!("scenes/{}.toml", known.id);
        let shipped = epicyclic_data::FILES.iter().find(|(name, _)| *name == path);
        let text = match shipped {
            Some((_, text)) => (*text).to_owned(),
            None => known.scene.to_toml(),
        };
        Self { id: known.id.clone(), scene: known.scene.clone(), text }
    }
}
