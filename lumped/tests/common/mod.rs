//! Scenes of the repository and the modes of their models.

use std::path::Path;

use lumped::{LumpedModel, ModeType, NaturalModes};
use scene::Scene;

/// A scene file of the repository.
pub(crate) fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::from_file(&path).unwrap()
}

/// Model and modes of a scene, whose frequencies rounding must not have spoilt.
pub(crate) fn modes(scene: &Scene) -> (LumpedModel, NaturalModes) {
    let model = LumpedModel::from_scene(scene).unwrap();
    let modes = NaturalModes::of(&model).unwrap();
    assert!(modes.groups.iter().all(|g| g.uncertainty < 1e-11));
    (model, modes)
}

/// Frequencies of one type with multiplicity, Hz.
pub(crate) fn of_type(modes: &NaturalModes, mode_type: ModeType) -> Vec<(f64, usize)> {
    modes.of_type(mode_type).map(|g| (g.frequency_hz, g.multiplicity)).collect()
}
