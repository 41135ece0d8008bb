//! One mesh: line of action, path of contact, contact ratio, interference, tip gaps.

use serde::Serialize;

use crate::gear::{Facing, Flank, Gear, ToothSide};
use crate::involute::{radius_at, roll_length_at};
use crate::mesh_kind::{MeshKind, MeshMember};

/// One involute mesh with the central gear at the origin and the planet at (a, 0); the central
/// input turns counter-clockwise. Lengths in m, angles in rad.
#[derive(Debug, Clone, Serialize)]
pub struct Mesh {
    /// Which mesh.
    pub kind: MeshKind,
    /// Operating pressure angle α.
    pub pressure_angle: f64,
    /// Operating module 2 r' / Z.
    pub operating_module: f64,
    /// a.
    pub center_distance: f64,
    /// p_b.
    pub base_pitch: f64,
    /// Driver's roll length where a pair starts the theoretical path of contact.
    pub path_start: f64,
    /// Driver's roll length where it ends.
    pub path_end: f64,
    /// Contact ratio ε.
    pub contact_ratio: f64,
    #[serde(skip)]
    driver: Gear,
    #[serde(skip)]
    driven: Gear,
}

/// No involute mesh exists at this centre distance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "the {} mesh needs a centre distance above {:.6} mm: its base circles would overlap", kind.name(), least * 1e3
)]
pub struct NoMesh {
    /// Which mesh.
    pub kind: MeshKind,
    /// Sum (external) or difference (internal) of the base radii, m.
    pub least: f64,
}

impl Mesh {
    /// Sun–planet mesh.
    pub fn sun_planet(sun: &Gear, planet: &Gear, a: f64) -> Result<Self, NoMesh> {
        let kind = MeshKind::SunPlanet;
        let least = sun.base_radius + planet.base_radius;
        let pressure_angle = operating_angle(kind, least, a)?;
        let reach = a * pressure_angle.sin();
        let (path_start, path_end) = (reach - planet.tip_roll_length(), sun.tip_roll_length());
        Ok(Self::new(kind, pressure_angle, a, path_start, path_end, sun, planet))
    }

    /// Ring–planet mesh.
    pub fn ring_planet(ring: &Gear, planet: &Gear, a: f64) -> Result<Self, NoMesh> {
        let kind = MeshKind::RingPlanet;
        let least = ring.base_radius - planet.base_radius;
        let pressure_angle = operating_angle(kind, least, a)?;
        let reach = a * pressure_angle.sin();
        let (path_start, path_end) = (ring.tip_roll_length() - reach, planet.tip_roll_length());
        Ok(Self::new(kind, pressure_angle, a, path_start, path_end, planet, ring))
    }

    /// `[eq:contact-ratio]` ε = (path_end − path_start)/p_b, the path of contact between the tip circles over the
    /// base pitch.
    ///
    /// Source: closed form.
    /// Checked by: `gearset/tests/geometry.rs::operating_angles_and_contact_ratios_of_table_1`,
    /// `table1.contact_ratio`.
    fn new(
        kind: MeshKind,
        pressure_angle: f64,
        center_distance: f64,
        path_start: f64,
        path_end: f64,
        driver: &Gear,
        driven: &Gear,
    ) -> Self {
        let base_pitch = driver.base_radius * driver.pitch_angle();
        Self {
            kind,
            pressure_angle,
            operating_module: 2.0 * driver.base_radius
                / pressure_angle.cos()
                / f64::from(driver.teeth),
            center_distance,
            base_pitch,
            path_start,
            path_end,
            contact_ratio: (path_end - path_start) / base_pitch,
            driver: driver.clone(),
            driven: driven.clone(),
        }
    }

    /// The gear of one member.
    pub fn gear(&self, member: MeshMember) -> &Gear {
        match member {
            MeshMember::Driver => &self.driver,
            MeshMember::Driven => &self.driven,
        }
    }

    /// Operating pitch radius r' = r_b / cos α of one member.
    pub fn pitch_radius(&self, member: MeshMember) -> f64 {
        self.gear(member).base_radius / self.pressure_angle.cos()
    }

