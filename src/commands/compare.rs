//! `compare MODES.csv --scene SCENE`.

use std::io::Write;
use std::path::Path;

use scene::Verb;
use serde::Serialize;
use validation::{Comparison, ListedMode, Match, ModelMode, compare};

use super::modes::{self, PARAMETERS};
use crate::arguments::Compare;
use crate::error::{CommandError, Result, unfit, unread};
use crate::inputs::{needs, read_scene};
use crate::output::{self, Notation, Report, Table};

/// Longest list that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

const TYPES: [&str; 4] = ["rotational", "translational", "planet", "mixed"];

pub(crate) fn run(arguments: &Compare, out: &mut dyn Write) -> Result<bool> {
    let listed = read_modes(&arguments.modes)?;
    let scene = read_scene(&arguments.scene)?;
    match scene.has_closed_forms() {
        true => needs::require(&arguments.scene, &scene, Verb::Compare, |_| false)?,
        false => {
            let of_kind = scene.lacks(Verb::Compare).into_iter().find(|lack| lack.key == "kind");
            if let Some(lack) = of_kind {
                return Err(unfit(&arguments.scene, format!("`{}`: {}", lack.key, lack.why)));
            }
        }
    }
    let (_, found) = modes::solve(&scene).map_err(|reason| unfit(&arguments.scene, reason))?;
    let model: Vec<ModelMode> = found
        .groups
        .iter()
        .map(|g| ModelMode {
            frequency_hz: g.frequency_hz,
            mode_type: g.mode_type.name().to_owned(),
            multiplicity: g.multiplicity,
        })
        .collect();
    let result = compare(&listed, &model, arguments.tolerance_percent, arguments.whole);
    let against = match scene.has_closed_forms() {
        true => format!("against the lumped model, {PARAMETERS}, of: {}", scene.title),
        false => format!("against the lumped model of: {}", scene.title),
    };
    let result = CompareOutput { result, against };
    output::show(arguments.format, &result, out)?;
    Ok(result.result.disagreed == 0)
}

/// `compare --format json`.
#[derive(Debug, Serialize)]
#[serde(transparent)]
struct CompareOutput {
    result: Comparison,
    /// What the list is held against.
    #[serde(skip)]
    against: String,
}

fn table<'r>() -> Table<'r, &'r Match> {
    use Notation::{Fixed, Plain, Signed};
    let listed = |m: &&Match| match m.listed_hz.as_slice() {
        [] => "–".to_owned(),
        list => list.iter().map(|f| format!("{f:.2}")).collect::<Vec<_>>().join(", "),
    };
    Table::<&Match>::new()
        .column("model_hz", "", |m| m.model_hz)
        .shown("model Hz", Fixed(2))
        .column("model_type", "", |m| m.model_type.clone())
        .shown("type", Plain)
        .column("model_multiplicity", "", |m| m.model_multiplicity)
        .shown("times", Plain)
        .column("listed_hz", "", |m| {
            m.listed_hz.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
        })
        .shown_as("listed Hz", listed)
        .right()
        .column("difference_percent", "", |m| m.difference_percent)
        .shown("difference %", Signed(3))
        .column("remark", "", |m| m.remark.clone())
        .shown_as("", |m| m.remark.clone().unwrap_or_else(|| "agrees".into()))
}

impl Report for CompareOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(&self.result.matches, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}", self.against)?;
        let Comparison { matches, agreed, disagreed, beyond_list, .. } = &self.result;
        table().text(matches, out)?;
        writeln!(
            out,
            "{agreed} agree, {disagreed} do not, largest difference {:.3} % (tolerance {} %)",
            self.result.largest_difference_percent, self.result.tolerance_percent
        )?;
        if *beyond_list > 0 {
            writeln!(
                out,
                "{beyond_list} of the model above the list's highest frequency, which a list may leave out (--whole demands them)"
            )?;
        }
        Ok(())
    }
}

/// Reads somebody's modes; the first fault of the table is reported with its line and column.
fn read_modes(path: &Path) -> Result<Vec<ListedMode>> {
    let bad = |reason: String| CommandError::Table { path: path.to_owned(), reason };
    let text = scene::read_text(path, MOST_BYTES).map_err(unread(path))?;
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| bad(e.to_string()))?.clone();
    let column = |name: &str| header.iter().position(|h| h.eq_ignore_ascii_case(name));
    let known = ["frequency_hz", "mode_type", "multiplicity"];
    // pandas writes its index as a first column without a name.
    let is_index = |(i, h): (usize, &str)| i == 0 && (h.is_empty() || h == "Unnamed: 0");
    let named = header.iter().enumerate().filter(|column| !is_index(*column));
    let is_known = |h: &str| known.iter().any(|name| name.eq_ignore_ascii_case(h));
    if let Some(strange) = named.map(|(_, h)| h).find(|h| !is_known(h)) {
        let allowed = known.join(", ");
        return Err(bad(format!("column `{strange}` is not known: allowed: {allowed}")));
    }
    let frequency = column("frequency_hz")
        .ok_or_else(|| bad("column `frequency_hz` is absent: it must be there".into()))?;
    let (mode_type, multiplicity) = (column("mode_type"), column("multiplicity"));
    let mut modes = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| bad(e.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |i: usize| record.get(i).unwrap_or("");
        let refuse = |name: &str, i: usize, allowed: &str| {
            bad(format!("line {line}, `{name}` is `{}`: allowed: {allowed}", cell(i)))
        };
        let frequency_hz = cell(frequency)
            .parse::<f64>()
            .ok()
            .filter(|f| f.is_finite() && *f >= 0.0)
            .ok_or_else(|| refuse("frequency_hz", frequency, "a finite number, 0 or above"))?;
        let mode_type = match mode_type {
            Some(i) => match TYPES.into_iter().find(|name| name.eq_ignore_ascii_case(cell(i))) {
                Some(name) => Some(name.to_owned()),
                None => return Err(refuse("mode_type", i, &TYPES.join(", "))),
            },
            None => None,
        };
        let multiplicity = match multiplicity {
            Some(i) if cell(i).is_empty() => None,
            Some(i) => {
                let count = cell(i).parse().ok().filter(|m| (1..=1000).contains(m));
                let allowed = "a whole number from 1 to 1000, or nothing";
                Some(count.ok_or_else(|| refuse("multiplicity", i, allowed))?)
            }
            None => None,
        };
        modes.push(ListedMode { frequency_hz, mode_type, multiplicity });
    }
    if modes.is_empty() {
        return Err(bad("no rows: at least one frequency is needed".into()));
    }
    if modes.len() > 10_000 {
        return Err(bad("more than 10000 rows: that is no list of natural frequencies".into()));
    }
    Ok(modes)
}
