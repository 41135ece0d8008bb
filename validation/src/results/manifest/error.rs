//! Why `results.toml`, or the file of what the author accepts, cannot be used.

use std::path::PathBuf;

/// The first fault of the file.
#[derive(Debug, thiserror::Error)]
pub enum ManifestError {
    /// A file that is too long or is no UTF-8 text.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        #[source]
        source: std::io::Error,
    },
    /// A file that is no TOML.
    #[error("{}:{line}: is no TOML: {reason}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: usize,
        /// What the reader said.
        reason: String,
    },
    /// A key that means nothing, or has a value that it cannot have.
    #[error("{}:{line}: `{key}` {fault}", path.display())]
    Key {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: usize,
        /// The key with its table.
        key: String,
        /// What is wrong and what is allowed.
        fault: String,
    },
}
