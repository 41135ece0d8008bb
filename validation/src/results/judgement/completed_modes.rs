//! The modes of a folder with what follows from vectors and matrices: types of modes that have a vector and no type,
//! and frequencies and types of scenes of which there are matrices and no rows in `modes.csv`.

use lumped::nalgebra::DMatrix;
use lumped::{LumpedModel, ModeGroup, ModeType, NaturalModes};

use crate::error::ValidationError;
use crate::mode_type::type_of;
use crate::model_kind::ModelKind;
use crate::results::folder::ResultsFolder;
use crate::results::matrices::{GivenMatrix, SceneMatrices};
use crate::results::model::{ReferenceModel, Spectrum};
use crate::results::rows::ModeRow;

/// Part of the diagonal up to which entries beside it are rounding.
const NIL: f64 = 1e-9;

impl ResultsFolder {
    /// Rows of `modes.csv` and what follows from vectors and matrices, of results without contradictions.
    pub(in crate::results) fn completed_modes(
        &self,
        kind: ModelKind,
    ) -> Result<Vec<ModeRow>, ValidationError> {
        let mut modes = self.modes.clone();
        let has_vector_alone =
            |row: &&mut ModeRow| row.mode_type.is_none() && !row.vector.is_empty();
        if kind != ModelKind::Torsional {
            let mut reference: Option<(String, ReferenceModel)> = None;
            for row in modes.iter_mut().filter(has_vector_alone) {
                let id = &row.scene.id;
                if reference.as_ref().is_none_or(|(known, _)| known != id) {
                    let Ok(found) = self.reference_model(&row.scene.scene, kind) else { continue };
                    reference = Some((id.clone(), found));
                }
                let Some((_, found)) = &reference else { continue };
                if let Ok(shape) = found.shape(&self.manifest.convention, &row.vector) {
                    let mode_type = type_of(&found.model.participation(&shape));
                    row.mode_type = Some(mode_type.name().to_owned());
                }
            }
        }
        for set in &self.matrices {
            if self.modes.iter().all(|row| row.scene.id != set.scene.id) {
                modes.extend(self.modes_of_matrices(set, kind)?);
            }
        }
        Ok(modes)
    }

    /// What results on a scene are held against.
    pub(in crate::results) fn reference_model(
        &self,
        scene: &scene::Scene,
        kind: ModelKind,
    ) -> Result<ReferenceModel, lumped::LumpedError> {
        ReferenceModel::new(scene, &self.manifest.held, kind)
    }

    fn modes_of_matrices(
        &self,
        set: &SceneMatrices,
        kind: ModelKind,
    ) -> Result<Vec<ModeRow>, ValidationError> {
        let Some((mass, stiffness)) = set.both() else { return Ok(Vec::new()) };
        let reference = self.reference_model(&set.scene.scene, kind)?;
        let convention = &self.manifest.convention;
        let converted = |matrix: &GivenMatrix| {
            reference.converted(&set.scene.id, convention, &matrix.values).ok()
        };
        let (Some(m), Some(k)) = (converted(mass), converted(stiffness)) else {
            return Ok(Vec::new());
        };
        let Ok(spectrum) = Spectrum::new(&m, &k, [mass.rounding, stiffness.rounding]) else {
            return Ok(Vec::new());
        };
        let row = |frequency_hz: f64, mode_type: Option<String>, multiplicity: usize| ModeRow {
            line: 0,
            scene: set.scene.clone(),
            frequency_hz,
            mode_type,
            multiplicity: Some(multiplicity),
            vector: Vec::new(),
        };
        let hz = |lambda: f64| match lambda > spectrum.nil() {
            true => lambda.sqrt() / std::f64::consts::TAU,
            false => 0.0,
        };
        // Types are those of a diagonal M, as rigid bodies have it in these coordinates.
        let diagonal = DMatrix::from_diagonal(&m.diagonal());
        let is_diagonal = (&m - &diagonal).amax() <= NIL * diagonal.amax();
        let untyped = || spectrum.lambda.iter().map(|lambda| row(hz(*lambda), None, 1)).collect();
        if kind == ModelKind::Torsional || !is_diagonal {
            return Ok(untyped());
        }
        // Few digits mix the types a little. Where the set itself mixes them, no allowance can be made for that.
        let types = NaturalModes::of(&reference.model)?.groups;
        let has_mixed = types.iter().any(|group| group.mode_type == ModeType::Mixed);
        let model = LumpedModel { mass: m.diagonal().iter().copied().collect(), ..reference.model };
        let group = |group: &ModeGroup| {
            let mode_type = if has_mixed { group.mode_type } else { type_of(&group.participation) };
            row(hz(group.lambda), Some(mode_type.name().to_owned()), group.multiplicity)
        };
        let found = NaturalModes::with_stiffness(&model, &k);
        Ok(found.map_or_else(|_| untyped(), |found| found.groups.iter().map(group).collect()))
    }
}
