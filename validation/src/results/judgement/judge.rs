//! The judgement of a results folder.

use std::sync::Arc;

use gearset::AllowedKinds;

use crate::check::Check;
use crate::compare::ListedMode;
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::reference::Reference;
use crate::results::contradictions::Contradiction;
use crate::results::folder::ResultsFolder;
use crate::results::known_scenes::KnownScene;
use crate::results::manifest::{Accepted, Convention};
use crate::results::matrices::{MatrixKind, SceneMatrices};
use crate::results::rows::ModeRow;
use crate::selection::Selection;
use crate::suites::lumped_model::{self, Beside, Difference, ListedShape};
use crate::suites::{Models, rules};
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
        let kind = self.kind(how.kind);
        let modes = self.completed_modes(kind)?;
        let tables = self.recorded_with(&modes);
        let models = Models {
            kind: Some(kind),
            // Empty tables answer nothing: suites are then listed with what they lack.
            modal: Some(&tables),
            at_rest: Some(&tables),
            in_time: Some(&tables),
        };
        let beside = |reference: &Reference| self.beside(kind, &modes, reference);
        Ok(crate::judge_with(&models, &how.only, &how.accepted, &beside)?)
    }

    /// What is judged of any scene: modes and matrices beside this project's lumped model, excitation rules by phasor
    /// sums.
    pub(in crate::results) fn beside(
        &self,
        kind: ModelKind,
        modes: &[ModeRow],
        reference: &Reference,
    ) -> Result<Vec<Check>, ValidationError> {
        let is_torsional = kind == ModelKind::Torsional;
        let mut checks = Vec::new();
        for set in &self.matrices {
            checks.extend(self.matrices_beside(set, kind, reference)?);
        }
        let with_modes = scenes(modes.iter().map(|row| &row.scene));
        for KnownScene { id, scene } in with_modes.into_iter().filter(|k| k.scene.lumped.is_some())
        {
            let rows: Vec<&ModeRow> = modes.iter().filter(|row| row.scene.id == *id).collect();
            let found = self.reference_model(scene, kind)?;
            let (title, model) = (&scene.title, &found.model);
            let shape = |row: &&ModeRow| {
                let shape = found.shape(&self.manifest.convention, &row.vector).ok()?;
                Some(ListedShape { line: row.line, frequency_hz: row.frequency_hz, shape })
            };
            let shapes: Option<Vec<ListedShape>> = rows.iter().map(shape).collect();
            checks.extend(match shapes {
                Some(shapes) => {
                    lumped_model::with_shapes(id, title, model, &shapes, is_torsional, reference)?
                }
                None => {
                    let mut listed: Vec<ListedMode> = rows.iter().map(|row| row.listed()).collect();
                    if is_torsional {
                        listed.iter_mut().for_each(|mode| mode.mode_type = None);
                    }
                    lumped_model::beside(id, title, model, &listed, is_torsional, reference)?
                }
            });
        }
        for KnownScene { id, scene } in scenes(self.rules.iter().map(|row| &row.scene)) {
            let rows = self.rules.iter().filter(|row| row.scene.id == *id);
            let listed: Vec<(usize, AllowedKinds)> =
                rows.map(|row| (row.harmonic, row.excites)).collect();
            checks.extend(rules::beside(id, scene, &listed, is_torsional, reference)?);
        }
        Ok(checks)
    }

    /// Given matrices beside those of the lumped model.
    fn matrices_beside(
        &self,
        set: &SceneMatrices,
        kind: ModelKind,
        reference: &Reference,
    ) -> Result<Vec<Check>, ValidationError> {
        let KnownScene { id, scene } = &*set.scene;
        let found = self.reference_model(scene, kind)?;
        let convention = &self.manifest.convention;
        let mut checks = Vec::new();
        for (which, matrix) in set.each() {
            let Ok(given) = found.converted(id, convention, &matrix.values) else { continue };
            let (name, unit, model) = match which {
                MatrixKind::Mass => ("mass", "kg", found.model.mass_matrix()),
                MatrixKind::Stiffness => ("stiffness", "N/m", found.model.stiffness()),
            };
            let agreeing = |percent: f64| {
                let agrees = |other: &Convention| {
                    let converted = found.converted(id, other, &matrix.values);
                    converted.is_ok_and(|given| Difference::new(&given, &model).percent <= percent)
                };
                let other = convention.others().into_iter().find(agrees)?;
                let keys = other.differences(convention);
                Some(keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(" and "))
            };
            let coordinates = &found.model.coordinates;
            let beside = Beside { name, unit, coordinates, given: &given, model: &model };
            checks.push(beside.check(id, &scene.title, reference, agreeing)?);
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
