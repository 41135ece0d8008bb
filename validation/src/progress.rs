//! Progress of a run of checks.

use std::time::Instant;

use crate::check::Check;
use crate::error::ValidationError;

/// An event in a run of checks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// A suite begins: what its ids start with.
    SuiteStarted(&'a str),
    /// A suite has ended.
    SuiteEnded {
        /// What its ids start with.
        name: &'a str,
        /// How long it took, s.
        seconds: f64,
        /// Checks it made.
        checks: usize,
    },
}

/// Function that is told of the progress.
pub(crate) type Listener<'l> = &'l (dyn Fn(Progress<'_>) + Sync);

/// Runs suites that are computed together and tells the listener when they start and end.
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
