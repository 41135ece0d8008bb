//! A verdict as `validate` prints it.

use std::io::Write;

use serde::Serialize;
use validation::{Check, Miss, Status, Value, Verdict};

use super::check_cells::{cells, coloured, status_word};
use super::summary;
use crate::error::Result;
use crate::output::{Notation, Report, Table};

/// A verdict, and how text shows it.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(super) struct VerdictOutput {
    pub(super) verdict: Verdict,
    /// Analyses of listed misses.
    #[serde(skip)]
    pub(super) misses: Vec<Miss>,
    /// Whether every check is listed.
    #[serde(skip)]
    pub(super) details: bool,
}

pub(super) fn table<'r>() -> Table<'r, &'r Check> {
    let cell = |i: usize| move |check: &&Check| cells(check)[i].clone();
    // Lists have no place in a cell of a file.
    let value = |value: Option<&Value>| match value? {
        Value::Number(x) => Some(x.to_string()),
        Value::Text(text) => Some(text.clone()),
        Value::List(_) => None,
    };
    Table::<&Check>::new()
        .column("check", "", |check| &check.id)
        .shown("check", Notation::Plain)
        .key()
        .column("title", "", |check| &check.title)
        .column("expected", "", move |check| value(Some(&check.expected)))
        .shown_as("expected", cell(0))
        .right()
        .column("actual", "", move |check| value(check.actual.as_ref()))
        .shown_as("actual", cell(1))
        .right()
        .column("unit", "", |check| &check.unit)
        .shown("unit", Notation::Plain)
        .column("difference_percent", "", |check| check.difference_percent)
        .shown_as("difference %", cell(2))
        .column("tolerance", "", |check| check.tolerance.absolute)
        .shown_as("tolerance", cell(3))
        .column("verdict", "", |check| status_word(check.status))
        .shown("verdict", Notation::Plain)
}

impl Report for VerdictOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(&self.verdict.checks, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        match self.details {
            true => details(&self.verdict, out),
            false => Ok(summary::write(&self.verdict, &self.misses, out)?),
        }
    }
}

/// Every check, then those that failed in full.
fn details(verdict: &Verdict, out: &mut dyn Write) -> Result<()> {
    let mut text = Vec::new();
    table().text(&verdict.checks, &mut text)?;
    for line in String::from_utf8_lossy(&text).lines().map(str::trim_end) {
        let words = [Status::Pass, Status::Miss, Status::Fail].into_iter();
        let end = words.filter_map(|s| Some((line.strip_suffix(status_word(s))?, s))).next();
        match end {
            Some((front, status)) => {
                writeln!(out, "{front}{}", coloured(status_word(status), status))?
            }
            None => writeln!(out, "{line}")?,
        }
    }
    for check in verdict.checks.iter().filter(|c| c.status == Status::Fail) {
        writeln!(out, "FAILED {}: {} (source: {})", check.id, check.title, check.source)?;
        let (expected, actual) = (&check.expected, &check.actual);
        writeln!(out, "  expected {expected:?}, actual {actual:?}")?;
    }
    let Verdict { passed, missed, failed, .. } = verdict;
    if *missed > 0 {
        writeln!(out, "misses are analysed in checks/misses.toml")?;
    }
    Ok(writeln!(out, "{passed} passed, {missed} missed, {failed} failed")?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn details_keep_every_id() {
        let verdict = summary::kept();
        let mut out = Vec::new();
        details(&verdict, &mut out).unwrap();
        let text = String::from_utf8(anstream::adapter::strip_bytes(&out).into_vec()).unwrap();
        assert!(verdict.checks.iter().all(|check| text.contains(&check.id)));
    }
}
