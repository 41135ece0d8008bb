//! What the profile shifts of two gears leave between their teeth, how far the rounding of printed digits moves it, and
//! at which shifts or distance it is nothing.

use crate::geometry_input::{Rack, ThicknessInput, Thinning};
use crate::involute::{angle_with_inv, inv};
use crate::mesh_kind::MeshKind;
use crate::teeth::Teeth;

/// One mesh of two gears of one rack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShiftedMesh {
    /// Which mesh.
    pub kind: MeshKind,
    /// Z_s + Z_p of a sun mesh, Z_r − Z_p of a ring mesh.
    pub teeth: f64,
    /// The rack of both gears.
    pub rack: Rack,
    /// Centre distance a, m.
    pub center_distance: f64,
    /// x_s + x_p of a sun mesh, x_r − x_p of a ring mesh, each shift positive outwards.
    pub shift_sum: f64,
}

/// Half-units of the last digits with which lengths (m) and shifts are written; 0 where a value is exact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WrittenRounding {
    /// Of the centre distance.
    pub center_distance_m: f64,
    /// Of the module.
    pub module_m: f64,
    /// Of x_s, x_p and x_r.
    pub shifts: [f64; 3],
}

impl ShiftedMesh {
    /// The mesh of a kind with the shifts of `thickness`, which are 0 where backlash gives the thickness; `None` where
    /// a gear is absent or the ring has no more teeth than the planet.
    pub fn new(
        kind: MeshKind,
        teeth: &Teeth,
        rack: Rack,
        center_distance: f64,
        thickness: &ThicknessInput,
    ) -> Option<Self> {
        let (sun, planet, ring) = match *thickness {
            ThicknessInput::ProfileShift { sun, planet, ring, .. } => (sun, planet, ring),
            ThicknessInput::Backlash { .. } => (0.0, 0.0, 0.0),
        };
        let z_planet = f64::from(teeth.planet);
        let (teeth, shift_sum) = match kind {
            MeshKind::SunPlanet => (f64::from(teeth.sun?) + z_planet, sun + planet),
            MeshKind::RingPlanet => (f64::from(teeth.ring?) - z_planet, ring - planet),
        };
        (teeth > 0.0).then_some(Self { kind, teeth, rack, center_distance, shift_sum })
    }

    /// The same mesh with another sum of shifts.
    pub fn with_shift_sum(self, shift_sum: f64) -> Self {
        Self { shift_sum, ..self }
    }

    /// Reference centre distance m Z/2, at which gears without shift close, m.
    pub fn reference_distance(&self) -> f64 {
        0.5 * self.rack.module_m * self.teeth
    }

    /// Operating pressure angle, rad: cos α_w = m Z cos α₀/2a; `None` where the base circles leave none.
    pub fn pressure_angle(&self) -> Option<f64> {
        let least = self.reference_distance() * self.rack.pressure_angle_rad.cos();
        (least < self.center_distance).then(|| (least / self.center_distance).acos())
    }

    /// `[eq:shift-backlash]` Circumferential backlash at the operating pitch circles that the shifts alone leave, m: ±
    /// 2a (inv α_w − inv α₀ − 2 tan α₀ Σx/Z), upper sign of a sun mesh.
    ///
    /// Source: closed form.
    /// Checked by: `gearset/tests/shifted_mesh.rs::backlash_of_shifts_is_that_of_the_teeth`.
    pub fn backlash(&self) -> Option<f64> {
        let alpha = self.rack.pressure_angle_rad;
        let open = inv(self.pressure_angle()?) - inv(alpha);
        let shifted = 2.0 * alpha.tan() * self.shift_sum / self.teeth;
        Some(self.sign() * 2.0 * self.center_distance * (open - shifted))
    }

    fn sign(&self) -> f64 {
        match self.kind {
            MeshKind::SunPlanet => 1.0,
            MeshKind::RingPlanet => -1.0,
        }
    }

    /// Σx at which the backlash is nothing at this distance: Z (inv α_w − inv α₀)/(2 tan α₀).
    pub fn closing_shift_sum(&self) -> Option<f64> {
        let alpha = self.rack.pressure_angle_rad;
        Some(self.teeth * (inv(self.pressure_angle()?) - inv(alpha)) / (2.0 * alpha.tan()))
    }

    /// Centre distance at which the backlash is nothing with these shifts, m: a = m Z cos α₀/(2 cos α_w) with inv α_w =
    /// inv α₀ + 2 tan α₀ Σx/Z; `None` where no angle has that involute.
    pub fn closing_distance(&self) -> Option<f64> {
        let alpha = self.rack.pressure_angle_rad;
        if self.shift_sum == 0.0 {
            return Some(self.reference_distance());
        }
        let working = angle_with_inv(inv(alpha) + 2.0 * alpha.tan() * self.shift_sum / self.teeth)?;
        Some(self.reference_distance() * alpha.cos() / working.cos())
    }

    /// `[eq:backlash-rounding]` Largest change of the backlash by the rounding of what is written, to first order, m:
    /// Σ |∂j/∂x| δx with |∂j/∂x_i| = 4a tan α₀/Z, |∂j/∂a| = 2 tan α_w and |∂j/∂m| = 2a tan α_w/m about a closed mesh.
    ///
    /// Source: derived here.
    /// Checked by: `gearset/tests/shifted_mesh.rs::rounding_moves_the_backlash_as_differences_do`.
    pub fn rounding(&self, written: &WrittenRounding) -> f64 {
        let Some(working) = self.pressure_angle() else { return 0.0 };
        let [sun, planet, ring] = written.shifts;
        let shifts = planet + if self.kind == MeshKind::SunPlanet { sun } else { ring };
        let per_shift =
            4.0 * self.center_distance * self.rack.pressure_angle_rad.tan() / self.teeth;
        let per_module = 2.0 * self.center_distance * working.tan() / self.rack.module_m;
        per_shift * shifts
            + 2.0 * working.tan() * written.center_distance_m
            + per_module * written.module_m
    }

    /// Backlash over the sum of the thinnings of both gears, which are arcs on the reference circles: 2a/(m Z).
    pub fn backlash_per_thinning(&self) -> f64 {
        self.center_distance / self.reference_distance()
    }
}

impl Thinning {
    /// Thinning that adds `[sun mesh, ring mesh]` to the sums of the thinnings of these meshes, m of arc on the
    /// reference circles: half of each need from each gear; where both meshes need some, the planet gives half of the
    /// smaller need, and sun and ring what is missing.
    pub fn shared(needs: [f64; 2]) -> Self {
        let smaller = needs.into_iter().filter(|need| *need > 0.0).reduce(f64::min);
        let planet = 0.5 * smaller.unwrap_or(0.0);
        let missing = |need: f64| (need - planet).max(0.0);
        Self { sun_m: missing(needs[0]), planet_m: planet, ring_m: missing(needs[1]) }
    }

    /// The sum of the thinnings of both gears of a mesh, m of arc on the reference circles.
    pub fn of_mesh(&self, kind: MeshKind) -> f64 {
        self.planet_m + if kind == MeshKind::SunPlanet { self.sun_m } else { self.ring_m }
    }
}
