//! The resonances that are followed over torque.

use lumped::ModeType;

use crate::natural_mode::NaturalMode;
use crate::sweep::{Part, Response};

/// One mode excited by one harmonic, as seen in the sun and in planet 0.
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
    /// The response of a part that is followed.
    pub fn response(&self, part: Part) -> Response {
        match self.mode_type {
            ModeType::Rotational => Response::Rotation(part),
            _ => Response::Translation(part),
        }
    }

    /// Name of the mode, as printed in tables.
    pub fn mode(&self) -> &'static str {
        match (self.mode_type, self.is_lowest) {
            (ModeType::Rotational, true) => "lowest rotational",
            (ModeType::Translational, true) => "lowest translational",
            (ModeType::Translational, false) => "third translational",
            _ => "other",
        }
    }
}

/// Modes below this are rigid-body motion, Hz.
const RIGID_HZ: f64 = 1.0;

/// The frequencies of a split pair have a smaller ratio than this.
const TWINS: f64 = 1.03;

/// The resonances of section 4.2 of Parker, Agashe & Vijayakar (2000): lowest translational mode (778 Hz) in
/// odd harmonics, lowest rotational mode (1144 Hz) in even ones, third translational mode (2110 Hz) in odd
/// ones. A split pair is taken at its mean frequency; a mode whose partner is classified as another kind at
/// this position is taken at its own. `None` if one of these modes is missing.
pub fn lowest_series(naturals: &[NaturalMode]) -> Option<Vec<Series>> {
    let of = |kind: ModeType| {
        let own = naturals.iter().filter(|n| n.mode_type == kind && n.frequency_hz > RIGID_HZ);
        let mut list: Vec<f64> = own.map(|n| n.frequency_hz).collect();
        list.sort_by(f64::total_cmp);
        list
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_modes_and_rigid_motion_do_not_matter() {
        use ModeType::{Planet, Rotational, Translational};
        let mode = |(frequency_hz, mode_type)| NaturalMode { frequency_hz, mode_type };
        let mut modes = [
            (0.0, Rotational),
            (775.0, Translational),
            (783.0, Translational),
            (1144.0, Rotational),
            (1676.0, Planet),
            (1729.0, Translational),
            (2110.0, Translational),
            (2156.0, Translational),
        ]
        .map(mode);
        let sorted = lowest_series(&modes).unwrap();
        assert_eq!(sorted[0].frequency_hz, 779.0);
        assert_eq!(sorted[2].frequency_hz, 1144.0);
        assert_eq!(sorted[4].frequency_hz, 2133.0);
        modes.reverse();
        assert_eq!(lowest_series(&modes).unwrap(), sorted);
        assert!(lowest_series(&modes[..3]).is_none());
    }
}
