//! Mesh phases: where each mesh stands in its cycle, for any sun angle and either loaded flank.
//!
//! A phase is counted in cycles and is zero where a pair starts the theoretical path of contact
//! with the sun driving. Everything is taken in the carrier frame.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use crate::gear::{Facing, Gear};
use crate::geometry::Geometry;
use crate::mesh::Mesh;
use crate::mesh_kind::{MeshKind, MeshMember};
use crate::planet_positions::PlanetPositions;

/// Phases of all meshes at one sun angle, in cycles, each in [0, 1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeshPhases {
    /// φ_sn, one per planet.
    pub sun_planet: Vec<f64>,
    /// φ_rn, one per planet.
    pub ring_planet: Vec<f64>,
}

/// What is needed to place every gear of a set at any position.
#[derive(Debug, Clone)]
pub struct Phasing<'g> {
    sun: &'g Gear,
    planet: &'g Gear,
    ring: &'g Gear,
    sun_planet: &'g Mesh,
    ring_planet: &'g Mesh,
    positions: &'g PlanetPositions,
}

/// Angles of all lobes 0 in the carrier frame, rad.
#[derive(Debug, Clone, PartialEq)]
pub struct GearAngles {
    /// Sun tooth.
    pub sun: f64,
    /// Ring space.
    pub ring: f64,
    /// Planet teeth.
    pub planets: Vec<f64>,
}

impl<'g> Phasing<'g> {
    /// Phasing of a whole set; `None` without a sun or a ring.
    pub fn new(geometry: &'g Geometry, positions: &'g PlanetPositions) -> Option<Self> {
        Some(Self {
            sun: geometry.sun.as_ref()?,
            planet: &geometry.planet,
            ring: geometry.ring.as_ref()?,
            sun_planet: geometry.sun_planet.as_ref()?,
            ring_planet: geometry.ring_planet.as_ref()?,
            positions,
        })
    }

    /// `[eq:gamma-pitch-to-pitch]` γ measured from pitch point to pitch point, cycles in [0, 1):
    /// γ_pp = Z_p/2 + (Z_p/2π)(t_sp/r_sp + t_rp/r_rp)/2.
    ///
    /// Source: derived here.
    /// Checked by: `table1.gamma.closure`.
    pub fn gamma_pitch_to_pitch(&self) -> f64 {
        let z_p = f64::from(self.planet.teeth);
        let half_angle = |mesh: &Mesh, member| self.planet.half_angle(mesh.pitch_radius(member));
        let thickness = half_angle(self.sun_planet, MeshMember::Driven)
            + half_angle(self.ring_planet, MeshMember::Driver);
        cycle(0.5 * z_p + z_p / TAU * thickness)
    }

    /// γ = φ_rn − φ_sn, path start to path start, cycles in [0, 1).
    ///
    /// `[eq:gamma]` γ = γ_pp + (r_bp tan α_r − r_start)/p_b − (r_bs tan α_s − s_start)/p_b with the places of the
    /// pitch points on the paths of ring and sun mesh that start at the roll lengths r_start and s_start.
    /// Source: derived here.
    /// Checked by: `gearset/tests/rigid_polygons.rs::a_wrong_gamma_or_a_planet_off_its_step_does_not_pass`,
    /// `table1.gamma.closure`.
    pub fn gamma(&self) -> f64 {
        let into_path = |mesh: &Mesh| {
            let pitch_point = mesh.gear(MeshMember::Driver).base_radius * mesh.pressure_angle.tan();
            (pitch_point - mesh.path_start) / mesh.base_pitch
        };
        let shift = into_path(self.ring_planet) - into_path(self.sun_planet);
        cycle(self.gamma_pitch_to_pitch() + shift)
    }

    /// Phases with the sun's tooth 0 at `sun_angle` (carrier frame, rad) and the flanks that face
    /// `loaded` on the sun in contact. Positions given in assembly steps enter exactly.
    ///
    /// `[eq:mesh-phase]` With the sun's lobe 0 centred at θ_s and the counter-clockwise flanks loaded (+u_s presses
    /// the sun meshes):
    /// ```text
    /// φ_sn = Z_s (θ_s + β_s + α_s − ψ_n)/2π − s_start/p_b,   φ_rn = φ_sn + γ + (Z_s + Z_r) ψ_n/2π;
    /// with the clockwise flanks loaded the mirror image, θ_s → −θ_s, ψ_n → −ψ_n.
    /// ```
    /// Source: derived here.
    /// Checked by: `gearset/tests/rigid_polygons.rs::phases_follow_their_closed_form_and_start_the_path`,
    /// `gearset/tests/rigid_polygons.rs::reversed_load_uses_the_other_flanks`.
    pub fn phases(&self, sun_angle: f64, loaded: Facing) -> MeshPhases {
        let sign = loaded.sign();
        let z_s = f64::from(self.sun.teeth);
        let start = self.sun_planet.sun_mesh_phase(sun_angle, loaded);
        let gamma = self.gamma();
        let sun: Vec<f64> =
            (0..self.positions.count()).map(|n| start - sign * self.turns(n, z_s)).collect();
        let both = z_s + f64::from(self.ring.teeth);
        let ring = sun.iter().enumerate().map(|(n, phi)| {
            // (Z_s + Z_r) ψ_n/2π is a whole number for positions that can be assembled.
            let whole = match &self.positions.steps {
                Some(_) => 0.0,
                None => sign * self.turns(n, both),
            };
            cycle(phi + gamma + whole)
        });
        let ring_planet = ring.collect();
        MeshPhases { sun_planet: sun.into_iter().map(cycle).collect(), ring_planet }
    }

