//! The judgement as text: at most sixty lines of a hundred columns, unless all checks are asked for.

use std::io::Write;

use validation::certified::Score;
use validation::{Check, NotAsked, Status};

use super::RecordedOutput;
use super::row::digits_cell;
use crate::commands::validate::check_cells::{cells, status_word};
use crate::commands::validate::result;
use crate::commands::validate::summary::suite_of;
use crate::error::Result;
use crate::output::{Notation, Report, Table, paragraph};

/// Rows shown of each status.
const MOST_ROWS: usize = 8;

/// Notes shown of failed checks.
const MOST_NOTES: usize = 2;

/// Suites listed that were not asked.
const MOST_SUITES: usize = 5;

impl Report for RecordedOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        result::table().csv(&self.verdict.checks, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        let about = &self.about;
        writeln!(out, "{} in {}, kind {}", self.program(), about.folder, about.kind.name())?;
        for remark in &about.remarks {
            writeln!(out, "{}", paragraph(remark, "  ", "  "))?;
        }
        let checks = &self.verdict.checks;
        if self.details {
            let verdict = |check: &&Check| status_word(check.status);
            let digits = |check: &&Check| digits_cell(self.digits.get(&check.id).copied());
            let table = table().words("digits", Notation::Plain, digits).right();
            table.words("verdict", Notation::Plain, verdict).text(checks, out)?;
        } else {
            let headings = [
                (Status::Fail, "failed"),
                (Status::Miss, "missed: listed in checks/misses.toml, or accepted"),
                (Status::OtherKind, "another kind of model: shown, not judged"),
            ];
            for (status, heading) in headings {
                some(checks, status, heading, out)?;
            }
        }
        not_asked(&self.verdict.not_asked, out)?;
        passed(checks, out)?;
        self.beside_the_data_set(out)?;
        Ok(writeln!(out, "{}", self.counts())?)
    }
}

impl RecordedOutput {
    /// The fewest correct digits of every quantity that the data set has.
    fn beside_the_data_set(&self, out: &mut dyn Write) -> Result<()> {
        let mut worst: Vec<(&Score, usize)> = Vec::new();
        for score in &self.scores {
            match worst.iter_mut().find(|(known, _)| known.quantity == score.quantity) {
                Some((known, values)) => {
                    *values += score.values;
                    if score.fewest_digits < known.fewest_digits {
                        *known = score;
                    }
                }
                None => worst.push((score, score.values)),
            }
        }
        if worst.is_empty() {
            return Ok(());
        }
        let one = |(score, values): &(&Score, usize)| {
            let Score { quantity, fewest_digits, worst, .. } = score;
            format!("{quantity} {fewest_digits:.1} of {values} values ({worst})")
        };
        let each: Vec<String> = worst.iter().map(one).collect();
        let text = format!("fewest correct digits beside the data set: {}", each.join(", "));
        Ok(writeln!(out, "{}", paragraph(&text, "", "  "))?)
    }
}

/// Checks beside their references.
fn table<'r>() -> Table<'r, &'r Check> {
    let cell = |i: usize| move |check: &&Check| cells(check)[i].clone();
    Table::new()
        .words("check", Notation::Plain, |check: &&Check| check.id.clone())
        .key()
        .words("reference", Notation::Plain, cell(0))
        .right()
        .words("yours", Notation::Plain, cell(1))
        .right()
        .words("unit", Notation::Plain, |check| check.unit.clone())
        .words("difference %", Notation::Plain, cell(2))
        .right()
        .words("tolerance", Notation::Plain, cell(3))
        .right()
}

/// The first rows of a status under a heading, how many more there are, and notes of failed ones.
fn some(checks: &[Check], status: Status, heading: &str, out: &mut dyn Write) -> Result<()> {
    let rows: Vec<&Check> = checks.iter().filter(|check| check.status == status).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{heading}:")?;
    table().text(rows.iter().copied().take(MOST_ROWS), out)?;
    if rows.len() > MOST_ROWS {
        writeln!(out, "and {} more (--details lists all)", rows.len() - MOST_ROWS)?;
    }
    if status == Status::Fail {
        let notes = rows.iter().filter_map(|check| Some((&check.id, check.note.as_ref()?)));
        for (id, note) in notes.take(MOST_NOTES) {
            writeln!(out, "{}", paragraph(&format!("{id}: {note}"), "  ", "    "))?;
        }
    }
    Ok(())
}

/// Suites with checks that passed, and how many.
fn passed(checks: &[Check], out: &mut dyn Write) -> Result<()> {
    let mut suites: Vec<(&str, usize)> = Vec::new();
    for check in checks.iter().filter(|check| check.status == Status::Pass) {
        let name = suite_of(&check.id);
        match suites.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => suites.push((name, 1)),
        }
    }
    if !suites.is_empty() {
        let each: Vec<String> = suites.iter().map(|(name, n)| format!("{name} {n}")).collect();
        writeln!(out, "{}", paragraph(&format!("\npassed: {}", each.join(", ")), "", "  "))?;
    }
    Ok(())
}

fn not_asked(suites: &[NotAsked], out: &mut dyn Write) -> Result<()> {
    if suites.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nnot asked:")?;
    for NotAsked { suite, lacks } in suites.iter().take(MOST_SUITES) {
        writeln!(out, "{}", paragraph(&format!("{suite}: needs {lacks}"), "  ", "    "))?;
    }
    if suites.len() > MOST_SUITES {
        writeln!(out, "  and {} more (`epicyclic results check`)", suites.len() - MOST_SUITES)?;
    }
    Ok(())
}
