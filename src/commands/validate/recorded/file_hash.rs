//! Which files a verdict is about.

use std::fs;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::error::{Result, unread};

/// A file that was read.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct FileHash {
    /// Its name without the folder.
    pub(super) name: String,
    /// SHA-256 of its bytes, hexadecimal, as `sha256sum` prints it.
    pub(super) sha256: String,
}

impl FileHash {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).map_err(unread(path))?;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Ok(Self { name, sha256: sha256(&bytes) })
    }
}

/// SHA-256, hexadecimal.
pub(super) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_that_of_the_standard() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("modes.csv");
        fs::write(&path, "abc").unwrap();
        let hash = FileHash::read(&path).unwrap();
        assert_eq!(hash.name, "modes.csv");
        // FIPS 180-4, example of one block.
        let standard = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hash.sha256, standard);
    }
}
