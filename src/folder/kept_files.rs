//! Finished parts of a result in a folder: each is written completely or not at all, with a checksum.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use experiments::branches::{BranchStore, KeptPart};
use experiments::sweep::{Chain, Kept, PointStore, StoreError};
use scene::read_text;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::claim::other_results;
use super::manifest::Manifest;
use crate::error::{Result, unread, unwritten};

/// Longest manifest or part that is read, bytes: some million numbers, as the state of full bodies has, fit several
/// times.
pub(crate) const MOST_BYTES: u64 = 200_000_000;

/// Before the checksum in the file of a part.
const HEAD: &str = "{\"checksum\":\"";

/// Between the checksum and the part.
const MIDDLE: &str = "\",\"point\":";

/// Parts of one result in a folder, by a name with folders and a number.
#[derive(Debug)]
pub(crate) struct KeptFiles {
    parts: PathBuf,
    /// Hash of the manifest, so that a part of another result is recognised.
    seed: u64,
}

impl KeptFiles {
    /// Opens a folder; parts that an earlier run with the same manifest left in it are used. `name`: name of the
    /// manifest's file, which is written if it is not there.
    ///
    /// # Errors
    /// If the folder holds the manifest of something else, or cannot be read or written.
    pub(crate) fn open(folder: &Path, name: &str, wanted: &Manifest) -> Result<Self> {
        let path = folder.join(name);
        match read_text(&path, MOST_BYTES) {
            Ok(text) => {
                if let Some(reason) = wanted.difference(&text) {
                    return Err(other_results(path, &reason));
                }
            }
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                write_whole(&path, wanted.text.as_bytes()).map_err(unwritten(&path))?;
            }
            Err(e) => return Err(unread(&path)(e)),
        }
        let seed = fnv_1a(FNV_OFFSET, wanted.text.as_bytes());
        Ok(Self { parts: folder.join(wanted.kind.parts), seed })
    }

    fn path(&self, name: &str, index: usize) -> PathBuf {
        self.parts.join(name).join(format!("{index:04}.json"))
    }

    /// Checksum of a part's JSON, which also depends on the manifest and the place of the part.
    fn checksum(&self, name: &str, index: usize, json: &str) -> String {
        let place = format!("{name}/{index}:");
        let hash = fnv_1a(fnv_1a(self.seed, place.as_bytes()), json.as_bytes());
        format!("{hash:016x}")
    }

    /// The JSON of a part in its file's text.
    fn checked<'t>(&self, name: &str, index: usize, text: &'t str) -> Result<&'t str, String> {
        let parts = text.strip_prefix(HEAD).and_then(|rest| rest.split_once(MIDDLE));
        let parts = parts.and_then(|(sum, rest)| Some((sum, rest.strip_suffix('}')?)));
        match parts {
            Some((sum, json)) if sum == self.checksum(name, index, json) => Ok(json),
            Some(_) => {
                Err("its checksum does not fit: it was changed, or is of another result".into())
            }
            None => Err("it is not laid out as this program writes it".into()),
        }
    }

    /// A part that an earlier run finished.
    ///
    /// # Errors
    /// If it is there and cannot be used; the message names the file.
    fn load<T: DeserializeOwned>(&self, name: &str, index: usize) -> Result<Option<T>, StoreError> {
        let path = self.path(name, index);
        let failed = |why: String| StoreError {
            message: format!(
                "cannot use the finished part `{}`: {why}; remove it to have it computed again",
                path.display()
            ),
        };
        match read_text(&path, MOST_BYTES) {
            Ok(text) => {
                let json = self.checked(name, index, &text).map_err(failed)?;
                serde_json::from_str(json).map(Some).map_err(|e| failed(e.to_string()))
            }
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(e) => Err(failed(e.to_string())),
        }
    }

    /// Keeps a part for good.
    ///
    /// # Errors
    /// If it cannot be written; the message names the file.
    fn save(&self, name: &str, index: usize, part: &impl Serialize) -> Result<(), StoreError> {
        let path = self.path(name, index);
        let failed = |why: String| StoreError {
            message: format!(
                "cannot write `{}`: {why}; parts finished before are kept, and the same command goes \
                 on from them",
                path.display()
            ),
        };
        let text = serde_json::to_string(part).map_err(|e| failed(e.to_string()))?;
        let text = format!("{HEAD}{}{MIDDLE}{text}}}", self.checksum(name, index, &text));
        write_whole(&path, text.as_bytes()).map_err(|e| failed(e.to_string()))
    }
}

impl PointStore for KeptFiles {
    fn load(&self, chain: &Chain, index: usize) -> Result<Option<Kept>, StoreError> {
        self.load(&chain.name, index)
    }

    fn save(&self, chain: &Chain, index: usize, kept: &Kept) -> Result<(), StoreError> {
        self.save(&chain.name, index, kept)
    }
}

impl BranchStore for KeptFiles {
    fn load(&self, place: &str, number: usize) -> Result<Option<KeptPart>, StoreError> {
        self.load(place, number)
    }

    fn save(&self, place: &str, number: usize, part: &KeptPart) -> Result<(), StoreError> {
        self.save(place, number, part)
    }
}

/// Writes the results of a run, each by its name: readers see the old or the new, never a part.
pub(crate) fn write_results(
    folder: &Path,
    results: impl IntoIterator<Item = (&'static str, Vec<u8>)>,
) -> Result<()> {
    results.into_iter().try_for_each(|(name, bytes)| {
        let path = folder.join(name);
        write_whole(&path, &bytes).map_err(unwritten(&path))
    })
}

/// Start of a 64-bit FNV-1a hash.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// 64-bit FNV-1a hash (Fowler, Noll & Vo) of further bytes. It finds accidents, not forgery.
fn fnv_1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
}

/// Writes beside the file and renames: readers see the old or the new, never a part.
fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = path.with_file_name(name);
    let written = fs::File::create(&part).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()
    });
    match written.and_then(|()| fs::rename(&part, path)) {
        Ok(()) => Ok(()),
        Err(error) => {
            // If the partial file cannot be removed, the next attempt overwrites it.
            let _ = fs::remove_file(&part);
            Err(error)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors of the hash's authors.
    #[test]
    fn the_hash_is_fnv_1a() {
        assert_eq!(fnv_1a(FNV_OFFSET, b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv_1a(FNV_OFFSET, b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv_1a(FNV_OFFSET, b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn a_part_is_good_in_its_own_place_only() {
        let folder = |seed| KeptFiles { parts: PathBuf::new(), seed };
        let (own, json) = (folder(1), "{\"a\":1.5}");
        let text = |json: &str| {
            let sum = own.checksum("up_00", 0, "{\"a\":1.5}");
            format!("{HEAD}{sum}{MIDDLE}{json}}}")
        };
        assert_eq!(own.checked("up_00", 0, &text(json)), Ok(json));
        assert!(own.checked("up_00", 0, &text("{\"a\":1.6}")).is_err());
        assert!(own.checked("up_00", 1, &text(json)).is_err());
        assert!(own.checked("up_01", 0, &text(json)).is_err());
        assert!(folder(2).checked("up_00", 0, &text(json)).is_err());
        assert!(own.checked("up_00", 0, json).is_err());
    }
}
