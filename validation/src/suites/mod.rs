//! The checks, suite by suite.

mod claims;
mod controls;
pub(crate) mod explained;
mod fe;
mod lin_parker;
pub(crate) mod modes_of;
mod rules;
pub(crate) mod statements;
mod structure;
mod table1;
pub(crate) mod tables;

use crate::Profile;
use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;

type Suite = fn(&Reference) -> Result<Vec<Check>, ValidationError>;

/// Runs every suite that has ids starting with `only`, in the order of the report.
pub(crate) fn all(
    reference: &Reference,
    profile: Profile,
    only: &str,
) -> Result<Vec<Check>, ValidationError> {
    // Each with what its ids start with.
    let suites: [(&[&str], Suite); 8] = [
        (&["table2.", "table3."], tables::checks),
        (&["table3.explained."], explained::checks),
        (&["claims."], claims::checks),
        (&["lin_parker_1999."], lin_parker::checks),
        (&["table1."], table1::checks),
        (&["rules."], rules::checks),
        (&["structure."], structure::checks),
        (&["control."], controls::checks),
    ];
    let concerns = |prefix: &str| prefix.starts_with(only) || only.starts_with(prefix);
    let mut checks = Vec::new();
    for (prefixes, suite) in suites {
        if prefixes.iter().any(|p| concerns(p)) {
            checks.extend(suite(reference)?);
        }
    }
    checks.extend(fe::checks(reference, profile, &concerns)?);
    checks.retain(|check| check.id.starts_with(only));
    Ok(checks)
}
