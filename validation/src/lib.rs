//! Virtual experiments and checks: the models against published numbers, theorems and each other.

mod catalogue;
mod check;
mod compare;
mod error;
mod reference;
mod suites;
mod verdict;

pub use catalogue::{PublishedScene, scene};
pub use check::{Check, ReferenceKind, Status, Subject, Tolerance, Value};
pub use compare::{Comparison, ListedMode, Match, ModelMode, compare};
pub use error::ValidationError;
pub use reference::{Frequencies, Miss, Reference, ReferenceError};
pub use suites::explained::{Step, steps};
pub use verdict::Verdict;

/// Runs every check.
///
/// # Errors
/// If the reference data, a scene of the catalogue or a model cannot be used: a defect of the
/// program, not a failed check.
pub fn validate() -> Result<Verdict, ValidationError> {
    let reference = Reference::load()?;
    let checks = suites::all(&reference)?;
    Ok(Verdict::new(checks, &reference.misses))
}
