//! `validate`.

use std::io::Write;

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use validation::{
    Asks, Models, Reference, Registry, ValidationError, Verdict, judge_model, validate_with,
};

use experiments::models::Recorded;

use crate::arguments::{Format, Validate};
use crate::error::CommandError;
use crate::output;

use super::suite_progress::SuiteProgress;
use super::{report, report_charts, verdict_table, verdict_text};

pub(crate) fn run(
    arguments: &Validate,
    out: &mut dyn Write,
    err: &mut (dyn Write + Send),
) -> Result<bool, CommandError> {
    if arguments.details && matches!(arguments.format, Format::Json) {
        let reason = "JSON lists every check anyway: leave it out, or take --format text".into();
        return Err(CommandError::Argument { argument: "--details", reason });
    }
    if arguments.controls {
        return suites(arguments, out).map(|()| true);
    }
    super::folder("--report", arguments.report.as_deref())?;
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
            return Err(CommandError::Argument { argument: "--recorded", reason });
        }
        let reason = format!("`{}`: no check's id starts so", arguments.only);
        return Err(CommandError::Argument { argument: "--only", reason });
    }
    // What was computed is shown also where its report cannot be saved.
    let saved = match &arguments.report {
        // A part of the verdict, or that on another model, has a report of its own only.
        Some(folder) => report::write(&verdict, folder).and_then(|()| {
            match arguments.only.is_empty() && arguments.recorded.is_none() {
                true => report_charts::write(folder),
                false => Ok(()),
            }
        }),
        None => Ok(()),
    };
    match arguments.format {
        Format::Json => output::json(out, &verdict)?,
        Format::Text => {
            if arguments.details {
                verdict_table::write(&verdict, out)?;
            } else {
                let reference = Reference::load().map_err(ValidationError::from)?;
                verdict_text::write(&verdict, &reference.misses, out)?;
            }
            if let (Some(folder), Ok(())) = (&arguments.report, &saved) {
                writeln!(out, "report in {}", folder.display())?;
            }
        }
    }
    saved.map(|()| verdict.is_sound())
}

/// Judges the tables in a folder by every suite whose scenes they contain.
fn recorded(folder: &Path, only: &str) -> Result<Verdict, CommandError> {
    let refused = |reason: String| CommandError::Argument { argument: "--recorded", reason };
    let tables = Recorded::read(folder).map_err(|e| refused(e.to_string()))?;
    let models = Models {
        modal: (!tables.modes.is_empty()).then_some(&tables),
        at_rest: (!tables.mesh_cycles.is_empty()).then_some(&tables),
        in_time: (!tables.steady_states.is_empty()).then_some(&tables),
    };
    judge_model(&models, only).map_err(|e| refused(e.to_string()))
}

/// `validate --controls --format json`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ControlsOutput {
    suites: Vec<SuiteControls>,
}

/// One suite with its negative controls.
#[derive(Serialize, JsonSchema)]
struct SuiteControls {
    suite: String,
    asks: Asks,
    about: String,
    controls: Vec<ControlOutput>,
}

/// A negative control: what is spoilt, and the check that must fail.
#[derive(Serialize, JsonSchema)]
struct ControlOutput {
    id: String,
    spoils: String,
    breaks: String,
}

/// Lists the suites whose names begin with `--only`, with their negative controls.
fn suites(arguments: &Validate, out: &mut dyn Write) -> Result<(), CommandError> {
    let registry = Registry::load().map_err(ValidationError::from)?;
    let own = registry.suite.into_iter().filter(|s| s.name.starts_with(&arguments.only));
    let suites: Vec<SuiteControls> = own
        .map(|suite| SuiteControls {
            suite: suite.name,
            asks: suite.asks,
            about: suite.about,
            controls: suite
                .control
                .into_iter()
                .map(|c| ControlOutput { id: c.id, spoils: c.spoils, breaks: c.breaks })
                .collect(),
        })
        .collect();
    if let Format::Json = arguments.format {
        return output::json(out, &ControlsOutput { suites });
    }
    for suite in &suites {
        let asks = match suite.asks {
            Asks::NaturalModes => "natural modes of any model",
            Asks::MeshCycle => "mesh cycles at rest of any model",
            Asks::SteadyStates => "steady states of any model",
            Asks::OwnNumerics => "our own models",
        };
        writeln!(out, "{} ({asks}): {}", suite.suite, suite.about)?;
        for control in &suite.controls {
            writeln!(out, "  {}", control.id)?;
            writeln!(out, "    {}: {} must fail", control.spoils, control.breaks)?;
        }
    }
    Ok(())
}
