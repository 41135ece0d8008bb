//! Why a matrix cannot be read, and what to do about it.

use std::path::{Path, PathBuf};

use crate::results::known_scenes::UnknownScene;

/// The first fault of a file in `matrices/`.
#[derive(Debug, thiserror::Error)]
pub enum MatrixError {
    /// A folder or file that is not there, is too long or is no UTF-8 text.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The folder or file.
        path: PathBuf,
        /// What the reader said.
        #[source]
        source: std::io::Error,
    },
    /// A name that no matrix has.
    #[error("{}: no matrix is called so: allowed is M or K, or the id of a scene with .M or .K, each with .mtx or .csv{hint}", path.display())]
    Name {
        /// The file.
        path: PathBuf,
        /// `; did you mean …`, if a name is near.
        hint: String,
    },
    /// A scene that is not known.
    #[error("{}: the scene in the name is `{name}`: allowed is {source}", path.display())]
    UnknownScene {
        /// The file.
        path: PathBuf,
        /// The name.
        name: String,
        /// What is allowed.
        #[source]
        source: UnknownScene,
    },
    /// A name without a scene where `results.toml` has none.
    #[error("{}: of which scene is not said: give `scene` in results.toml, or put its id before the name: ID.{}", path.display(), name(path))]
    NoScene {
        /// The file.
        path: PathBuf,
    },
    /// Two files of one matrix.
    #[error("{} and {}: two files of one matrix: keep one", first.display(), second.display())]
    Twice {
        /// One.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// Something in a line that cannot stand there.
    #[error("{}:{line}: {what} is {value}: allowed is {allowed}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: u64,
        /// What it stands for: `column 4`, `row of the entry`.
        what: String,
        /// What stands there.
        value: String,
        /// What may stand there.
        allowed: String,
    },
}

fn name(path: &Path) -> String {
    path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned())
}

/// A place in a file.
#[derive(Clone, Copy)]
pub(super) struct Place<'p> {
    pub(super) path: &'p Path,
    /// From 1.
    pub(super) line: u64,
}

impl Place<'_> {
    /// Refuses what stands there; an empty `value` is called so.
    pub(super) fn refuse(
        self,
        what: impl Into<String>,
        value: &str,
        allowed: impl Into<String>,
    ) -> MatrixError {
        let shown: String =
            value.chars().take(60).map(|c| if c.is_control() { '?' } else { c }).collect();
        MatrixError::Value {
            path: self.path.to_owned(),
            line: self.line,
            what: what.into(),
            value: if shown.is_empty() { "empty".to_owned() } else { format!("`{shown}`") },
            allowed: allowed.into(),
        }
    }
}
