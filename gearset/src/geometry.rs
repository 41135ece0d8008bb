//! The whole set's tooth geometry, worked out from one base pitch.

use std::f64::consts::{FRAC_PI_2, TAU};

use serde::Serialize;

use crate::gear::{Gear, ToothSide};
use crate::geometry_input::{GearInput, GeometryInput, ThicknessInput};
use crate::involute::inv;
use crate::mesh::{Mesh, NoMesh};
use crate::mesh_kind::{MeshKind, MeshMember};
use crate::teeth::Teeth;

/// Gears and meshes of a set. Lengths in m.
#[derive(Debug, Clone, Serialize)]
pub struct Geometry {
    /// a.
    pub center_distance: f64,
    /// p_b, shared by every gear, so that all meshes are exactly conjugate.
    pub base_pitch: f64,
    /// Face width b.
    pub face_width: f64,
    /// Sun.
    pub sun: Option<Gear>,
    /// Planet.
    pub planet: Gear,
    /// Ring.
    pub ring: Option<Gear>,
    /// Sun–planet mesh.
    pub sun_planet: Option<Mesh>,
    /// Ring–planet mesh.
    pub ring_planet: Option<Mesh>,
}

/// Profile-shift sums for zero backlash with a given rack (ring with the internal-gear sign).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ProfileShiftSums {
    /// x_s + x_p.
    pub sun_plus_planet: f64,
    /// x_r − x_p.
    pub ring_minus_planet: f64,
}

impl Geometry {
    /// Largest displacement of a body that is taken for motion and not for divergence, m: a tenth of the centre
    /// distance, beyond which no mesh is linear.
    pub fn largest_displacement(&self) -> f64 {
        0.1 * self.center_distance
    }

    /// Computes gears and meshes from the scene's input.
    ///
    /// `[eq:base-pitch]` r_b = Z p_b/2π with one base pitch p_b for all gears.
    /// Source: closed form.
    /// Checked by: `table1.base_diameter`, `table1.base_pitch`, `table1.gamma.closure`.
    ///
    /// # Errors
    /// If the base circles leave no operating pressure angle at the centre distance.
    pub fn new(input: &GeometryInput, teeth: &Teeth) -> Result<Self, NoMesh> {
        let a = input.center_distance_m;
        let make = |gear: &GearInput, teeth: u32, side| Gear {
            teeth,
            side,
            base_radius: f64::from(teeth) * input.base_pitch_m / TAU,
            tip_radius: gear.tip_radius_m,
            root_radius: gear.root_radius_m,
            body_radius: gear.body_radius_m,
            fillet_radius: gear.fillet_radius_m,
            half_angle_base: 0.0,
            tip_relief: gear.tip_relief,
        };
        let external = |gear, teeth| make(gear, teeth, ToothSide::External);
        let mut sun = input.sun.as_ref().zip(teeth.sun).map(|(g, z)| external(g, z));
        let mut planet = external(&input.planet, teeth.planet);
        let mut ring =
            input.ring.as_ref().zip(teeth.ring).map(|(g, z)| make(g, z, ToothSide::Internal));
        set_thickness(input, a, &mut sun, &mut planet, &mut ring)?;
        let sun_planet = sun.as_ref().map(|s| Mesh::sun_planet(s, &planet, a)).transpose()?;
        let ring_planet = ring.as_ref().map(|r| Mesh::ring_planet(r, &planet, a)).transpose()?;
        Ok(Self {
            center_distance: a,
            base_pitch: input.base_pitch_m,
            face_width: input.face_width_m,
            sun,
            planet,
            ring,
            sun_planet,
            ring_planet,
        })
    }

    /// One of the two meshes.
    pub fn mesh(&self, kind: MeshKind) -> Option<&Mesh> {
        match kind {
            MeshKind::SunPlanet => self.sun_planet.as_ref(),
            MeshKind::RingPlanet => self.ring_planet.as_ref(),
        }
    }

    /// Circumferential backlash at the operating pitch circles, m.
    pub fn backlash(&self, kind: MeshKind) -> Option<f64> {
        let mesh = self.mesh(kind)?;
        let (driver, driven) = (mesh.gear(MeshMember::Driver), mesh.gear(MeshMember::Driven));
        let pitch_driver = mesh.pitch_radius(MeshMember::Driver);
        let pitch_driven = mesh.pitch_radius(MeshMember::Driven);
        Some(driven.space_width(pitch_driven) - driver.tooth_thickness(pitch_driver))
    }

    /// Normal backlash j cos α = j_bn, measured along the line of action, m.
    pub fn normal_backlash(&self, kind: MeshKind) -> Option<f64> {
        Some(self.backlash(kind)? * self.mesh(kind)?.pressure_angle.cos())
    }

