//! `validate`.

mod charts;
mod check_cells;
mod controls;
mod progress;
mod recorded;
mod report;
mod result;
mod summary;

pub(crate) use controls::ControlsOutput;
pub(crate) use recorded::RecordedOutput;

use std::io::Write;

use validation::{Reference, Selection, ValidationError, validate_with};

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
    if let Some(results) = &arguments.recorded {
        return recorded::run(arguments, results, out);
    }
    let only = Selection::from(arguments.only.as_slice());
    let shown = SuiteProgress::new(err);
    let verdict = validate_with(arguments.profile, &only, &|progress| shown.tell(progress));
    shown.finish();
    let verdict = verdict.map_err(|e| match e {
        ValidationError::NoSuchCheck { .. } => refused("--only", e.to_string()),
        e => e.into(),
    })?;
    // What was computed is shown also where its report cannot be saved.
    let saved = match &arguments.report {
        // A part of the verdict has a report of its own only.
        Some(folder) => report::write(&verdict, folder).and_then(|()| match only.is_everything() {
            true => charts::write(folder),
            false => Ok(()),
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
