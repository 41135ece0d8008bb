//! `compare MODES.csv --scene SCENE`.

use std::io::Write;

use lumped::NamedModes;
use scene::Verb;
use serde::Serialize;
use validation::results::{JudgeError, ModeList};
use validation::{Comparison, LikelyUnit, Match, ModelMode, compare};

use super::modes::{self, PARAMETERS};
use crate::arguments::Compare;
use crate::error::{Result, unfit};
use crate::inputs::{needs, read_scene};
use crate::output::{self, Notation, Report, Table, paragraph};

pub(crate) fn run(arguments: &Compare, out: &mut dyn Write, err: &mut dyn Write) -> Result<bool> {
    let scene = read_scene(&arguments.scene, err)?;
    match scene.has_closed_forms() {
        true => needs::require(&arguments.scene, &scene, Verb::Compare, |_| false)?,
        false => {
            let of_kind = scene.lacks(Verb::Compare).into_iter().find(|lack| lack.key == "kind");
            if let Some(lack) = of_kind {
                return Err(unfit(&arguments.scene, format!("`{}`: {}", lack.key, lack.why)));
            }
        }
    }
    let (parameters, found) =
        modes::solve(&scene).map_err(|reason| unfit(&arguments.scene, reason))?;
    let model: Vec<ModelMode> = found
        .named(&parameters)
        .into_iter()
        .map(|NamedModes { name, group, .. }| ModelMode {
            frequency_hz: group.frequency_hz,
            mode_type: name.to_owned(),
            multiplicity: group.multiplicity,
        })
        .collect();
    let id = arguments.scene.file_stem().unwrap_or_default().to_string_lossy();
    let list = ModeList::read(&arguments.modes, &id, &scene)?;
    if !list.contradictions.is_empty() {
        return Err(JudgeError::Contradictions(list.contradictions).into());
    }
    let result = compare(&list.modes, &model, arguments.tolerance_percent, arguments.whole);
    let against = match scene.has_closed_forms() {
        true => format!("against the lumped model, {PARAMETERS}, of: {}", scene.title),
        false => format!("against the lumped model of: {}", scene.title),
    };
    let remarks = list.remarks.iter().map(ToString::to_string).collect();
    let result = CompareOutput { result, against, remarks };
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
    /// What was read in another way than it is written.
    #[serde(skip)]
    remarks: Vec<String>,
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
        for remark in &self.remarks {
            writeln!(out, "{}", paragraph(remark, "  ", "  "))?;
        }
        let Comparison { matches, agreed, disagreed, beyond_list, likely_unit, .. } = &self.result;
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
        if let Some(LikelyUnit { unit, column, agreed, lines }) = likely_unit {
            writeln!(
                out,
                "the list likely is in {unit}: {agreed} of {lines} would agree with its column called `{column}`"
            )?;
        }
        Ok(())
    }
}
