//! The folder `matrices/`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use scene::read_text;

use super::MOST_BYTES;
use super::error::MatrixError;
use super::given::{GivenMatrix, MatrixKind, SceneMatrices};
use super::{market, square};
use crate::nearest::did_you_mean;
use crate::results::known_scenes::{KnownScene, KnownScenes};

/// Name of the folder.
const FOLDER: &str = "matrices";

/// Matrices in the results folder `folder`, scene by scene in the order of names; none without the folder.
/// `standard` is the scene of names without one.
pub(in crate::results) fn matrices(
    folder: &Path,
    known: &KnownScenes,
    standard: Option<&str>,
) -> Result<Vec<SceneMatrices>, MatrixError> {
    let folder = folder.join(FOLDER);
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let unreadable = |source| MatrixError::Unreadable { path: folder.clone(), source };
    let entries = std::fs::read_dir(&folder).map_err(unreadable)?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path()));
    let mut paths: Vec<PathBuf> = paths.collect::<Result<_, _>>().map_err(unreadable)?;
    // Files that systems leave behind, such as .DS_Store.
    paths.retain(|path| {
        path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.'))
    });
    paths.sort();
    let mut found: Vec<SceneMatrices> = Vec::new();
    for path in paths {
        let (kind, scene) = named(&path, known, standard)?;
        let matrix = read(&path)?;
        let is_same = |set: &SceneMatrices| set.scene.id == scene.id;
        let at = found.iter().position(is_same).unwrap_or_else(|| {
            found.push(SceneMatrices { scene, mass: None, stiffness: None });
            found.len() - 1
        });
        let place = match kind {
            MatrixKind::Mass => &mut found[at].mass,
            MatrixKind::Stiffness => &mut found[at].stiffness,
        };
        if let Some(first) = place.replace(matrix) {
            return Err(MatrixError::Twice { first: first.path, second: path });
        }
    }
    Ok(found)
}

/// Which matrix a file holds, and of which scene.
fn named(
    path: &Path,
    known: &KnownScenes,
    standard: Option<&str>,
) -> Result<(MatrixKind, Arc<KnownScene>), MatrixError> {
    let name = path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let (stem, _) = name.rsplit_once('.').unwrap_or((&name, ""));
    let (scene, letter) = match stem.rsplit_once('.') {
        Some((scene, letter)) => (Some(scene), letter),
        None => (None, stem),
    };
    let kinds = [MatrixKind::Mass, MatrixKind::Stiffness];
    let kind = kinds.into_iter().find(|kind| kind.letter().eq_ignore_ascii_case(letter));
    let (Some(kind), true) = (kind, is_read(path) && path.is_file()) else {
        let names = kinds.iter().flat_map(|kind| {
            let scenes = known.iter().map(|known| format!("{}.", known.id));
            let fronts: Vec<String> = scenes.chain([String::new()]).collect();
            fronts.into_iter().flat_map(|front| {
                ["mtx", "csv"].map(|end| format!("{front}{}.{end}", kind.letter()))
            })
        });
        let names: Vec<String> = names.collect();
        let hint = did_you_mean(&name, names.iter().map(String::as_str));
        return Err(MatrixError::Name { path: path.to_owned(), hint });
    };
    let Some(called) = scene.or(standard) else {
        return Err(MatrixError::NoScene { path: path.to_owned() });
    };
    let unknown = |source| MatrixError::UnknownScene {
        path: path.to_owned(),
        name: called.to_owned(),
        source,
    };
    Ok((kind, known.find(called).map_err(unknown)?))
}

fn has_end(path: &Path, end: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(end))
}

fn is_read(path: &Path) -> bool {
    has_end(path, "mtx") || has_end(path, "csv")
}

fn read(path: &Path) -> Result<GivenMatrix, MatrixError> {
    let text = read_text(path, MOST_BYTES)
        .map_err(|source| MatrixError::Unreadable { path: path.to_owned(), source })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    if has_end(path, "mtx") { market::read(path, text) } else { square::read(path, text) }
}
