//! Judged checks by the suites of the registry.

use validation::{NotAsked, Registry, Status, ValidationError};

use super::RecordedOutput;
use super::row::JudgedRow;
use crate::error::Result;

/// A suite with what it found, and what it could not ask.
pub(super) struct JudgedSuite<'v> {
    pub(super) name: String,
    /// What is compared with what.
    pub(super) about: String,
    pub(super) rows: Vec<JudgedRow<'v>>,
    pub(super) not_asked: Vec<&'v NotAsked>,
}

impl JudgedSuite<'_> {
    pub(super) fn count(&self, status: Status) -> usize {
        self.rows.iter().filter(|row| row.status == status).count()
    }

    /// Neighbours whose tolerances have one reason and whose references have one source.
    pub(super) fn groups(&self) -> impl Iterator<Item = &[JudgedRow<'_>]> {
        self.rows.chunk_by(|a, b| a.reason == b.reason && a.source == b.source)
    }
}

impl RecordedOutput {
    /// Suites that were asked in the order of their checks, then those that were not.
    pub(super) fn suites(&self) -> Result<Vec<JudgedSuite<'_>>> {
        let registry = Registry::load().map_err(ValidationError::from)?;
        let mut suites = Vec::new();
        for check in &self.verdict.checks {
            let name = registry.suite_of(&check.id).map_or(check.id.as_str(), |s| s.name.as_str());
            let digits = self.digits.get(&check.id).copied();
            let row = JudgedRow::new(check, &self.accepted, digits);
            suite(&mut suites, name, &registry).rows.push(row);
        }
        for not_asked in &self.verdict.not_asked {
            suite(&mut suites, &not_asked.suite, &registry).not_asked.push(not_asked);
        }
        Ok(suites)
    }
}

/// The suite of a name, which is begun if it is new.
fn suite<'s, 'v>(
    suites: &'s mut Vec<JudgedSuite<'v>>,
    name: &str,
    registry: &Registry,
) -> &'s mut JudgedSuite<'v> {
    let place = suites.iter().position(|suite| suite.name == name).unwrap_or_else(|| {
        let entry = registry.suite.iter().find(|entry| entry.name == name);
        suites.push(JudgedSuite {
            name: name.to_owned(),
            about: entry.map_or_else(String::new, |entry| entry.about.clone()),
            rows: Vec::new(),
            not_asked: Vec::new(),
        });
        suites.len() - 1
    });
    &mut suites[place]
}
