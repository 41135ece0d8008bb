//! Which resonances are followed.

use lumped::ModeType;

use crate::natural_mode::NaturalMode;
use crate::sweep::{Part, Response};

/// One mode met by one harmonic, seen in the sun and in planet 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Series {
    /// Kind of the mode.
    pub mode_type: ModeType,
    /// Whether it is the lowest of its kind.
    pub is_lowest: bool,
    /// Natural frequency about which the peak is looked for, Hz.
    pub frequency_hz: f64,
    /// Harmonic l.
    pub harmonic: usize,
}

impl Series {
    /// What of a part is followed.
    pub fn response(&self, part: Part) -> Response {
        match self.mode_type {
            ModeType::Rotational => Response::Rotation(part),
            _ => Response::Translation(part),
        }
    }

    /// The mode as tables print it.
    pub fn mode(&self) -> &'static str {
        match (self.mode_type, self.is_lowest) {
            (ModeType::Rotational, true) => "lowest rotational",
            (ModeType::Translational, true) => "lowest translational",
            (ModeType::Translational, false) => "third translational",
            _ => "other",
        }
    }
}

/// Frequencies of a split pair are nearer than this to each other, as a ratio.
const TWINS: f64 = 1.03;

/// The resonances of section 4.2: lowest translational mode (778 Hz) in odd harmonics, lowest
/// rotational one (1144 Hz) in even ones, third translational one (2110 Hz) in odd ones. Split pairs
/// are taken by their mean, and a mode whose twin is of another kind at this position stands alone.
/// `None` if there are no such modes.
pub fn lowest_series(naturals: &[NaturalMode]) -> Option<Vec<Series>> {
    let of = |kind: ModeType| {
        let list = naturals.iter().filter(move |n| n.mode_type == kind).map(|n| n.frequency_hz);
        list.collect::<Vec<f64>>()
    };
    let (translational, rotational) = (of(ModeType::Translational), of(ModeType::Rotational));
    let pairs: Vec<&[f64]> = translational.chunk_by(|a, b| *b < TWINS * a).collect();
    let pair = |k: usize| pairs.get(k).map(|own| own.iter().sum::<f64>() / own.len() as f64);
    let one = |mode_type, is_lowest, frequency_hz, harmonic| Series {
        mode_type,
        is_lowest,
        frequency_hz,
        harmonic,
    };
    let (first, third, turning) = (pair(0)?, pair(2)?, *rotational.first()?);
    Some(vec![
        one(ModeType::Translational, true, first, 1),
        one(ModeType::Translational, true, first, 3),
        one(ModeType::Rotational, true, turning, 2),
        one(ModeType::Rotational, true, turning, 4),
        one(ModeType::Translational, false, third, 3),
        one(ModeType::Translational, false, third, 5),
    ])
}
