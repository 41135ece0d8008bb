//! The judgement of a results folder.

use super::contradictions::Contradiction;
use super::folder::ResultsFolder;
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::reference::Miss;
use crate::selection::Selection;
use crate::suites::Models;
use crate::verdict::Verdict;

/// Why results cannot be judged.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// Tables that contradict themselves, on which no suite may pass.
    #[error("{}", lines(.0))]
    Contradictions(Vec<Contradiction>),
    /// No check could be asked, or the program is at fault.
    #[error(transparent)]
    Validation(#[from] ValidationError),
}

fn lines(found: &[Contradiction]) -> String {
    found.iter().map(Contradiction::to_string).collect::<Vec<_>>().join("\n")
}

/// What is judged, and how.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// Kind of model instead of that in `results.toml`.
    pub kind: Option<ModelKind>,
    /// Checks that are asked.
    pub only: Selection,
    /// Rows that the author knows to miss, each pinned and analysed.
    pub accepted: Vec<Miss>,
}

impl ResultsFolder {
    /// Kind of the results: `given`, or that of `results.toml`, or lumped.
    pub fn kind(&self, given: Option<ModelKind>) -> ModelKind {
        given.or(self.manifest.kind).unwrap_or(ModelKind::Lumped)
    }

    /// Judges the tables by every suite that they can answer.
    ///
    /// # Errors
    /// [`JudgeError::Contradictions`] before any check is asked if tables contradict themselves; otherwise as
    /// [`crate::judge_model`].
    pub fn judge(&self, how: &Judgement) -> Result<Verdict, JudgeError> {
        let contradictions = self.contradictions();
        if !contradictions.is_empty() {
            return Err(JudgeError::Contradictions(contradictions));
        }
        let tables = self.recorded();
        let models = Models {
            kind: Some(self.kind(how.kind)),
            // Empty tables answer nothing: suites are then listed with what they lack.
            modal: Some(&tables),
            at_rest: Some(&tables),
            in_time: Some(&tables),
        };
        Ok(crate::judge_with(&models, &how.only, &how.accepted)?)
    }
}
