//! Modes of a scene, sorted by type, as checks want them.

use gearset::Scene;
use lumped::{LumpedModel, ModeType, NaturalModes};

use crate::error::ValidationError;
use crate::reference::Frequencies;

/// Model and modes of a scene.
pub(crate) fn modes_of(scene: &Scene) -> Result<(LumpedModel, NaturalModes), ValidationError> {
    let model = LumpedModel::from_scene(scene)?;
    let modes = NaturalModes::of(&model)?;
    Ok((model, modes))
}

/// Frequencies of one type, ascending, Hz.
pub(crate) fn frequencies(modes: &NaturalModes, mode_type: ModeType) -> Vec<f64> {
    modes.of_type(mode_type).map(|g| g.frequency_hz).collect()
}

/// The type a word names; anything else is `Mixed`, of which no sound published set has any.
pub(crate) fn type_named(name: &str) -> ModeType {
    [ModeType::Rotational, ModeType::Translational, ModeType::Planet]
        .into_iter()
        .find(|t| t.name() == name)
        .unwrap_or(ModeType::Mixed)
}

/// The reference frequencies of each type.
pub(crate) fn by_type(reference: &Frequencies) -> [(ModeType, &[f64]); 3] {
    [
        (ModeType::Rotational, &reference.rotational_hz),
        (ModeType::Translational, &reference.translational_hz),
        (ModeType::Planet, &reference.planet_hz),
    ]
}

/// `rotational ×1` for each distinct frequency, in order of frequency.
pub(crate) fn signature(modes: &NaturalModes) -> Vec<String> {
    let word = |g: &lumped::ModeGroup| format!("{} ×{}", g.mode_type.name(), g.multiplicity);
    modes.groups.iter().map(word).collect()
}
