//! What a verb is given: the scene, loads, what it lacks; and what it is doing meanwhile.

pub(crate) mod loads;
pub(crate) mod needs;
mod working;

pub(crate) use working::{Working, progress};

use std::path::Path;

use scene::{MOST_SCENE_BYTES, Scene};

use crate::error::{CommandError, Result, unread};

/// Reads a scene, or says what is wrong with it.
pub(crate) fn read_scene(path: &Path) -> Result<Scene> {
    Scene::from_file(path).map_err(|source| CommandError::Scene { path: path.to_owned(), source })
}

/// The text of a scene file.
pub(crate) fn scene_text(path: &Path) -> Result<String> {
    scene::read_text(path, MOST_SCENE_BYTES).map_err(unread(path))
}
