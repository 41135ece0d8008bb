//! `validate --recorded DIR`: results of any program, judged by the references of their kind.

mod escape;
mod file_hash;
mod html;
mod judged_scene;
mod junit;
mod markdown;
mod meaning;
mod report;
mod row;
mod suite;
mod text;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use validation::certified::{Score, digits_of, given_rows, scores};
use validation::results::{Accepted, Judgement, ResultsFolder};
use validation::{Check, Miss, ModelKind, Selection, Verdict};

use crate::arguments::{Format, Validate};
use crate::error::{Result, refused};
use crate::output;
use file_hash::FileHash;
use judged_scene::JudgedScene;

/// `validate --recorded --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct RecordedOutput {
    /// What was judged.
    about: About,
    #[serde(flatten)]
    verdict: Verdict,
    /// Correct digits of judged numbers, by the id of the check.
    digits: BTreeMap<String, f64>,
    /// How values agree with the data set of certified values, by scene and quantity.
    scores: Vec<Score>,
    /// Rows that the author knows to miss.
    #[serde(skip)]
    accepted: Vec<Miss>,
    /// Whether text lists every check.
    #[serde(skip)]
    details: bool,
}

/// Where results come from and how they were read.
#[derive(Debug, Serialize, JsonSchema)]
struct About {
    folder: String,
    /// Kind of model whose references judge.
    kind: ModelKind,
    #[serde(skip_serializing_if = "Option::is_none")]
    program: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    version: Option<String>,
    /// Version of epicyclic that judged.
    epicyclic: &'static str,
    /// Fronts of the ids of the checks that were asked for; every check without any.
    only: Vec<String>,
    /// Files that were read.
    files: Vec<FileHash>,
    /// What was read in another way than it is written, a sentence each.
    remarks: Vec<String>,
    /// Scenes that tables are about, by id.
    scenes: Vec<JudgedScene>,
}

pub(super) fn run(arguments: &Validate, folder: &Path, out: &mut dyn Write) -> Result<bool> {
    let read = ResultsFolder::read(folder)?;
    let how = Judgement {
        kind: arguments.kind,
        only: Selection::from(arguments.only.as_slice()),
        accepted: match &arguments.accept {
            Some(path) => Accepted::read(path).map_err(|e| refused("--accept", e))?,
            None => Accepted::default(),
        },
    };
    let verdict = read.judge(&how)?;
    let files = read.files.iter().chain(&arguments.accept).map(|path| FileHash::read(path, folder));
    let files = files.collect::<Result<_, _>>()?;
    let mut remarks: Vec<String> = read.remarks.iter().map(ToString::to_string).collect();
    if arguments.kind.is_none() && read.manifest.kind.is_none() {
        let kinds = ModelKind::ALL.map(ModelKind::name).join(", ");
        remarks.push(format!(
            "no results.toml says what kind of model it is: taken as lumped (--as: {kinds})"
        ));
    }
    remarks.extend(how.accepted.without_effect(&verdict.checks));
    if how.only.is_everything() {
        remarks.extend(read.unused(&verdict));
    }
    let is_typed = read.modes.iter().any(|row| row.mode_type.is_some());
    if is_typed && read.kind(arguments.kind) == ModelKind::Torsional {
        remarks.push("types of modes are not asked of a model of rotations alone".to_owned());
    }
    let scenes = JudgedScene::of_folder(&read);
    let scores = scores(given_rows(&read, read.kind(arguments.kind)));
    let about = About {
        folder: folder.display().to_string(),
        kind: read.kind(arguments.kind),
        program: read.manifest.program,
        version: read.manifest.version,
        epicyclic: env!("CARGO_PKG_VERSION"),
        only: arguments.only.iter().filter(|front| !front.is_empty()).cloned().collect(),
        files,
        remarks,
        scenes,
    };
    let of_check = |check: &Check| Some((check.id.clone(), digits_of(check, about.kind)?));
    let digits = verdict.checks.iter().filter_map(of_check).collect();
    let result = RecordedOutput {
        digits,
        scores,
        about,
        verdict,
        accepted: how.accepted.misses,
        details: arguments.details,
    };
    // What was judged is shown also where its report cannot be saved.
    let saved = arguments.report.as_ref().map_or(Ok(()), |folder| report::write(&result, folder));
    let appended = report::append_to_step_summary(&result);
    output::show(arguments.format, &result, out)?;
    if arguments.format == Format::Text {
        if let (Some(folder), Ok(())) = (&arguments.report, &saved) {
            writeln!(out, "report in {}", folder.display())?;
        }
        if let Ok(Some(path)) = &appended {
            writeln!(out, "step summary appended to {}", path.display())?;
        }
    }
    saved.and(appended.map(drop))?;
    Ok(result.verdict.is_sound())
}
