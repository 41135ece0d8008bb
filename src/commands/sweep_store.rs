//! Finished points of a sweep in a folder: each is written completely or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use experiments::sweep::{Chain, Kept, Plan, PointStore, StoreError};
use serde::{Deserialize, Serialize};

use crate::error::CommandError;

/// Format of the folder; another one is refused.
const FORMAT: u32 = 2;

/// What the points in a folder were computed from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Manifest {
    /// Format of the folder.
    pub(super) format: u32,
    /// Version of the program that computed the points.
    pub(super) version: String,
    /// The scene file's text.
    pub(super) scene: String,
    pub(super) fidelity: String,
    pub(super) torque_nm: f64,
    pub(super) plan: Plan,
}

impl Manifest {
    pub(super) fn new(scene: String, fidelity: String, torque_nm: f64, plan: Plan) -> Self {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Self { format: FORMAT, version, scene, fidelity, torque_nm, plan }
    }
}

/// A folder of points.
#[derive(Debug)]
pub(super) struct Folder {
    points: PathBuf,
}

impl Folder {
    /// Opens a folder for a plan; points that an earlier run of the same plan left in it are used.
    /// `name`: name of the manifest's file.
    pub(super) fn open(folder: &Path, name: &str, wanted: &Manifest) -> Result<Self, CommandError> {
        let path = folder.join(name);
        match fs::read_to_string(&path) {
            Ok(text) => {
                if let Some(reason) = difference(&text, wanted) {
                    let what = "folder holds other results";
                    let source = io::Error::other(format!(
                        "{reason}; nothing was changed: give another folder to --out"
                    ));
                    return Err(CommandError::File { what, path, source });
                }
            }
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                let text = serde_json::to_string_pretty(wanted)?;
                write_whole(&path, text.as_bytes()).map_err(|source| CommandError::File {
                    what: "cannot write",
                    path,
                    source,
                })?;
            }
            Err(source) => return Err(CommandError::File { what: "cannot read", path, source }),
        }
        Ok(Self { points: folder.join("points") })
    }

    fn path(&self, chain: &Chain, index: usize) -> PathBuf {
        self.points.join(&chain.name).join(format!("{index:04}.json"))
    }
}

/// The first difference of a manifest from the one wanted.
fn difference(text: &str, wanted: &Manifest) -> Option<String> {
    let Ok(value) = serde_json::from_str::<serde_json::Value>(text) else {
        return Some("its manifest is no JSON".into());
    };
    let format = value.get("format").and_then(serde_json::Value::as_u64);
    if format != Some(u64::from(FORMAT)) {
        let found = format.map_or("none".to_owned(), |f| f.to_string());
        return Some(format!("format {found} where this program writes {FORMAT}"));
    }
    let Ok(found) = serde_json::from_value::<Manifest>(value) else {
        return Some("its manifest lacks keys".into());
    };
    let Manifest { version, scene, fidelity, torque_nm, plan, .. } = found;
    if version != wanted.version {
        return Some(format!("written by version {version}, this is {}", wanted.version));
    }
    if scene != wanted.scene {
        return Some("the scene file has another text".into());
    }
    if fidelity != wanted.fidelity {
        return Some(format!("of fidelity {fidelity}, not {}", wanted.fidelity));
    }
    if torque_nm != wanted.torque_nm {
        return Some(format!("under {torque_nm} N·m, not {} N·m", wanted.torque_nm));
    }
    (plan != wanted.plan).then(|| "of other speeds or settings".into())
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
        match fs::read_to_string(&path) {
            Ok(text) => serde_json::from_str(&text).map(Some).map_err(|e| failed(e.to_string())),
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
        write_whole(&path, text.as_bytes()).map_err(|e| failed(e.to_string()))
    }
}
