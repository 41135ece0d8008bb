//! Mean mesh stiffness by the standard: ISO 6336-1:2006, clause 9, method B.

use std::f64::consts::FRAC_PI_2;

use crate::gear::Gear;
use crate::involute::inv;
use crate::mesh::Mesh;
use crate::mesh_kind::{MeshKind, MeshMember};

/// Basic rack of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BasicRack {
    /// Module m, m.
    pub module: f64,
    /// Pressure angle α_P, degrees.
    pub pressure_angle_deg: f64,
}

impl BasicRack {
    /// Profile shift coefficient x of a gear cut with this rack, from its tooth thickness:
    /// t = m (π/2 + 2 x tan α_P) on r = m z/2.
    pub fn profile_shift(&self, gear: &Gear) -> f64 {
        let alpha = self.pressure_angle_deg.to_radians();
        let z = f64::from(gear.teeth);
        let angle = gear.half_angle_base - inv(alpha);
        (angle * z - FRAC_PI_2) / (2.0 * alpha.tan())
    }
}

/// Theoretical mean mesh stiffness c_γ of a spur mesh per face width, N/(mm µm).
///
/// `[eq:iso-6336-stiffness]` Mean mesh stiffness c_γ:
/// ```text
/// q' = C₁ + C₂/z₁ + C₃/z₂ + C₄x₁ + C₅x₁/z₁ + C₆x₂ + C₇x₂/z₂ + C₈x₁² + C₉x₂²,   c' = C_B/q',
/// C_B = [1 + 0.5 (1.2 − h_f/m)][1 − 0.02 (20° − α_P)],   c_γ = c' (0.75 ε_α + 0.25)
/// ```
/// Source: ISO 6336-1:2006, clause 9, method B.
/// Checked by: `gearset/src/iso6336.rs::two_standard_gears_of_twenty_teeth_by_hand`, compared with FE/contact in
/// `fe.iso_6336` (tolerance 8 %, the ring mesh is a listed miss).
///
/// An internal gear has z₂ = ∞ and x₂ = 0. The dedendum h_f comes from the driver's root circle. The gears are solid
/// discs (C_R = 1). The correction factor C_M = 0.8, which adjusts theoretical values to measured ones, is left out.
///
/// The standard fits the polynomial to external spur gears of x₁ ≥ x₂, −0.5 ≤ x₁ + x₂ ≤ 2; outside these
/// limits, which are not checked here, c_γ is extrapolated.
pub fn mean_mesh_stiffness(mesh: &Mesh, rack: &BasicRack) -> f64 {
    let (driver, driven) = (mesh.gear(MeshMember::Driver), mesh.gear(MeshMember::Driven));
    let (z1, x1) = (f64::from(driver.teeth), rack.profile_shift(driver));
    let (over_z2, x2) = match mesh.kind {
        MeshKind::SunPlanet => (1.0 / f64::from(driven.teeth), rack.profile_shift(driven)),
        MeshKind::RingPlanet => (0.0, 0.0),
    };
    let q = 0.04723 + 0.15551 / z1 + 0.25791 * over_z2
        - 0.00635 * x1
        - 0.11654 * x1 / z1
        - 0.00193 * x2
        - 0.24188 * x2 * over_z2
        + 0.00529 * x1 * x1
        + 0.00182 * x2 * x2;
    // Dedendum from the root circle: r_f = m z/2 + x m − h_f.
    let dedendum = 0.5 * rack.module * z1 + x1 * rack.module - driver.root_radius;
    let basic_rack = (1.0 + 0.5 * (1.2 - dedendum / rack.module))
        * (1.0 - 0.02 * (20.0 - rack.pressure_angle_deg));
    basic_rack / q * (0.75 * mesh.contact_ratio + 0.25)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::ToothSide;

    /// A gear without shift from a 20° rack of module 1 mm: t = π m/2, h_a = m, h_f = 1.25 m.
    fn standard(teeth: u32) -> Gear {
        let alpha = 20.0f64.to_radians();
        let r = 0.5e-3 * f64::from(teeth);
        Gear {
            teeth,
            side: ToothSide::External,
            base_radius: r * alpha.cos(),
            tip_radius: r + 1e-3,
            root_radius: r - 1.25e-3,
            body_radius: None,
            fillet_radius: 0.3e-3,
            half_angle_base: FRAC_PI_2 / f64::from(teeth) + inv(alpha),
            tip_relief: None,
        }
    }

    const RACK: BasicRack = BasicRack { module: 1e-3, pressure_angle_deg: 20.0 };

    #[test]
    fn two_standard_gears_of_twenty_teeth_by_hand() {
        let gear = standard(20);
        assert!(RACK.profile_shift(&gear).abs() < 1e-12);
        let mesh = Mesh::sun_planet(&gear, &gear, 20e-3).unwrap();
        // q' = 0.04723 + 0.15551/20 + 0.25791/20 = 0.067901; C_B = 1 + 0.5 (1.2 − 1.25) = 0.975;
        // ε_α = 2 (√(11² − 9.396926²) − 10 sin 20°)/(π cos 20°) = 1.556838.
        let by_hand = 0.975 / 0.067901 * (0.75 * 1.556838 + 0.25);
        let found = mean_mesh_stiffness(&mesh, &RACK);
        assert!((found / by_hand - 1.0).abs() < 1e-5, "{found} {by_hand}");
    }

    #[test]
    fn an_internal_gear_counts_as_a_rack() {
        let (planet, mut ring) = (standard(20), standard(60));
        (ring.side, ring.tip_radius, ring.root_radius) = (ToothSide::Internal, 29e-3, 31.25e-3);
        let mesh = Mesh::ring_planet(&ring, &planet, 20e-3).unwrap();
        // q' = 0.04723 + 0.15551/20 = 0.0550055.
        let by_hand = 0.975 / 0.0550055 * (0.75 * mesh.contact_ratio + 0.25);
        let found = mean_mesh_stiffness(&mesh, &RACK);
        assert!((found / by_hand - 1.0).abs() < 1e-9, "{found} {by_hand}");
    }

    /// A shift of 0.3 widens the tooth by 0.6 m tan α on the reference circle.
    #[test]
    fn profile_shift_is_read_off_the_tooth() {
        let mut gear = standard(25);
        gear.half_angle_base += 0.3 * 2.0 * 20.0f64.to_radians().tan() / 25.0;
        assert!((RACK.profile_shift(&gear) - 0.3).abs() < 1e-12);
    }
}
