//! Files and folders that a verb writes: refused before the work whose results they are to hold, written whole, and
//! resumed by the same command.

mod claim;
mod empty;
mod files;
mod kept_files;
mod manifest;

pub(crate) use claim::{Claim, other_results};
pub(crate) use empty::must_be_empty;
pub(crate) use files::{ResultFiles, folder, save, writable};
pub(crate) use kept_files::{KeptFiles, MOST_BYTES, write_results};
pub(crate) use manifest::{Manifest, PLAN, RunKind};
