//! Rows that the author of results knows to miss.

use std::path::Path;

use serde::Deserialize;

use super::error::ManifestError;
use super::file::line_of;
use crate::reference::Miss;

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    miss: Vec<Miss>,
}

/// Reads a TOML file of `[[miss]]` entries: `id` of the check, `value` that the model gives, `tolerance` of it, and
/// `analysis`, why the model is right all the same.
///
/// # Errors
/// [`ManifestError`] with file and line of the first fault.
pub fn accepted_misses(path: &Path) -> Result<Vec<Miss>, ManifestError> {
    let text = scene::read_text(path, MOST_BYTES)
        .map_err(|source| ManifestError::Unreadable { path: path.to_owned(), source })?;
    let file: File = toml::from_str(&text).map_err(|error| ManifestError::Syntax {
        path: path.to_owned(),
        line: line_of(&text, error.span().map_or(0, |span| span.start)),
        reason: format!(
            "{}: [[miss]] with id, value, tolerance and analysis is allowed",
            error.message().replace('\n', "; ")
        ),
    })?;
    Ok(file.miss)
}
