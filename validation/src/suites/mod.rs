//! The checks, suite by suite.

mod claims;
mod controls;
pub(crate) mod explained;
mod lin_parker;
mod modes_of;
mod rules;
mod structure;
mod table1;
mod tables;

use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;

/// Runs every suite, in the order of the report.
pub(crate) fn all(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let suites = [
        tables::checks,
        explained::checks,
        claims::checks,
        lin_parker::checks,
        table1::checks,
        rules::checks,
        structure::checks,
        controls::checks,
    ];
    let mut checks = Vec::new();
    for suite in suites {
        checks.extend(suite(reference)?);
    }
    Ok(checks)
}
