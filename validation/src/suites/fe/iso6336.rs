//! Mesh stiffness against the standard's formula for c_γ.

use gearset::{Geometry, MeshKind, MeshMember, Scene};

use super::{Lab, MESHES};
use crate::check::{Check, ReferenceKind};
use crate::error::ValidationError;

const SOURCE: &str = "ISO 6336-1:2006, clause 9, method B: c'_th, C_B, c_γ; without C_M = 0.8, which turns theory into measurement";

/// Generating rack that reproduces every diameter of Table 1: 9 DP, 22.5°.
const MODULE: f64 = 25.4e-3 / 9.0;
const RACK_ANGLE_DEG: f64 = 22.5;

/// Theoretical mean stiffness of a mesh per face width, N/(mm µm).
///
/// q' = C₁ + C₂/z₁ + C₃/z₂ + C₄x₁ + C₅x₁/z₁ + C₆x₂ + C₇x₂/z₂ + C₈x₁² + C₉x₂², c'_th = 1/q'; an
/// internal gear has z₂ = ∞ and x₂ = 0. C_B = [1 + 0.5 (1.2 − h_f/m)][1 − 0.02 (20° − α)], and
/// c_γ = c' (0.75 ε_α + 0.25).
pub(crate) fn mean_stiffness(scene: &Scene, kind: MeshKind) -> Option<f64> {
    let geometry = Geometry::from_scene(scene).ok()?;
    let mesh = geometry.mesh(kind)?;
    let alpha = RACK_ANGLE_DEG.to_radians();
    // Profile shift from the tooth's thickness: t = m (π/2 + 2 x tan α₀) on r = m z/2.
    let shift = |gear: &gearset::Gear| {
        let z = f64::from(gear.teeth);
        let angle = gear.half_angle_base - gearset::involute::inv(alpha);
        (angle * z - std::f64::consts::FRAC_PI_2) / (2.0 * alpha.tan())
    };
    let (driver, driven) = (mesh.gear(MeshMember::Driver), mesh.gear(MeshMember::Driven));
    let (z1, x1) = (f64::from(driver.teeth), shift(driver));
    let (over_z2, x2) = match kind {
        MeshKind::SunPlanet => (1.0 / f64::from(driven.teeth), shift(driven)),
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
    let dedendum = 0.5 * MODULE * z1 + x1 * MODULE - driver.root_radius;
    let basic_rack =
        (1.0 + 0.5 * (1.2 - dedendum / MODULE)) * (1.0 - 0.02 * (20.0 - RACK_ANGLE_DEG));
    Some(basic_rack / q * (0.75 * mesh.contact_ratio + 0.25))
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    for kind in MESHES {
        let expected =
            mean_stiffness(&lab.four, kind).ok_or(ValidationError::Incomplete("geometry"))?;
        let cycle = lab.pair(&lab.bodies, kind, 28)?;
        let per_width = cycle.mean_secant_stiffness() / lab.bodies.geometry.face_width * 1e-9;
        let name = kind.name();
        let id = format!("fe.iso_6336.{name}");
        let title = format!("{name} mesh: mean secant stiffness per face width against c_γ");
        let kind = ReferenceKind::Published;
        checks.push(lab.number(&id, &title, kind, SOURCE, "N/(mm µm)", expected, per_width)?);
    }
    Ok(checks)
}
