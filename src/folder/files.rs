//! Files that a verb writes: refused before the work whose results they are to hold, where they cannot be written.

use std::fs::{self, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use crate::error::{Result, refused, unwritten};
#[cfg(feature = "charts")]
use crate::figures::{self, Figure};
use crate::output::{self, Report};

/// The folder of `--out`, if it is given, which receives a result as `NAME.json`, its table as `NAME.csv`, and its
/// figure.
pub(crate) struct ResultFiles<'f> {
    folder: Option<&'f Path>,
    name: &'f str,
}

impl<'f> ResultFiles<'f> {
    /// Refuses what cannot be written, before the work whose results it is to hold.
    pub(crate) fn new(folder: Option<&'f Path>, name: &'f str) -> Result<Self> {
        self::folder("--out", folder)?;
        let own = Self { folder, name };
        for ending in ["json", "csv"] {
            writable(own.file(ending).as_deref())?;
        }
        Ok(own)
    }

    fn file(&self, ending: &str) -> Option<PathBuf> {
        Some(self.folder?.join(format!("{}.{ending}", self.name)))
    }

    /// Writes the result and its table.
    pub(crate) fn save(&self, result: &impl Report) -> Result<()> {
        let (Some(json_file), Some(csv_file)) = (self.file("json"), self.file("csv")) else {
            return Ok(());
        };
        let [mut json, mut table] = [Vec::new(), Vec::new()];
        output::json(&mut json, result)?;
        result.csv(&mut table)?;
        save(&json_file, &String::from_utf8_lossy(&json))?;
        save(&csv_file, &String::from_utf8_lossy(&table))
    }

    /// Draws the figure.
    #[cfg(feature = "charts")]
    pub(crate) fn draw(&self, figure: impl FnOnce() -> Figure) -> Result<()> {
        self.folder.map_or(Ok(()), |folder| Ok(figures::save(&[figure()], folder)?))
    }
}

/// Writes a file, creating its folder if need be.
pub(crate) fn save(path: &Path, text: &str) -> Result<()> {
    if let Some(folder) = folder_of(path) {
        fs::create_dir_all(folder).map_err(unwritten(path))?;
    }
    fs::write(path, text).map_err(unwritten(path))
}

/// Refuses a file that cannot be written, before the work whose results it is to hold: a folder in its place, a file in
/// place of its folder, which is made if need be, or what the user may not write. A file that is there is left as it
/// is.
pub(crate) fn writable(path: Option<&Path>) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    if path.is_dir() {
        return Err(unwritten(path)(io::ErrorKind::IsADirectory.into()));
    }
    if path.exists() {
        return OpenOptions::new().append(true).open(path).map(drop).map_err(unwritten(path));
    }
    try_folder(folder_of(path).unwrap_or(Path::new("."))).map_err(unwritten(path))
}

/// Refuses a folder that cannot be made or written into, before the work whose results it is to hold.
pub(crate) fn folder(argument: &'static str, path: Option<&Path>) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    if path.exists() && !path.is_dir() {
        let reason = format!("`{}` is a file: allowed is a folder", path.display());
        return Err(refused(argument, reason));
    }
    try_folder(path).map_err(unwritten(path))
}

/// Makes a folder if need be, and a file in it that is removed again.
fn try_folder(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let path = folder.join(format!(".epicyclic.{}.part", std::process::id()));
    fs::File::create(&path)?;
    fs::remove_file(&path)
}

/// The folder of a file, `None` for the one in which the command runs.
fn folder_of(path: &Path) -> Option<&Path> {
    path.parent().filter(|p| !p.as_os_str().is_empty())
}