    /// Driven gear's roll length where the driver's is `roll_length`.
    pub fn driven_roll_length(&self, roll_length: f64) -> f64 {
        let reach = self.center_distance * self.pressure_angle.sin();
        match self.kind {
            MeshKind::SunPlanet => reach - roll_length, // between the two tangent points
            MeshKind::RingPlanet => reach + roll_length, // both tangent points on the same side
        }
    }

    /// Driver and driven flank of the pair that touches where the driver's roll length is `roll_length`.
    ///
    /// Beyond the theoretical path the flanks are the ones that *would* touch there.
    pub fn flanks(&self, roll_length: f64) -> (Flank<'_>, Flank<'_>) {
        let alpha = self.pressure_angle;
        let mate = self.driven_roll_length(roll_length);
        let planet_centre = [self.center_distance, 0.0];
        match self.kind {
            // Tangent points at −α on the sun and π − α on the planet; both involutes unwind
            // counter-clockwise: s = r_b (θ₀ − θ_T).
            MeshKind::SunPlanet => (
                Flank {
                    gear: &self.driver,
                    centre: [0.0, 0.0],
                    origin_angle: -alpha + roll_length / self.driver.base_radius,
                    facing: Facing::CounterClockwise,
                },
                Flank {
                    gear: &self.driven,
                    centre: planet_centre,
                    origin_angle: std::f64::consts::PI - alpha + mate / self.driven.base_radius,
                    facing: Facing::CounterClockwise,
                },
            ),
            // Tangent points at +α on both; involutes unwind clockwise: s = r_b (θ_T − θ₀).
            MeshKind::RingPlanet => (
                Flank {
                    gear: &self.driver,
                    centre: planet_centre,
                    origin_angle: alpha - roll_length / self.driver.base_radius,
                    facing: Facing::Clockwise,
                },
                Flank {
                    gear: &self.driven,
                    centre: [0.0, 0.0],
                    origin_angle: alpha - mate / self.driven.base_radius,
                    facing: Facing::Clockwise,
                },
            ),
        }
    }

    /// Gap between the tip corner of one member and the mating flank when the pair stands
    /// `outside` metres (along the line of action) beyond that tip's end of the path, m.
    ///
    /// The driven tip ends the path where contact starts, the driver's tip where it ends.
    /// Negative `outside` is inside the path: the flanks then touch elsewhere and the corner is
    /// clear of the mate by the same measure. `None` if the corner is inside the mate's base circle.
    pub fn tip_gap(&self, tip: MeshMember, outside: f64) -> Option<f64> {
        let roll_length = match tip {
            MeshMember::Driven => self.path_start - outside,
            MeshMember::Driver => self.path_end + outside,
        };
        let (driver, driven) = self.flanks(roll_length);
        let (own, mate) = match tip {
            MeshMember::Driver => (driver, driven),
            MeshMember::Driven => (driven, driver),
        };
        mate.gap_to(own.point(own.gear.tip_roll_length()))
    }

    /// Length by which the path of contact extends beyond the involute part of the flanks of `member`, m:
    /// positive if the mate's tip touches `member` inside its form circle (the ring: outside it).
    pub fn interference(&self, member: MeshMember) -> f64 {
        let gear = self.gear(member);
        let form = gear.form_roll_length().unwrap_or(0.0);
        let (start, end) = (self.path_start, self.path_end);
        match (self.kind, member) {
            (_, MeshMember::Driver) => form - start,
            (MeshKind::SunPlanet, MeshMember::Driven) => form - self.driven_roll_length(end),
            (MeshKind::RingPlanet, MeshMember::Driven) => self.driven_roll_length(end) - form,
        }
    }

    /// Tip radius of `member` at which its tip just stays on the involute of its mate, m: external teeth must not be
    /// higher, those of a ring not reach further in. `None` if no tip circle outside the base circle does.
    pub fn admissible_tip_radius(&self, member: MeshMember) -> Option<f64> {
        self.tip_radius_reaching(member, self.mate(member).form_roll_length().unwrap_or(0.0))
    }

