//! `results check`: what a results folder holds and what it can be asked.

use std::io::Write;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use validation::results::{AskedSuite, Questions, ResultsFolder};
use validation::{ModelKind, NotAsked};

use super::contents::Contents;
use crate::arguments::Format;
use crate::error::CommandError;
use crate::output;

/// `results check --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ResultsSummary {
    pub(super) folder: String,
    /// Kind of model whose references judge.
    pub(super) kind: ModelKind,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) program: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) version: Option<String>,
    pub(super) tables: Vec<Contents>,
    /// What was read in another way than it is written, a sentence each.
    pub(super) remarks: Vec<String>,
    /// What cannot be true, with file and lines; no suite judges results that have any.
    pub(super) contradictions: Vec<String>,
    /// Suites that the tables answer; none if there are contradictions.
    pub(super) asked: Vec<AskedSuite>,
    /// Suites that the tables do not answer, and what they need.
    pub(super) not_asked: Vec<NotAsked>,
}

/// Shows what is there; exit code 2, as of `validate --recorded`, if nothing can be judged.
pub(super) fn run(
    folder: &Path,
    kind: Option<ModelKind>,
    format: Format,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let read = ResultsFolder::read(folder)?;
    let contradictions = read.contradictions(kind);
    let Questions { asked, not_asked } = match contradictions.is_empty() {
        true => read.questions(kind)?,
        false => Questions::default(),
    };
    let summary = ResultsSummary {
        folder: folder.display().to_string(),
        kind: read.kind(kind),
        tables: Contents::of_folder(&read),
        remarks: read.remarks.iter().map(ToString::to_string).collect(),
        contradictions: contradictions.iter().map(ToString::to_string).collect(),
        program: read.manifest.program,
        version: read.manifest.version,
        asked,
        not_asked,
    };
    output::show(format, &summary, out)?;
    let reason = match (summary.contradictions.len(), summary.asked.len()) {
        (0, 0) => "no suite can be asked of these results".to_owned(),
        (0, _) => return Ok(()),
        (1, _) => "one contradiction: no suite judges these results".to_owned(),
        (count, _) => format!("{count} contradictions: no suite judges these results"),
    };
    Err(CommandError::Results { path: folder.to_owned(), reason })
}
