//! The judgement of a results folder.

use std::sync::Arc;

use gearset::AllowedKinds;

use super::contradictions::Contradiction;
use super::folder::ResultsFolder;
use super::known_scenes::KnownScene;
use super::manifest::Accepted;
use super::rows::ModeRow;
use crate::check::Check;
use crate::compare::ListedMode;
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::reference::Reference;
use crate::selection::Selection;
use crate::suites::{Models, lumped_model, rules};
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
    /// What the author of the results accepts.
    pub accepted: Accepted,
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
        let contradictions = self.contradictions(how.kind);
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
        let beside = |reference: &Reference| self.beside(kind, reference);
        Ok(crate::judge_with(&models, &how.only, &how.accepted, &beside)?)
    }

    /// What is judged of any scene: frequencies beside this project's lumped model, excitation rules by phasor sums.
    pub(super) fn beside(
        &self,
        kind: ModelKind,
        reference: &Reference,
    ) -> Result<Vec<Check>, ValidationError> {
        let is_torsional = kind == ModelKind::Torsional;
        let mut checks = Vec::new();
        let with_modes = scenes(self.modes.iter().map(|row| &row.scene));
        for KnownScene { id, scene } in with_modes.into_iter().filter(|k| k.scene.lumped.is_some())
        {
            let rows = self.modes.iter().filter(|row| row.scene.id == *id);
            let mut listed: Vec<ListedMode> = rows.map(ModeRow::listed).collect();
            if is_torsional {
                listed.iter_mut().for_each(|mode| mode.mode_type = None);
            }
            checks.extend(lumped_model::beside(id, scene, &listed, is_torsional, reference)?);
        }
        for KnownScene { id, scene } in scenes(self.rules.iter().map(|row| &row.scene)) {
            let rows = self.rules.iter().filter(|row| row.scene.id == *id);
            let listed: Vec<(usize, AllowedKinds)> =
                rows.map(|row| (row.harmonic, row.excites)).collect();
            checks.extend(rules::beside(id, scene, &listed, is_torsional, reference)?);
        }
        Ok(checks)
    }
}

/// The scenes of rows, each once, by id.
fn scenes<'r>(rows: impl Iterator<Item = &'r Arc<KnownScene>>) -> Vec<&'r KnownScene> {
    let mut scenes: Vec<&KnownScene> = rows.map(|known| &**known).collect();
    scenes.sort_by_key(|known| &known.id);
    scenes.dedup_by_key(|known| &known.id);
    scenes
}
