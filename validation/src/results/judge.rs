//! The judgement of a results folder.

use std::sync::Arc;

use experiments::BodiesCache;
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
use crate::suites::{Models, explain_untyped, lumped_model, pair_stiffness, rules};
use crate::verdict::{NotAsked, Verdict};

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
            stiffness: Some(&tables),
            peaks: Some(&tables),
        };
        let beside = |reference: &Reference, not_asked: &mut Vec<NotAsked>| {
            self.beside(kind, reference, not_asked)
        };
        Ok(crate::judge_with(&models, &how.only, &how.accepted, &beside)?)
    }

    /// What is judged of any scene: frequencies beside this project's lumped model, excitation rules by phasor sums,
    /// mesh stiffness beside its finite-element/contact pair. What could not be asked, and why, is added to `not_asked`.
    pub(super) fn beside(
        &self,
        kind: ModelKind,
        reference: &Reference,
        not_asked: &mut Vec<NotAsked>,
    ) -> Result<Vec<Check>, ValidationError> {
        let is_torsional = kind == ModelKind::Torsional;
        explain_untyped(not_asked, &self.untyped());
        let mut checks = Vec::new();
        let mut lacks = |suite: &str, lacks: String| {
            not_asked.push(NotAsked { suite: suite.to_owned(), lacks });
        };
        let with_modes = scenes(self.modes.iter().map(|row| &row.scene));
        if with_modes.is_empty() {
            lacks("lumped_model", "modes.csv of any scene with numbers in [lumped]".to_owned());
        }
        for KnownScene { id, scene } in with_modes {
            if scene.lumped.is_none() {
                lacks("lumped_model", format!("numbers in [lumped] of the scene {id}"));
                continue;
            }
            let rows = self.modes.iter().filter(|row| row.scene.id == *id);
            let mut listed: Vec<ListedMode> = rows.map(ModeRow::listed).collect();
            if is_torsional {
                listed.iter_mut().for_each(|mode| mode.mode_type = None);
            }
            checks.extend(lumped_model::beside(id, scene, &listed, is_torsional, reference)?);
        }
        let with_rules = scenes(self.rules.iter().map(|row| &row.scene));
        if with_rules.is_empty() {
            lacks("rules", "rules.csv of any scene with numbers of teeth".to_owned());
        }
        for KnownScene { id, scene } in with_rules {
            let rows = self.rules.iter().filter(|row| row.scene.id == *id);
            let listed: Vec<(usize, AllowedKinds)> =
                rows.map(|row| (row.harmonic, row.excites)).collect();
            let found = rules::beside(id, scene, &listed, is_torsional, reference)?;
            if found.is_empty() {
                lacks("rules", format!("numbers of teeth in the scene {id}"));
            }
            checks.extend(found);
        }
        let with_stiffness = scenes(self.mesh_stiffness.iter().map(|row| &row.scene));
        if with_stiffness.is_empty() {
            let needs = "mesh_stiffness.csv of any scene with tooth geometry";
            lacks("pair_stiffness", needs.to_owned());
        }
        let (tables, gears) = (self.recorded(), BodiesCache::default());
        for KnownScene { id, scene } in with_stiffness {
            let cycles = tables.mesh_stiffness.iter().filter(|(title, _)| *title == scene.title);
            let cycles: Vec<_> = cycles.map(|(_, cycle)| cycle).collect();
            match pair_stiffness::beside(id, scene, &cycles, &gears, reference) {
                Ok(found) if !found.is_empty() => checks.extend(found),
                Ok(_) if cycles.is_empty() => {
                    lacks("pair_stiffness", format!("sun_mesh_0 or ring_mesh_0 of the scene {id}"));
                }
                Ok(_) => lacks("pair_stiffness", format!("tooth geometry of the scene {id}")),
                // A load that the teeth cannot carry is no fault of the program.
                Err(ValidationError::Fe(error)) => {
                    let needs = "a load at which the pair of this project has contact";
                    lacks("pair_stiffness", format!("{needs} in the scene {id}: {error}"));
                }
                Err(error) => return Err(error),
            }
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
