//! `validate --recorded DIR`: results of any program, judged by the references of their kind.

mod text;

use std::io::Write;
use std::path::Path;

use serde::Serialize;
use validation::results::{Judgement, ResultsFolder, accepted_misses};
use validation::{ModelKind, Selection, Verdict};

use crate::arguments::Validate;
use crate::error::{Result, refused};
use crate::output;

/// `validate --recorded --format json`.
#[derive(Debug, Serialize)]
pub(super) struct RecordedOutput {
    /// What was judged.
    about: About,
    #[serde(flatten)]
    verdict: Verdict,
    /// Whether text lists every check.
    #[serde(skip)]
    details: bool,
}

/// Where results come from and how they were read.
#[derive(Debug, Serialize)]
struct About {
    folder: String,
    /// Kind of model whose references judge.
    kind: ModelKind,
    #[serde(skip_serializing_if = "Option::is_none")]
    program: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    version: Option<String>,
    /// What was read in another way than it is written, a sentence each.
    remarks: Vec<String>,
}

pub(super) fn run(arguments: &Validate, folder: &Path, out: &mut dyn Write) -> Result<bool> {
    let read = ResultsFolder::read(folder)?;
    let how = Judgement {
        kind: arguments.kind,
        only: Selection::from(arguments.only.as_slice()),
        accepted: match &arguments.accept {
            Some(path) => accepted_misses(path).map_err(|e| refused("--accept", e))?,
            None => Vec::new(),
        },
    };
    let verdict = read.judge(&how)?;
    let mut remarks: Vec<String> = read.remarks.iter().map(ToString::to_string).collect();
    if arguments.kind.is_none() && read.manifest.kind.is_none() {
        let kinds = ModelKind::ALL.map(ModelKind::name).join(", ");
        remarks.push(format!(
            "no results.toml says what kind of model it is: taken as lumped (--as: {kinds})"
        ));
    }
    let about = About {
        folder: folder.display().to_string(),
        kind: read.kind(arguments.kind),
        program: read.manifest.program,
        version: read.manifest.version,
        remarks,
    };
    let result = RecordedOutput { about, verdict, details: arguments.details };
    output::show(arguments.format, &result, out)?;
    Ok(result.verdict.is_sound())
}