    /// Z ψ_n / 2π reduced by whole turns, exactly where steps are known.
    fn turns(&self, n: usize, teeth: f64) -> f64 {
        match &self.positions.steps {
            Some(steps) => {
                let total = i64::from(self.sun.teeth) + i64::from(self.ring.teeth);
                ((teeth as i64) * steps[n]).rem_euclid(total) as f64 / total as f64
            }
            None => teeth * self.positions.psi_rad[n] / TAU,
        }
    }

    /// Places every gear from the phases alone, the flanks that face `loaded` on the sun touching
    /// in every sun mesh, the ring turned so that planet 0's ring mesh stands at its phase.
    pub fn gear_angles(&self, sun_angle: f64, loaded: Facing) -> GearAngles {
        let sign = loaded.sign();
        let phases = self.phases(sun_angle, loaded);
        let mesh = self.sun_planet;
        let mirrored = |n: usize| sign * self.positions.psi_rad[n];
        // s' = r_bp (θ₀ − (ψ_n + π − α_s)), θ₀ = θ_p + β_p, in the frame mirrored by `sign`.
        let planet_angle = |n: usize| {
            let roll_length = mesh.path_start + phases.sun_planet[n] * mesh.base_pitch;
            let tangent = mirrored(n) + PI - mesh.pressure_angle;
            let origin = tangent + mesh.driven_roll_length(roll_length) / self.planet.base_radius;
            sign * (origin - self.planet.half_angle_base)
        };
        // s_r = r_br (ψ_0 + α_r − θ₀), θ₀ = θ_r − β_r.
        let mesh = self.ring_planet;
        let roll_length = mesh.path_start + phases.ring_planet[0] * mesh.base_pitch;
        let tangent = mirrored(0) + mesh.pressure_angle;
        let origin = tangent - mesh.driven_roll_length(roll_length) / self.ring.base_radius;
        GearAngles {
            sun: sun_angle,
            ring: sign * (origin + self.ring.half_angle_base),
            planets: (0..self.positions.count()).map(planet_angle).collect(),
        }
    }

    /// Normal gaps of planet n's mesh along its two lines of action, m: first of the flanks that are loaded
    /// if the sun's flanks facing `loaded` are, then of the opposite flanks. Reduced to ± half a base pitch.
    ///
    /// Flanks touch where the roll lengths of the two gears add up to a sin α (sun mesh) or differ by it
    /// (ring mesh).
    pub fn normal_gaps(
        &self,
        angles: &GearAngles,
        n: usize,
        kind: MeshKind,
        loaded: Facing,
    ) -> [f64; 2] {
        [loaded, loaded.opposite()].map(|facing| {
            // Mirroring turns clockwise flanks into counter-clockwise ones.
            let sign = facing.sign();
            let psi = sign * self.positions.psi_rad[n];
            let theta_p = sign * angles.planets[n];
            let (planet, beta_p) = (self.planet, self.planet.half_angle_base);
            let gap = match kind {
                MeshKind::SunPlanet => {
                    let (mesh, sun) = (self.sun_planet, self.sun);
                    let alpha = mesh.pressure_angle;
                    let reach = mesh.center_distance * alpha.sin();
                    let on_sun =
                        sun.base_radius * (sign * angles.sun + sun.half_angle_base - psi + alpha);
                    let on_planet = planet.base_radius * (theta_p + beta_p - psi - PI + alpha);
                    reach - on_sun - on_planet
                }
                MeshKind::RingPlanet => {
                    let (mesh, ring) = (self.ring_planet, self.ring);
                    let alpha = mesh.pressure_angle;
                    let reach = mesh.center_distance * alpha.sin();
                    let on_planet = planet.base_radius * (psi + alpha - theta_p + beta_p);
                    let on_ring = ring.base_radius
                        * (psi + alpha - sign * angles.ring + ring.half_angle_base);
                    on_ring - on_planet - reach
                }
            };
            let pitch = self.sun_planet.base_pitch;
            gap - pitch * (gap / pitch).round()
        })
    }
}

impl Mesh {
    /// Phase of a sun–planet mesh whose planet stands at ψ = 0, not reduced, cycles; arguments as those of
    /// [`Phasing::phases`].
    pub fn sun_mesh_phase(&self, sun_angle: f64, loaded: Facing) -> f64 {
        let sun = self.gear(MeshMember::Driver);
        // φ_s = Z_s (θ_s + β_s + α_s)/2π − s_start/p_b
        let turned = loaded.sign() * sun_angle + sun.half_angle_base + self.pressure_angle;
        f64::from(sun.teeth) * turned / TAU - self.path_start / self.base_pitch
    }
}

/// Fractional part in [0, 1).
fn cycle(x: f64) -> f64 {
    let fraction = x - x.floor();
    if fraction >= 1.0 { 0.0 } else { fraction }
}
