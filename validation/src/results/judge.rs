//! The judgement of a results folder.

use super::contradictions::Contradiction;
use super::folder::ResultsFolder;
use super::known_scenes::KnownScene;
use super::rows::ModeRow;
use crate::check::Check;
use crate::compare::ListedMode;
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::reference::{Miss, Reference};
use crate::selection::Selection;
use crate::suites::{Models, lumped_model};
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
        let kind = self.kind(how.kind);
        let models = Models {
            kind: Some(kind),
            // Empty tables answer nothing: suites are then listed with what they lack.
            modal: Some(&tables),
            at_rest: Some(&tables),
            in_time: Some(&tables),
        };
        let beside = |reference: &Reference| self.beside_lumped_model(kind, reference);
        Ok(crate::judge_with(&models, &how.only, &how.accepted, &beside)?)
    }

    /// Frequencies of lumped and torsional models beside this project's, of every scene that has lumped parameters.
    fn beside_lumped_model(
        &self,
        kind: ModelKind,
        reference: &Reference,
    ) -> Result<Vec<Check>, ValidationError> {
        let mut checks = Vec::new();
        if !matches!(kind, ModelKind::Lumped | ModelKind::Torsional) {
            return Ok(checks);
        }
        let is_torsional = kind == ModelKind::Torsional;
        let mut scenes: Vec<&KnownScene> = self.modes.iter().map(|row| &*row.scene).collect();
        scenes.sort_by_key(|known| &known.id);
        scenes.dedup_by_key(|known| &known.id);
        for KnownScene { id, scene } in scenes {
            if scene.lumped.is_none() {
                continue;
            }
            let rows = self.modes.iter().filter(|row| row.scene.id == *id);
            let mut listed: Vec<ListedMode> = rows.map(ModeRow::listed).collect();
            if is_torsional {
                listed.iter_mut().for_each(|mode| mode.mode_type = None);
            }
            checks.extend(lumped_model::beside(id, scene, &listed, is_torsional, reference)?);
        }
        Ok(checks)
    }
}
