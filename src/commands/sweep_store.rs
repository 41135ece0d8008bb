//! Finished points of a sweep in a folder: each is written completely or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use experiments::sweep::{Chain, Kept, PointStore, StoreError};
use gearset::read_text;

use crate::error::CommandError;

use super::sweep_claim::{POINTS, other_results};
use super::sweep_manifest::Manifest;

/// Longest manifest or point that is read, bytes: some million numbers, as the state of full bodies has, fit several
/// times.
pub(super) const MOST_BYTES: u64 = 200_000_000;

/// Before the checksum in the file of a point.
const HEAD: &str = "{\"checksum\":\"";

/// Between the checksum and the point.
const MIDDLE: &str = "\",\"point\":";

/// A folder of points.
#[derive(Debug)]
pub(super) struct Folder {
    points: PathBuf,
    /// Hash of the manifest, so that a point of another plan is recognised.
    seed: u64,
}

impl Folder {
    /// Opens a folder for a plan; points that an earlier run of the same plan left in it are used.
    /// `name`: name of the manifest's file, which is written if it is not there.
    ///
    /// # Errors
    /// If the folder holds the manifest of something else, or cannot be read or written.
    pub(super) fn open(folder: &Path, name: &str, wanted: &Manifest) -> Result<Self, CommandError> {
        let path = folder.join(name);
        let own = serde_json::to_string_pretty(wanted)?;
        match read_text(&path, MOST_BYTES) {
            Ok(text) => {
                if let Some(reason) = wanted.difference(&text) {
                    return Err(other_results(path, &reason));
                }
            }
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                write_whole(&path, own.as_bytes()).map_err(|source| CommandError::File {
                    what: "cannot write",
                    path,
                    source,
                })?;
            }
            Err(source) => return Err(CommandError::File { what: "cannot read", path, source }),
        }
        Ok(Self { points: folder.join(POINTS), seed: fnv_1a(FNV_OFFSET, own.as_bytes()) })
    }

    fn path(&self, chain: &Chain, index: usize) -> PathBuf {
        self.points.join(&chain.name).join(format!("{index:04}.json"))
    }

    /// Checksum of a point's JSON, which also depends on the manifest and the place of the point in its plan.
    fn checksum(&self, chain: &Chain, index: usize, json: &str) -> String {
        let place = format!("{}/{index}:", chain.name);
        let hash = fnv_1a(fnv_1a(self.seed, place.as_bytes()), json.as_bytes());
        format!("{hash:016x}")
    }

    /// The JSON of a point in its file's text.
    fn checked<'t>(&self, chain: &Chain, index: usize, text: &'t str) -> Result<&'t str, String> {
        let parts = text.strip_prefix(HEAD).and_then(|rest| rest.split_once(MIDDLE));
        let parts = parts.and_then(|(sum, rest)| Some((sum, rest.strip_suffix('}')?)));
        match parts {
            Some((sum, json)) if sum == self.checksum(chain, index, json) => Ok(json),
            Some(_) => {
                Err("its checksum does not fit: it was changed, or is of another sweep".into())
            }
            None => Err("it is not laid out as this program writes it".into()),
        }
    }
}

/// Start of a 64-bit FNV-1a hash.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// 64-bit FNV-1a hash (Fowler, Noll & Vo) of further bytes. It finds accidents, not forgery.
fn fnv_1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
}

/// Writes beside the file and renames: readers see the old or the new, never a part.
pub(super) fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
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

impl PointStore for Folder {
    fn load(&self, chain: &Chain, index: usize) -> Result<Option<Kept>, StoreError> {
        let path = self.path(chain, index);
        let failed = |why: String| StoreError {
            message: format!(
                "cannot use the finished point `{}`: {why}; remove it to have it computed again",
                path.display()
            ),
        };
        match read_text(&path, MOST_BYTES) {
            Ok(text) => {
                let json = self.checked(chain, index, &text).map_err(failed)?;
                serde_json::from_str(json).map(Some).map_err(|e| failed(e.to_string()))
            }
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(e) => Err(failed(e.to_string())),
        }
    }

    fn save(&self, chain: &Chain, index: usize, kept: &Kept) -> Result<(), StoreError> {
        let path = self.path(chain, index);
        let failed = |why: String| StoreError {
            message: format!(
                "cannot write `{}`: {why}; points finished before are kept, and the same command goes \
                 on from them",
                path.display()
            ),
        };
        let text = serde_json::to_string(kept).map_err(|e| failed(e.to_string()))?;
        let text = format!("{HEAD}{}{MIDDLE}{text}}}", self.checksum(chain, index, &text));
        write_whole(&path, text.as_bytes()).map_err(|e| failed(e.to_string()))
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
    fn a_point_is_good_in_its_own_place_only() {
        let folder = |seed| Folder { points: PathBuf::new(), seed };
        let chain = |name: &str| Chain { name: name.into(), speeds_rpm: vec![100.0, 200.0] };
        let (own, json) = (folder(1), "{\"a\":1.5}");
        let text = |json: &str| {
            let sum = own.checksum(&chain("up_00"), 0, "{\"a\":1.5}");
            format!("{HEAD}{sum}{MIDDLE}{json}}}")
        };
        assert_eq!(own.checked(&chain("up_00"), 0, &text(json)), Ok(json));
        assert!(own.checked(&chain("up_00"), 0, &text("{\"a\":1.6}")).is_err());
        assert!(own.checked(&chain("up_00"), 1, &text(json)).is_err());
        assert!(own.checked(&chain("up_01"), 0, &text(json)).is_err());
        assert!(folder(2).checked(&chain("up_00"), 0, &text(json)).is_err());
        assert!(own.checked(&chain("up_00"), 0, json).is_err());
    }
}
