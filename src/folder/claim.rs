//! The folder of `--out` before anything is computed: whether its contents belong to this run, and that no other
//! process writes into it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use scene::read_text;

use super::kept_files::MOST_BYTES;
use super::manifest::{Manifest, PLAN, RunKind};
use crate::error::{CommandError, Result, refused, unread, unwritten};

/// How often a lock is tried whose file its holder removes at that moment.
const ATTEMPTS: usize = 10;

/// A folder that this process alone writes into.
#[derive(Debug)]
pub(crate) struct Claim {
    path: PathBuf,
    /// The operating system releases its lock when the process ends, however it ends.
    _file: File,
}

impl Claim {
    /// Takes a folder for a run; it is created if need be. `further`: what else would make its contents unfit.
    ///
    /// # Errors
    /// If the folder holds anything else than an earlier part of this run, cannot be written, or is in use by another
    /// process; nothing in it is changed then.
    pub(crate) fn of(
        folder: &Path,
        wanted: &Manifest,
        further: impl Fn(&Path) -> Result<()>,
    ) -> Result<Self> {
        let inspect = || inspect(folder, wanted).and_then(|()| further(folder));
        inspect()?;
        fs::create_dir_all(folder).map_err(unwritten(folder))?;
        let claim = lock(&folder.join(wanted.kind.lock), wanted.kind)?;
        // Another process may have written between inspection and lock.
        inspect()?;
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
fn lock(path: &Path, kind: &RunKind) -> Result<Claim> {
    let failed = unwritten(path);
    let busy = || {
        let holder = fs::read_to_string(path).unwrap_or_default();
        let holder = match holder.trim() {
            "" => "another process".to_owned(),
            number => format!("process {number}"),
        };
        let reason = format!(
            "`{}` is locked: {holder} runs {} into this folder; nothing was changed: wait for its end, or give \
             another folder",
            path.display(),
            kind.run
        );
        refused("--out", reason)
    };
    for _ in 0..ATTEMPTS {
        let options =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).clone();
        let mut file = options.open(path).map_err(&failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(busy()),
            // Some network file systems know no locks.
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(failed(e)),
        }
        let own = format!("{}\n", std::process::id());
        file.set_len(0).and_then(|()| file.write_all(own.as_bytes())).map_err(&failed)?;
        // The holder before may have removed the file after it was opened here: then the lock is on no file.
        // Windows lets nobody read a locked file by its path.
        if cfg!(windows) || fs::read_to_string(path).is_ok_and(|text| text == own) {
            return Ok(Claim { path: path.to_owned(), _file: file });
        }
    }
    Err(busy())
}

/// Refuses a folder that is none, or whose contents are not those of this run.
fn inspect(folder: &Path, wanted: &Manifest) -> Result<()> {
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
        Err(e) if e.kind() == io::ErrorKind::NotFound => refuse_foreign(folder, wanted.kind)?,
        Err(e) => return Err(unread(&path)(e)),
    }
    if let Some(path) =
        wanted.kind.results.iter().map(|name| folder.join(name)).find(|path| path.is_dir())
    {
        let source = io::Error::other("it is a folder; remove it, or give another folder to --out");
        return Err(CommandError::File { what: "cannot write", path, source });
    }
    Ok(())
}

/// Refuses a folder without manifest in which something is that the run would write.
fn refuse_foreign(folder: &Path, kind: &RunKind) -> Result<()> {
    for name in kind.results.iter().chain(kind.others).chain([&kind.parts]) {
        let path = folder.join(name);
        if fs::symlink_metadata(&path).is_ok() {
            let source = io::Error::other(format!(
                "it is there without the {PLAN} of {}, so that it comes from something else; nothing was changed: \
                 move it away, or give another folder to --out",
                kind.run
            ));
            return Err(CommandError::File { what: "not overwritten:", path, source });
        }
    }
    Ok(())
}

/// The error for a folder with points of something else.
pub(crate) fn other_results(path: PathBuf, reason: &str) -> CommandError {
    let what = "folder holds other results";
    let source =
        io::Error::other(format!("{reason}; nothing was changed: give another folder to --out"));
    CommandError::File { what, path, source }
}
