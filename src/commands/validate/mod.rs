//! `validate`.

mod charts;
mod check_cells;
mod controls;
mod progress;
mod report;
mod result;
mod summary;

pub(crate) use controls::ControlsOutput;

use std::io::Write;
use std::path::Path;

use experiments::models::Recorded;
use validation::{Models, Reference, ValidationError, Verdict, judge_model, validate_with};

use crate::arguments::{Format, Validate};
use crate::error::{Result, refused};
use crate::folder;
use crate::output;
use progress::SuiteProgress;
use result::VerdictOutput;

pub(crate) fn run(
    arguments: &Validate,
    out: &mut dyn Write,
    err: &mut (dyn Write + Send),
) -> Result<bool> {
    if arguments.details && arguments.format != Format::Text {
        let reason = "JSON and CSV list every check anyway: leave it out, or take --format text";
        return Err(refused("--details", reason));
    }
    if arguments.controls {
        return controls::run(arguments, out).map(|()| true);
    }
    folder::folder("--report", arguments.report.as_deref())?;
    let verdict = match &arguments.recorded {
        Some(folder) => recorded(folder, &arguments.only)?,
        None => {
            let shown = SuiteProgress::new(err);
            let verdict =
                validate_with(arguments.profile, &arguments.only, &|progress| shown.tell(progress));
            shown.finish();
            verdict?
        }
    };
    if verdict.checks.is_empty() {
        if let Some(folder) = &arguments.recorded {
            let reason = format!(
                "{}: no suite of `{}` finds the scenes it asks about in these tables; `scene` is the title of a scene file",
                folder.display(),
                arguments.only
            );
            return Err(refused("--recorded", reason));
        }
        let reason = format!("`{}`: no check's id starts so", arguments.only);
        return Err(refused("--only", reason));
    }
    // What was computed is shown also where its report cannot be saved.
    let saved = match &arguments.report {
        // A part of the verdict, or that on another model, has a report of its own only.
        Some(folder) => report::write(&verdict, folder).and_then(|()| {
            match arguments.only.is_empty() && arguments.recorded.is_none() {
                true => charts::write(folder),
                false => Ok(()),
            }
        }),
        None => Ok(()),
    };
    let reference = Reference::load().map_err(ValidationError::from)?;
    let result = VerdictOutput { verdict, misses: reference.misses, details: arguments.details };
    output::show(arguments.format, &result, out)?;
    if let (Some(folder), Ok(()), Format::Text) = (&arguments.report, &saved, arguments.format) {
        writeln!(out, "report in {}", folder.display())?;
    }
    saved.map(|()| result.verdict.is_sound())
}

/// Judges the tables in a folder by every suite whose scenes they contain.
fn recorded(folder: &Path, only: &str) -> Result<Verdict> {
    let tables = Recorded::read(folder).map_err(|e| refused("--recorded", e))?;
    let models = Models {
        modal: (!tables.modes.is_empty()).then_some(&tables),
        at_rest: (!tables.mesh_cycles.is_empty()).then_some(&tables),
        in_time: (!tables.steady_states.is_empty()).then_some(&tables),
    };
    judge_model(&models, only).map_err(|e| refused("--recorded", e))
}
