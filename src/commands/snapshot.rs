//! `snapshot RESULTS` and `snapshot RESULTS --check`.

use std::collections::{HashMap, HashSet};
use std::io::Write;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Serialize;
use validation::certified::{Drift, Moved, Row, Score, given_rows, read_rows, scores, write_rows};
use validation::results::{JudgeError, ResultsFolder};

use crate::arguments::Snapshot;
use crate::error::{CommandError, Result, unread, unwritten};
use crate::output::{self, Notation, Report, Table};

/// Longest baseline that is read, bytes.
const MOST_BYTES: u64 = 500_000_000;

/// Ids listed of values that are on one side alone.
const MOST_IDS: usize = 5;

/// `snapshot --check --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct DriftOutput {
    /// File of the baseline.
    baseline: String,
    #[serde(flatten)]
    drift: Drift,
}

pub(crate) fn run(arguments: &Snapshot, out: &mut dyn Write) -> Result<bool> {
    let folder = ResultsFolder::read(&arguments.results)?;
    let contradictions = folder.contradictions(None);
    if !contradictions.is_empty() {
        return Err(JudgeError::Contradictions(contradictions).into());
    }
    let now: Vec<Row> = given_rows(&folder, folder.kind(None)).collect();
    if now.is_empty() {
        let reason = "no table has a value that can be stored".to_owned();
        return Err(CommandError::Results { path: arguments.results.clone(), reason });
    }
    let path = arguments.baseline.clone().unwrap_or_else(|| beside(&arguments.results));
    if !arguments.check {
        let text = write_rows(&now).map_err(std::io::Error::from).map_err(unwritten(&path))?;
        std::fs::write(&path, text).map_err(unwritten(&path))?;
        let scores = scores(now.iter().cloned());
        let known: usize = scores.iter().map(|score| score.values).sum();
        if known > 0 {
            score_table().text(scores, out)?;
        }
        let (all, path) = (now.len(), path.display());
        writeln!(out, "stored {all} values in {path}; the data set has {known} of them")?;
        return Ok(true);
    }
    let text = ::scene::read_text(&path, MOST_BYTES).map_err(unread(&path))?;
    let unusable = |error: validation::certified::RowError| CommandError::Results {
        path: path.clone(),
        reason: format!("is no baseline: {error}; store one with `epicyclic snapshot RESULTS`"),
    };
    let baseline = read_rows(&path, &text).map_err(unusable)?;
    if let Some(reason) = unsound(&baseline, &now) {
        return Err(CommandError::Results { path, reason });
    }
    let drift = Drift::between(&baseline, &now);
    let same = drift.is_none();
    let result = DriftOutput { baseline: path.display().to_string(), drift };
    output::show(arguments.format, &result, out)?;
    Ok(same)
}

/// What in a baseline cannot be one: a value that is none, an id twice or of another row, another unit.
fn unsound(baseline: &[Row], now: &[Row]) -> Option<String> {
    let units: HashMap<&str, &str> =
        now.iter().map(|row| (row.id.as_str(), row.unit.as_str())).collect();
    let mut seen = HashSet::new();
    for (k, row) in baseline.iter().enumerate() {
        let unit = units.get(row.id.as_str()).filter(|unit| **unit != row.unit);
        let fault = match unit {
            _ if !row.value.is_finite() => format!("the value is {}", row.value),
            _ if row.id != row.name() => format!("its columns make `{}`", row.name()),
            _ if !seen.insert(row.id.as_str()) => "the row is there twice".to_owned(),
            Some(unit) => format!("the unit is `{}`, and that of the results `{unit}`", row.unit),
            None => continue,
        };
        return Some(format!("line {}: `{}`: {fault}: store a baseline again", k + 2, row.id));
    }
    None
}

/// `my_results.baseline.csv` beside the folder `my_results`.
fn beside(folder: &Path) -> PathBuf {
    let whole = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    let name = whole.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let file = format!("{name}.baseline.csv");
    // A path that ends in a name is shown as it was given.
    match folder.file_name() {
        Some(_) => folder.with_file_name(file),
        None => whole.with_file_name(file),
    }
}

/// Correct digits by scene and quantity.
fn score_table<'r>() -> Table<'r, Score> {
    Table::<Score>::new()
        .words("scene", Notation::Plain, |score| score.scene.clone())
        .words("quantity", Notation::Plain, |score| score.quantity.clone())
        .words("class", Notation::Plain, |score| score.class.name())
        .words("values", Notation::Plain, |score| score.values)
        .words("fewest correct digits", Notation::Fixed(1), |score| score.fewest_digits)
        .words("median", Notation::Fixed(1), |score| score.median_digits)
        .words("worst", Notation::Plain, |score| score.worst.clone())
}

fn table<'r>() -> Table<'r, &'r Moved> {
    let digits = |m: &&Moved| match m.digits_before.zip(m.digits_now) {
        Some((before, now)) => format!("{before:.1} to {now:.1}, {}", m.direction()),
        None => "not in the data set".to_owned(),
    };
    Table::<&Moved>::new()
        .column("id", "", |m| m.id.clone())
        .shown("value", Notation::Plain)
        .key()
        .column("baseline", "", |m| m.baseline)
        .shown("baseline", Notation::Plain)
        .column("now", "", |m| m.now)
        .shown("now", Notation::Plain)
        .column("unit", "", |m| m.unit.clone())
        .column("common_digits", "", |m| m.common_digits)
        .shown("common digits", Notation::Fixed(1))
        .column("digits_before", "", |m| m.digits_before)
        .column("digits_now", "", |m| m.digits_now)
        .shown_as("correct digits", digits)
        .column("direction", "", |m| m.direction())
}

impl Report for DriftOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(&self.drift.moved, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        let Drift { compared, moved, missing, added } = &self.drift;
        if !moved.is_empty() {
            table().text(moved, out)?;
        }
        for (ids, what) in [(missing, "only the baseline has"), (added, "only the results have")] {
            if !ids.is_empty() {
                let first = ids.iter().take(MOST_IDS).cloned().collect::<Vec<_>>().join(", ");
                let more = if ids.len() > MOST_IDS { ", …" } else { "" };
                writeln!(out, "{} values {what}: {first}{more}", ids.len())?;
            }
        }
        let moved = moved.len();
        Ok(writeln!(out, "{compared} values compared with {}: {moved} moved", self.baseline)?)
    }
}
