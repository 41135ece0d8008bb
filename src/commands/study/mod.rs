//! `study FILE`: quantities of interest, their truth, settings by error and cost.

mod text;

pub(super) use text::{sentence, write_text};

use std::io::Write;

use experiments::study::{StudyError, StudyFile, StudyResult, run_study};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::Study;
use crate::error::{CommandError, Result};
use crate::folder::ResultFiles;
use crate::inputs::Working;
use crate::output::{self, Report};

/// `study FILE --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct StudyOutput {
    /// Version of the program.
    version: String,
    #[serde(flatten)]
    study: StudyResult,
}

pub(super) fn run(
    arguments: &Study,
    out: &mut dyn Write,
    err: &mut (dyn Write + Send),
) -> Result<()> {
    let refused = |error: StudyError| CommandError::Study { path: arguments.file.clone(), error };
    let mut study = StudyFile::read(&arguments.file).map_err(refused)?;
    if let Some(rounds) = arguments.rounds {
        study = study.with_rounds(rounds as usize).map_err(refused)?;
    }
    let name = arguments.file.file_stem().unwrap_or_default().to_string_lossy();
    let files = ResultFiles::new(arguments.out.as_deref(), &name)?;
    let working = Working::new("study");
    let result = run_study(&study, &|words| working.now(words.to_owned())).map_err(refused)?;
    drop(working);
    warn(&result, err)?;
    let result = StudyOutput { version: env!("CARGO_PKG_VERSION").into(), study: result };
    let saved = files.save(&result);
    #[cfg(feature = "charts")]
    let saved = saved.and_then(|()| files.draw(|| crate::figures::of_study(&result.study, &name)));
    // What was computed is shown also where it cannot be saved.
    let shown = output::show(arguments.format, &result, out);
    saved.and(shown)
}

impl Report for StudyOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        text::table().csv(text::rows(&self.study), out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        write_text(&self.study, out)
    }
}

/// Ratio of the yardstick's times, of the last third to the first or of the upper quartile to the lower, beyond which
/// costs are warned of. Ratios are taken to the yardstick just before and after, which a slow drift leaves as they are;
/// a machine as restless as this may have changed in between.
const RESTLESS: f64 = 1.2;

fn warn(study: &StudyResult, err: &mut dyn Write) -> Result<()> {
    let (drift, q) = (study.time.yardstick_drift, &study.time.yardstick_s);
    let scatter = q.high / q.low;
    if scatter > RESTLESS || !(1.0 / RESTLESS..=RESTLESS).contains(&drift) {
        writeln!(
            err,
            "warning: the yardstick took {drift:.2} times as long at the end as at the beginning, and its upper quartile \
             is {scatter:.2} times the lower: other programs may have run beside the study; errors do not depend on it, \
             costs may be off by as much"
        )?;
    }
    Ok(())
}