    /// Tip radius of `member` at which its tip touches its mate at a roll length of the mate, m. `None` if no tip
    /// circle outside the base circle does.
    pub fn tip_radius_reaching(&self, member: MeshMember, mate_roll_length: f64) -> Option<f64> {
        let reach = self.center_distance * self.pressure_angle.sin();
        let roll_length = match (self.kind, member) {
            (MeshKind::SunPlanet, _) => reach - mate_roll_length,
            (MeshKind::RingPlanet, MeshMember::Driver) => mate_roll_length - reach,
            (MeshKind::RingPlanet, MeshMember::Driven) => reach + mate_roll_length,
        };
        let base_radius = self.gear(member).base_radius;
        (roll_length > 0.0).then(|| radius_at(base_radius, roll_length))
    }

    /// The gear that meshes with `member`.
    pub fn mate(&self, member: MeshMember) -> &Gear {
        match member {
            MeshMember::Driver => &self.driven,
            MeshMember::Driven => &self.driver,
        }
    }

    /// Radial clearance between the tip circle of `member` and the mating root circle, m.
    pub fn root_clearance(&self, member: MeshMember) -> f64 {
        let (a, driver, driven) = (self.center_distance, &self.driver, &self.driven);
        match (self.kind, member) {
            (MeshKind::SunPlanet, MeshMember::Driver) => a - driver.tip_radius - driven.root_radius,
            (MeshKind::SunPlanet, MeshMember::Driven) => a - driven.tip_radius - driver.root_radius,
            (MeshKind::RingPlanet, MeshMember::Driver) => {
                driven.root_radius - a - driver.tip_radius
            }
            (MeshKind::RingPlanet, MeshMember::Driven) => {
                driven.tip_radius - a - driver.root_radius
            }
        }
    }

    /// Angle (at the ring) by which planet tips clear ring tips where the tip circles cross, far
    /// from the path of contact; `None` for an external mesh. Negative: tip fouling.
    ///
    /// With tooth and space centred on the line of centres, the planet's tip corner meets the
    /// crossing of the tip circles (at ξ_p from the planet, ξ_r from the ring) when the planet has
    /// turned ξ_p ∓ β_p; the space's centre then stands at (Z_p/Z_r)(ξ_p ∓ β_p) and its mouth
    /// reaches β_r to either side.
    pub fn tip_fouling_clearance(&self) -> Option<f64> {
        if self.kind == MeshKind::SunPlanet || self.driven.side == ToothSide::External {
            return None;
        }
        let (planet, ring, a) = (&self.driver, &self.driven, self.center_distance);
        let (rp, rr) = (planet.tip_radius, ring.tip_radius);
        // Crossing of |Q| = r_ar with |Q − (a, 0)| = r_ap.
        let x = (rr * rr - rp * rp + a * a) / (2.0 * a);
        let y = roll_length_at(x.abs(), rr);
        let (xi_r, xi_p) = (y.atan2(x), y.atan2(x - a));
        let ratio = f64::from(planet.teeth) / f64::from(ring.teeth);
        let mouth = ring.half_angle(rr);
        let land = planet.half_angle(rp);
        let clear = |offset: f64| mouth - (xi_r - ratio * (xi_p - offset)).abs();
        Some(clear(land).min(clear(-land)))
    }
}

/// `[eq:operating-angle]` cos α_s = (r_bs + r_bp)/a of a sun mesh, cos α_r = (r_br − r_bp)/a of a ring mesh; `least`
/// is the numerator.
///
/// Source: closed form.
/// Checked by: `gearset/tests/geometry.rs::operating_angles_and_contact_ratios_of_table_1`, `table1.pressure_angle`,
/// `table1.center_distance`.
fn operating_angle(kind: MeshKind, least: f64, a: f64) -> Result<f64, NoMesh> {
    if !(least > 0.0 && a > least) {
        return Err(NoMesh { kind, least });
    }
    Ok((roll_length_at(least, a) / least).atan())
}
