//! The judgement of a results folder.

use std::sync::Arc;

use experiments::BodiesCache;
use experiments::models::Recorded;
use gearset::AllowedKinds;

use crate::check::Check;
use crate::compare::ListedMode;
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::reference::Reference;
use crate::results::contradictions::Contradiction;
use crate::results::folder::{ResultsFolder, TABLES};
use crate::results::known_scenes::KnownScene;
use crate::results::manifest::{Accepted, Convention};
use crate::results::matrices::{MatrixKind, SceneMatrices};
use crate::results::rows::ModeRow;
use crate::selection::Selection;
use crate::suites::lumped_model::{self, Beside, Difference, ListedShape};
use crate::suites::{Models, asked_tables, explain_untyped, pair_stiffness, rules};
use crate::verdict::{NotAsked, Verdict};

use super::recorded::untyped;

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
            stiffness: Some(&tables),
            peaks: Some(&tables),
        };
        let beside = |reference: &Reference, not_asked: &mut Vec<NotAsked>| {
            self.beside(kind, &modes, &tables, reference, not_asked)
        };
        let mut verdict = crate::judge_with(&models, &how.only, &how.accepted, true, &beside)?;
        // What a table that is there lacks comes before what lacks its table.
        let is_there = |lack: &NotAsked| {
            self.tables().any(|table| {
                lack.lacks.strip_prefix(table).is_some_and(|rest| rest.starts_with(' '))
            })
        };
        verdict.not_asked.sort_by_key(|lack| !is_there(lack));
        Ok(verdict)
    }

    /// Tables that are there and of which no check was asked, with the suites that need more of them.
    pub fn unused(&self, verdict: &Verdict) -> Vec<String> {
        let asked = asked_tables(&verdict.checks);
        let about = |table: &str| {
            let of_table = |lack: &&NotAsked| lack.lacks.starts_with(table);
            let lacks = verdict.not_asked.iter().filter(of_table);
            let needs: Vec<String> =
                lacks.map(|lack| format!("{} needs {}", lack.suite, lack.lacks)).collect();
            format!("{table}: no check uses it; {}", needs.join("; "))
        };
        self.tables().filter(|table| !asked.contains(table)).map(about).collect()
    }

    /// Names of the tables that were read.
    fn tables(&self) -> impl Iterator<Item = &'static str> {
        TABLES.into_iter().filter(|table| self.files.iter().any(|file| file.ends_with(table)))
    }

    /// What is judged of any scene: modes and matrices beside this project's lumped model, excitation rules by phasor
    /// sums, mesh stiffness beside its finite-element/contact pair. What cannot be asked, and why, is added to
    /// `not_asked`.
    pub(in crate::results) fn beside(
        &self,
        kind: ModelKind,
        modes: &[ModeRow],
        tables: &Recorded,
        reference: &Reference,
        not_asked: &mut Vec<NotAsked>,
    ) -> Result<Vec<Check>, ValidationError> {
        let is_torsional = kind == ModelKind::Torsional;
        explain_untyped(not_asked, &untyped(modes));
        let mut lacks = |suite: &str, lacks: String| {
            not_asked.push(NotAsked { suite: suite.to_owned(), lacks });
        };
        let mut checks = Vec::new();
        for set in &self.matrices {
            checks.extend(self.matrices_beside(set, kind, reference)?);
        }
        let with_modes = scenes(modes.iter().map(|row| &row.scene));
        if with_modes.is_empty() && self.matrices.is_empty() {
            let needs = "modes.csv of any scene with numbers in [lumped], or M and K";
            lacks("lumped_model", needs.to_owned());
        }
        for KnownScene { id, scene } in with_modes {
            if scene.lumped.is_none() {
                lacks("lumped_model", format!("numbers in [lumped] of the scene {id}"));
                continue;
            }
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
        let gears = BodiesCache::default();
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
