//! A folder that is to be written.

use std::io::ErrorKind;
use std::path::Path;

use crate::error::{CommandError, refused, unread};

/// Refuses a folder with files in it: what is there is never mixed with what is written.
pub(crate) fn must_be_empty(folder: &Path) -> Result<(), CommandError> {
    match std::fs::read_dir(folder) {
        Ok(mut entries) => match entries.next() {
            None => Ok(()),
            Some(_) => {
                let reason = format!("{} is not empty: take another folder", folder.display());
                Err(refused("DIR", reason))
            }
        },
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(unread(folder)(error)),
    }
}
