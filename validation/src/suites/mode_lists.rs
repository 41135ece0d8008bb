//! Lists of modes as checks want them.

use experiments::{NaturalMode, distinct};
use lumped::ModeType;

use crate::reference::Frequencies;

/// The reference frequencies of each type.
pub(crate) fn by_type(reference: &Frequencies) -> [(ModeType, &[f64]); 3] {
    [
        (ModeType::Rotational, &reference.rotational_hz),
        (ModeType::Translational, &reference.translational_hz),
        (ModeType::Planet, &reference.planet_hz),
    ]
}

/// `rotational ×1` for each distinct frequency, in order of frequency.
pub(crate) fn signature(modes: &[NaturalMode]) -> Vec<String> {
    let list = distinct(modes);
    list.iter().map(|d| format!("{} ×{}", d.mode_type.name(), d.multiplicity)).collect()
}

/// How often each distinct frequency of one type occurs, by frequency.
pub(crate) fn multiplicities(modes: &[NaturalMode], mode_type: ModeType) -> Vec<usize> {
    let own = distinct(modes).into_iter().filter(|d| d.mode_type == mode_type);
    own.map(|d| d.multiplicity).collect()
}
