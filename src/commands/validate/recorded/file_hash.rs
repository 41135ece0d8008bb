//! Which files a verdict is about.

use std::fs;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use validation::certified::sha256;

use crate::error::{Result, unread};

/// A file that was read.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct FileHash {
    /// Its path from the results folder; of a file elsewhere its name.
    pub(super) name: String,
    /// SHA-256 of its bytes, hexadecimal, as `sha256sum` prints it.
    pub(super) sha256: String,
}

impl FileHash {
    pub(super) fn read(path: &Path, folder: &Path) -> Result<Self> {
        let bytes = fs::read(path).map_err(unread(path))?;
        let name = path.strip_prefix(folder).ok().map(Path::as_os_str).or(path.file_name());
        let name = name.unwrap_or(path.as_os_str()).to_string_lossy().replace('\\', "/");
        Ok(Self { name, sha256: sha256(&bytes) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_that_of_the_standard() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("modes.csv");
        fs::write(&path, "abc").unwrap();
        let hash = FileHash::read(&path, folder.path()).unwrap();
        assert_eq!(hash.name, "modes.csv");
        // FIPS 180-4, example of one block.
        let standard = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hash.sha256, standard);
    }
}
