//! Small departures from the perfect set, as offsets of the gaps.

use gearset::{Gear, MeshKind};

use super::races::Races;
use crate::contact::PairCells;

/// One sun tooth out of its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PitchError {
    /// Tooth of the sun; tooth 0 is centred on the sun's angle.
    pub tooth: i64,
    /// Material missing on the loaded flank along the line of action (negative: too much), m.
    pub amount: f64,
}

/// Departures from the perfect set.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Imperfections {
    /// Displacement of a planet's nominal place: (n, radial, tangential), m.
    pub displaced_planets: Vec<(usize, f64, f64)>,
    /// Sun teeth out of place.
    pub pitch_errors: Vec<PitchError>,
}

impl Imperfections {
    /// Seen in the mirror if `sign` is negative: tangential places and tooth numbers turn round.
    pub(super) fn mirrored(mut self, sign: f64) -> Self {
        if sign < 0.0 {
            self.displaced_planets.iter_mut().for_each(|d| d.2 = -d.2);
            self.pitch_errors.iter_mut().for_each(|e| e.tooth = -e.tooth);
        }
        self
    }

    /// What a displaced planet adds to the gap of a pair with this row, m.
    pub(super) fn shift(&self, kind: MeshKind, planet: usize, row: &[f64; 6]) -> f64 {
        let own = match kind {
            MeshKind::SunPlanet => &row[3..5],
            MeshKind::RingPlanet => &row[0..2],
        };
        let displaced = self.displaced_planets.iter().filter(|d| d.0 == planet);
        // A displacement that approaches closes the gap.
        displaced.map(|(_, radial, tangential)| -(own[0] * radial + own[1] * tangential)).sum()
    }

    /// What is added to the gaps of a pair, m.
    pub(super) fn gap(
        &self,
        kind: MeshKind,
        planet: usize,
        pair: &PairCells,
        races: &Races,
        sun_angle: f64,
        sun: Option<&Gear>,
    ) -> f64 {
        let mut gap = self.shift(kind, planet, &pair.row);
        if let (MeshKind::SunPlanet, Some(sun)) = (kind, sun) {
            let turned = pair.axes[0] + races.psi[planet] - sun_angle;
            let tooth = (turned / sun.pitch_angle()).round() as i64;
            let teeth = i64::from(sun.teeth);
            for e in &self.pitch_errors {
                if (e.tooth - tooth).rem_euclid(teeth) == 0 {
                    gap += e.amount;
                }
            }
        }
        gap
    }
}
