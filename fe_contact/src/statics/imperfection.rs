//! Small departures from the perfect set: planets out of place, teeth out of pitch.

use gearset::{Displacements, Gear, MeshKind};

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

    /// Adds a planet's departure from its nominal place to the displacements (x, y, θ) of driver and
    /// driven.
    pub(super) fn displace(&self, kind: MeshKind, planet: usize, x: &mut Displacements) {
        let first = match kind {
            MeshKind::SunPlanet => 3,
            MeshKind::RingPlanet => 0,
        };
        for (_, radial, tangential) in self.displaced_planets.iter().filter(|d| d.0 == planet) {
            x[first] += radial;
            x[first + 1] += tangential;
        }
    }

    /// What errors of the sun's teeth add to the gap of the pair whose sun tooth has its axis at `axis`
    /// (rad from where tooth 0 has its own), m.
    pub(super) fn gap(&self, kind: MeshKind, axis: f64, sun: Option<&Gear>) -> f64 {
        let (MeshKind::SunPlanet, Some(sun)) = (kind, sun) else { return 0.0 };
        let tooth = (axis / sun.pitch_angle()).round() as i64;
        let teeth = i64::from(sun.teeth);
        let own = self.pitch_errors.iter().filter(|e| (e.tooth - tooth).rem_euclid(teeth) == 0);
        own.map(|e| e.amount).sum()
    }
}
