//! What a run of checks is at, for those who wait for it.

use std::time::Instant;

use crate::check::Check;
use crate::error::ValidationError;

/// What a run of checks is at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// A suite begins: what its ids start with.
    SuiteStarted(&'a str),
    /// A suite is through.
    SuiteEnded {
        /// What its ids start with.
        name: &'a str,
        /// How long it took, s.
        seconds: f64,
        /// Checks it made.
        checks: usize,
    },
}

/// Who is told.
pub(crate) type Listener<'l> = &'l (dyn Fn(Progress<'_>) + Sync);

/// Runs suites that are made together, by their names, and says so before and after.
pub(crate) fn told(
    prefixes: &[&str],
    listener: Listener<'_>,
    suite: impl FnOnce() -> Result<Vec<Check>, ValidationError>,
) -> Result<Vec<Check>, ValidationError> {
    let name = prefixes.join(", ");
    listener(Progress::SuiteStarted(&name));
    let start = Instant::now();
    let checks = suite()?;
    let seconds = start.elapsed().as_secs_f64();
    listener(Progress::SuiteEnded { name: &name, seconds, checks: checks.len() });
    Ok(checks)
}
