//! Small deviations from the perfect set: displaced planets, pitch errors of sun teeth.

use gearset::{Displacements, Gear, MeshKind};

/// Pitch error of one sun tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PitchError {
    /// Tooth of the sun; tooth 0 is centred on the sun's angle.
    pub tooth: i64,
    /// Material missing on the loaded flank along the line of action (negative: too much), m.
    pub amount: f64,
}

/// Deviations from the perfect set.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Imperfections {
    /// Displacement of a planet's nominal place: (n, radial, tangential), m.
    pub displaced_planets: Vec<(usize, f64, f64)>,
    /// Pitch errors of sun teeth.
    pub pitch_errors: Vec<PitchError>,
}

impl Imperfections {
    /// Mirrored if `sign` is negative: tangential displacements and tooth numbers change sign.
    pub(super) fn mirrored(mut self, sign: f64) -> Self {
        if sign < 0.0 {
            self.displaced_planets.iter_mut().for_each(|d| d.2 = -d.2);
            self.pitch_errors.iter_mut().for_each(|e| e.tooth = -e.tooth);
        }
        self
    }

    /// Adds the displacement of a planet's nominal place to the displacements (x, y, θ) of driver
    /// and driven.
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

    /// What pitch errors of the sun add to the gap of the pair whose sun tooth has its axis at
    /// `axis` (rad from the axis of tooth 0), m.
    pub(super) fn gap(&self, kind: MeshKind, axis: f64, sun: Option<&Gear>) -> f64 {
        let (MeshKind::SunPlanet, Some(sun)) = (kind, sun) else { return 0.0 };
        let tooth = (axis / sun.pitch_angle()).round() as i64;
        let teeth = i64::from(sun.teeth);
        let own = self.pitch_errors.iter().filter(|e| (e.tooth - tooth).rem_euclid(teeth) == 0);
        own.map(|e| e.amount).sum()
    }
}
