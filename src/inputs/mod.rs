//! What a verb is given: the scene, loads, what it lacks; and what it is doing meanwhile.

mod cost;
pub(crate) mod loads;
pub(crate) mod needs;
mod working;

pub(crate) use cost::{Run, bodies};
pub(crate) use working::{Progress, Working, progress};

use std::io::Write;
use std::path::Path;

use scene::{MOST_SCENE_BYTES, Remarks, Scene, SceneError};

use crate::error::{CommandError, Result, unread};

/// Reads a scene, or says what is wrong with it. Writes the warnings that need the digits of its file, one a line.
pub(crate) fn read_scene(path: &Path, err: &mut dyn Write) -> Result<Scene> {
    let (scene, remarks) = scene_with_remarks(path)?;
    remarks.warnings.iter().try_for_each(|warning| writeln!(err, "warning: {warning}"))?;
    Ok(scene)
}

/// Reads a scene and what its file leaves to choose, or says what is wrong with it.
pub(crate) fn scene_with_remarks(path: &Path) -> Result<(Scene, Remarks)> {
    let read = || {
        let unreadable = |cause| SceneError::Unreadable { path: path.to_owned(), cause };
        Scene::with_remarks(&scene::read_text(path, MOST_SCENE_BYTES).map_err(unreadable)?)
    };
    read().map_err(|source| CommandError::Scene { path: path.to_owned(), source })
}

/// The text of a scene file.
pub(crate) fn scene_text(path: &Path) -> Result<String> {
    scene::read_text(path, MOST_SCENE_BYTES).map_err(unread(path))
}
