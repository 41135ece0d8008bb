//! The summary as text and CSV.

use std::io::Write;

use validation::NotAsked;
use validation::results::AskedSuite;

use super::check::ResultsSummary;
use super::contents::Contents;
use crate::error::CommandError;
use crate::output::{Notation, Report, Table, paragraph};

/// A suite, whether it is asked or not.
enum Row<'s> {
    Asked(&'s AskedSuite),
    NotAsked(&'s NotAsked),
}

impl Report for ResultsSummary {
    fn csv(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let asked = self.asked.iter().map(Row::Asked);
        suites().csv(asked.chain(self.not_asked.iter().map(Row::NotAsked)), out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let program = self.program.as_deref().unwrap_or("results");
        let version = self.version.as_ref().map_or(String::new(), |v| format!(" {v}"));
        writeln!(out, "{program}{version} in {}, kind {}", self.folder, self.kind.name())?;
        writeln!(out)?;
        tables(&self.tables).text(&self.tables, out)?;
        list("remarks", &self.remarks, out)?;
        list("contradictions", &self.contradictions, out)?;
        if !self.asked.is_empty() {
            writeln!(out, "\ncan be asked:")?;
            suites().text(self.asked.iter().map(Row::Asked), out)?;
        }
        let lacks: Vec<String> =
            self.not_asked.iter().map(|s| format!("{}: needs {}", s.suite, s.lacks)).collect();
        list("not asked", &lacks, out)
    }
}

/// What is there; a column of which no table has anything is left out.
fn tables<'r>(rows: &[Contents]) -> Table<'r, &'r Contents> {
    let mut table = Table::new()
        .words("table", Notation::Plain, |row: &&Contents| &row.table)
        .key()
        .words("scene", Notation::Plain, |row| &row.scene)
        .key()
        .words("rows", Notation::Plain, |row| row.rows);
    if rows.iter().any(|row| row.modes.is_some()) {
        table = table.words("modes", Notation::Plain, |row| row.modes);
    }
    if rows.iter().any(|row| !row.sun_torques_nm.is_empty()) {
        let torques = |row: &&Contents| range(&row.sun_torques_nm);
        table = table.words("sun torques N·m", Notation::Plain, torques).right();
    }
    if rows.iter().any(|row| !row.speeds_rpm.is_empty()) {
        table = table.words("speeds rpm", Notation::Plain, |row| range(&row.speeds_rpm)).right();
    }
    if rows.iter().any(|row| !row.positions.is_empty()) {
        let count = |row: &&Contents| (!row.positions.is_empty()).then_some(row.positions.len());
        table = table.words("positions", Notation::Plain, count);
    }
    table
}

/// Suites with what is asked or needed.
fn suites<'r>() -> Table<'r, Row<'r>> {
    let asked = |row: &Row<'_>| match row {
        Row::Asked(suite) => Some((suite.checks, suite.judged)),
        Row::NotAsked(_) => None,
    };
    Table::new()
        .column("suite", "", |row: &Row<'_>| match row {
            Row::Asked(suite) => suite.suite.clone(),
            Row::NotAsked(suite) => suite.suite.clone(),
        })
        .shown("suite", Notation::Plain)
        .column("checks", "", move |row| asked(row).map(|(checks, _)| checks))
        .shown("checks", Notation::Plain)
        .column("judged", "", move |row| asked(row).map(|(_, judged)| judged))
        .shown_as("", move |row| match asked(row) {
            Some((_, false)) => "of another kind of model: shown, not judged".to_owned(),
            _ => "judged".to_owned(),
        })
        .column("needs", "", |row| match row {
            Row::Asked(_) => None,
            Row::NotAsked(suite) => Some(suite.lacks.clone()),
        })
}

/// `113 … 1356 (12)`; nothing of no numbers.
fn range(numbers: &[f64]) -> Option<String> {
    match numbers {
        [] => None,
        [one] => Some(one.to_string()),
        [a, b] => Some(format!("{a}, {b}")),
        [first, .., last] => Some(format!("{first} … {last} ({})", numbers.len())),
    }
}

fn list(heading: &str, lines: &[String], out: &mut dyn Write) -> Result<(), CommandError> {
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{heading}:")?;
    for line in lines {
        writeln!(out, "{}", paragraph(line, "  ", "    "))?;
    }
    Ok(())
}
