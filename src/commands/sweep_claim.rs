//! The folder of a sweep before anything is computed: whether its contents belong to this sweep, and that no
//! other process writes into it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use experiments::sweep::Plan;
use gearset::read_text;

use crate::error::CommandError;

use super::refused;
use super::sweep_manifest::Manifest;
use super::sweep_store::MOST_BYTES;

/// Manifest of the speeds asked for.
pub(super) const PLAN: &str = "plan.json";

/// Manifest of the speeds about peaks.
pub(super) const PEAKS: &str = "plan_peaks.json";

/// Folder of finished points.
pub(super) const POINTS: &str = "points";

/// Results that the end of a sweep writes.
const RESULTS: [&str; 3] = ["sweep.csv", "sweep.json", "sweep.parquet"];

/// Held by the process that writes into a folder.
const LOCK: &str = "sweep.lock";

/// How often a lock is tried whose file its holder removes at that moment.
const ATTEMPTS: usize = 10;

/// A folder that this process alone writes a sweep into.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    /// The operating system releases its lock when the process ends, however it ends.
    _file: File,
}

impl Claim {
    /// Takes a folder for a sweep; it is created if need be. `refine`: speeds about each peak, 0 for none.
    ///
    /// # Errors
    /// If the folder holds anything else than an earlier part of this sweep, cannot be written, or is in use
    /// by another process; nothing in it is changed then.
    pub(super) fn of(folder: &Path, wanted: &Manifest, refine: u32) -> Result<Self, CommandError> {
        inspect(folder, wanted, refine)?;
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| CommandError::File { what: "cannot write", path, source }
        };
        fs::create_dir_all(folder).map_err(failed(folder))?;
        let path = folder.join(LOCK);
        let claim = lock(&path)?;
        // Another process may have written between inspection and lock.
        inspect(folder, wanted, refine)?;
        Ok(claim)
    }
}

impl Drop for Claim {
    /// Removes the lock file. If that fails it stays, and blocks nobody: only its lock counts.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Locks a file and writes the number of this process into it.
fn lock(path: &Path) -> Result<Claim, CommandError> {
    let failed = |source| CommandError::File { what: "cannot write", path: path.into(), source };
    let busy = || {
        let holder = fs::read_to_string(path).unwrap_or_default();
        let holder = match holder.trim() {
            "" => "another process".to_owned(),
            number => format!("process {number}"),
        };
        let reason = format!(
            "`{}` is locked: {holder} runs a sweep into this folder; nothing was changed: wait for its end, or \
             give another folder",
            path.display()
        );
        refused("--out", reason)
    };
    for _ in 0..ATTEMPTS {
        let options =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).clone();
        let mut file = options.open(path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(busy()),
            // Some network file systems know no locks.
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(failed(e)),
        }
        let own = format!("{}\n", std::process::id());
        file.set_len(0).and_then(|()| file.write_all(own.as_bytes())).map_err(failed)?;
        // The holder before may have removed the file after it was opened here: then the lock is on no file.
        // Windows lets nobody read a locked file by its path.
        if cfg!(windows) || fs::read_to_string(path).is_ok_and(|text| text == own) {
            return Ok(Claim { path: path.to_owned(), _file: file });
        }
    }
    Err(busy())
}

/// Refuses a folder that is none, or whose contents are not those of this sweep.
fn inspect(folder: &Path, wanted: &Manifest, refine: u32) -> Result<(), CommandError> {
    let unread = |path: &Path| {
        let path = path.to_owned();
        move |source| CommandError::File { what: "cannot read", path, source }
    };
    match fs::metadata(folder) {
        Ok(found) if !found.is_dir() => {
            let path = folder.display();
            return Err(refused("--out", format!("`{path}` is a file: allowed is a folder")));
        }
        Ok(_) => {}
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(e) => return Err(unread(folder)(e)),
    }
    let path = folder.join(PLAN);
    match read_text(&path, MOST_BYTES) {
        Ok(text) => {
            if let Some(reason) = wanted.difference(&text) {
                return Err(other_results(path, &reason));
            }
        }
        Err(e) if e.kind() == io::ErrorKind::NotFound => refuse_foreign(folder)?,
        Err(e) => return Err(unread(&path)(e)),
    }
    if let Some(path) = RESULTS.map(|name| folder.join(name)).into_iter().find(|path| path.is_dir())
    {
        let source = io::Error::other("it is a folder; remove it, or give another folder to --out");
        return Err(CommandError::File { what: "cannot write", path, source });
    }
    if refine > 0 {
        check_refinement(&folder.join(PEAKS), refine)?;
    }
    Ok(())
}

/// Refuses a folder without manifest in which something is that a sweep would write.
fn refuse_foreign(folder: &Path) -> Result<(), CommandError> {
    for name in RESULTS.into_iter().chain([PEAKS, POINTS]) {
        let path = folder.join(name);
        if fs::symlink_metadata(&path).is_ok() {
            let source = io::Error::other(format!(
                "it is there without the {PLAN} of a sweep, so that it comes from something else; nothing was \
                 changed: move it away, or give another folder to --out"
            ));
            return Err(CommandError::File { what: "not overwritten:", path, source });
        }
    }
    Ok(())
}

/// Refuses speeds about peaks that an earlier run laid out for another number of them.
fn check_refinement(path: &Path, refine: u32) -> Result<(), CommandError> {
    let Ok(text) = read_text(path, MOST_BYTES) else { return Ok(()) };
    let plan = serde_json::from_str::<serde_json::Value>(&text).ok();
    let plan =
        plan.and_then(|mut v| serde_json::from_value::<Plan>(v.get_mut("plan")?.take()).ok());
    let Some(plan) = plan else {
        return Err(other_results(path.to_owned(), "it is not the manifest of a sweep"));
    };
    let found = plan.chains.first().map(|chain| chain.speeds_rpm.len());
    match found {
        Some(found) if found != refine as usize => {
            let reason = format!("made with --refine {found}, not --refine {refine}");
            Err(other_results(path.to_owned(), &reason))
        }
        _ => Ok(()),
    }
}

/// The error for a folder with points of something else.
pub(super) fn other_results(path: PathBuf, reason: &str) -> CommandError {
    let what = "folder holds other results";
    let source =
        io::Error::other(format!("{reason}; nothing was changed: give another folder to --out"));
    CommandError::File { what, path, source }
}