    /// `[eq:profile-shift-sums]` Sums of profile shift for zero backlash with a rack of pressure angle
    /// α₀ = `rack_angle` (rad): x_s + x_p = (Z_s + Z_p)(inv α_s − inv α₀)/(2 tan α₀), x_r − x_p = (Z_r − Z_p)(inv
    /// α_r − inv α₀)/(2 tan α₀).
    ///
    /// Source: closed form.
    /// Checked by: `gearset/tests/geometry.rs::a_9_dp_rack_of_22_5_degrees_describes_the_same_set`.
    pub fn zero_backlash_shift_sums(&self, rack_angle: f64) -> Option<ProfileShiftSums> {
        let (sp, rp) = (self.sun_planet.as_ref()?, self.ring_planet.as_ref()?);
        let z = |g: &Gear| f64::from(g.teeth);
        let sum = |teeth: f64, mesh: &Mesh| {
            teeth * (inv(mesh.pressure_angle) - inv(rack_angle)) / (2.0 * rack_angle.tan())
        };
        let (sun, planet, ring) = (z(self.sun.as_ref()?), z(&self.planet), z(self.ring.as_ref()?));
        Some(ProfileShiftSums {
            sun_plus_planet: sum(sun + planet, sp),
            ring_minus_planet: sum(ring - planet, rp),
        })
    }
}

/// Fills in the half lobe angles on the base circles.
///
/// `[eq:backlash]` t_s + t_p + j = p' on the operating pitch circles with the operating circular pitch p', the planet
/// with its share of p' − j; the ring's space is j wider than the planet's tooth.
/// Source: definition.
/// Checked by: `gearset/tests/geometry.rs::backlash_given_is_backlash_found`,
/// `gearset/tests/rigid_polygons.rs::set_backlash_shows_on_both_flanks_of_every_mesh`.
fn set_thickness(
    input: &GeometryInput,
    a: f64,
    sun: &mut Option<Gear>,
    planet: &mut Gear,
    ring: &mut Option<Gear>,
) -> Result<(), NoMesh> {
    match input.thickness {
        ThicknessInput::Backlash {
            sun_planet_m: sun_planet,
            ring_planet_m: ring_planet,
            planet_share,
        } => {
            if let Some(sun) = sun {
                let mesh = Mesh::sun_planet(sun, planet, a)?;
                let r_planet = mesh.pitch_radius(MeshMember::Driven);
                let both = r_planet * planet.pitch_angle() - sun_planet;
                set_arc(planet, r_planet, planet_share * both, mesh.pressure_angle);
                let r_sun = mesh.pitch_radius(MeshMember::Driver);
                set_arc(sun, r_sun, (1.0 - planet_share) * both, mesh.pressure_angle);
            }
            if let Some(ring) = ring {
                let mesh = Mesh::ring_planet(ring, planet, a)?;
                let r_planet = mesh.pitch_radius(MeshMember::Driver);
                if sun.is_none() {
                    // Without a sun, `planet_share` is the planet tooth's share of the operating pitch of
                    // the ring mesh less backlash.
                    let both = r_planet * planet.pitch_angle() - ring_planet;
                    set_arc(planet, r_planet, planet_share * both, mesh.pressure_angle);
                }
                // The ring's space is j wider than the planet's tooth.
                let space = planet.tooth_thickness(r_planet) + ring_planet;
                let r_ring = mesh.pitch_radius(MeshMember::Driven);
                set_arc(ring, r_ring, space, mesh.pressure_angle);
            }
        }
        ThicknessInput::ProfileShift { sun: x_s, planet: x_p, ring: x_r, thinning } => {
            // The reader refuses profile shifts without a rack.
            let (alpha, module) =
                input.rack.map_or((0.0, 1.0), |rack| (rack.pressure_angle_rad, rack.module_m));
            // β_b = t/(2r) + inv α₀ with t = m (π/2 + 2 x tan α₀) on r = m Z/2, less or, of a ring's space, more
            let shifted = |gear: &mut Gear, x: f64, wider: f64| {
                let t_over_2r = (FRAC_PI_2 + 2.0 * x * alpha.tan()) / f64::from(gear.teeth);
                gear.half_angle_base = t_over_2r + inv(alpha);
                if wider != 0.0 {
                    gear.half_angle_base += wider / (module * f64::from(gear.teeth));
                }
            };
            if let Some(sun) = sun {
                shifted(sun, x_s, -thinning.sun_m);
            }
            shifted(planet, x_p, -thinning.planet_m);
            if let Some(ring) = ring {
                shifted(ring, x_r, thinning.ring_m);
            }
        }
    }
    Ok(())
}

/// Makes the lobe `arc` wide at `radius`, where the pressure angle is `alpha`.
fn set_arc(gear: &mut Gear, radius: f64, arc: f64, alpha: f64) {
    gear.half_angle_base = arc / (2.0 * radius) + inv(alpha);
}
