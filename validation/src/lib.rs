//! Virtual experiments and checks: the models against published numbers, theorems and each other.

mod catalogue;
mod check;
mod compare;
pub mod effects;
mod error;
mod ledger;
mod own_truth;
mod reference;
mod suites;
mod verdict;

pub use catalogue::{PublishedScene, scene};
pub use check::{Check, ReferenceKind, Status, Subject, Tolerance, Value};
pub use compare::{Comparison, ListedMode, Match, ModelMode, compare};
pub use error::ValidationError;
pub use ledger::{Assumption, Figure, Ledger};
pub use own_truth::{
    ExactPeak, ExactPeaks, FullSweep, FullSweepPoint, Ladder, LadderFidelity, MapCell,
    RotationalPeak, TorqueMap, TorquePeak, TorquePeaks,
};
pub use reference::{Frequencies, Miss, ModeTable, Reference, ReferenceError};
pub use suites::explained::{Step, steps};
pub use suites::statements::{Statement, judge};
pub use suites::tables::Table;
pub use verdict::Verdict;

/// How much to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    /// What a minute or two allows; the other checks are listed as not run.
    Quick,
    /// Everything.
    Full,
}

/// Runs the checks whose ids start with `only`, or all of them if it is empty.
///
/// # Errors
/// If the reference data, a scene of the catalogue or a model cannot be used: a defect of the
/// program, not a failed check.
pub fn validate(profile: Profile, only: &str) -> Result<Verdict, ValidationError> {
    let reference = Reference::load()?;
    let checks = suites::all(&reference, profile, only)?;
    let concerned: Vec<Miss> =
        reference.misses.iter().filter(|m| m.id.starts_with(only)).cloned().collect();
    Ok(Verdict::new(checks, &concerned))
}
