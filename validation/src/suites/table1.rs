//! Consistency of Table 1: one base pitch, two operating pressure angles, one centre distance.

use gearset::{Facing, Geometry, Mesh, MeshKind, MeshMember, Phasing};
use scene::{LoadCase, Scene};

use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::worst::worst;

use super::{Checks, Lab};

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let geometry = &lab.bodies.geometry;
    let mut checks = rows(lab.reference, &lab.four, geometry)?;
    checks.push(closure(lab.reference, &lab.four, geometry)?);
    let mut moved = lab.four.clone();
    moved.planets.psi_rad[1] += 1e-4;
    let spoilt = [closure(lab.reference, &moved, geometry)?];
    checks.push(lab.reference.control("table1.control.planet_moved", &spoilt)?);
    Ok(checks)
}

fn rows(reference: &Reference, set: &Scene, geometry: &Geometry) -> Checks {
    let mesh = |kind| geometry.mesh(kind).ok_or(ValidationError::Incomplete("mesh"));
    let (sp, rp) = (mesh(MeshKind::SunPlanet)?, mesh(MeshKind::RingPlanet)?);
    let (t, d) = (&reference.parker.table1, &reference.parker.derived);
    let base = |m: &Mesh, member| 2e3 * m.gear(member).base_radius;
    // The centre distance that follows from each mesh's printed pressure angle.
    let asked = |sum_mm: f64, angle_deg: f64| 0.5 * sum_mm / angle_deg.to_radians().cos();
    let (sun, planet) = (base(sp, MeshMember::Driver), base(sp, MeshMember::Driven));
    let ring = base(rp, MeshMember::Driven);
    let a_sun = asked(sun + planet, t.sun_planet_pressure_angle_deg);
    let a_ring = asked(ring - planet, t.ring_planet_pressure_angle_deg);
    let (alpha_s, alpha_r) = (sp.pressure_angle.to_degrees(), rp.pressure_angle.to_degrees());
    let frequency = mesh_frequency(set)?;
    #[rustfmt::skip]
    let rows = [
        ("table1.base_diameter.sun", "sun base diameter", true, t.sun_base_diameter_mm, sun),
        ("table1.base_diameter.ring", "ring base diameter", true, t.ring_base_diameter_mm, ring),
        ("table1.base_pitch", "base pitch", false, d.base_pitch_mm, 1e3 * geometry.base_pitch),
        ("table1.pressure_angle.sun_planet", "operating angle, sun–planet", true, t.sun_planet_pressure_angle_deg, alpha_s),
        ("table1.pressure_angle.ring_planet", "operating angle, ring–planet", true, t.ring_planet_pressure_angle_deg, alpha_r),
        ("table1.module.sun_planet", "operating module, sun–planet", true, t.sun_planet_module_mm, 1e3 * sp.operating_module),
        ("table1.module.ring_planet", "operating module, ring–planet", true, t.ring_planet_module_mm, 1e3 * rp.operating_module),
        ("table1.center_distance.sun_planet", "centre distance by the sun–planet angle", false, d.center_distance_mm, a_sun),
        ("table1.center_distance.ring_planet", "centre distance by the ring–planet angle", false, d.center_distance_mm, a_ring),
        ("table1.contact_ratio.sun_planet", "contact ratio, sun–planet", false, d.contact_ratio_sun_planet, sp.contact_ratio),
        ("table1.contact_ratio.ring_planet", "contact ratio, ring–planet", false, d.contact_ratio_ring_planet, rp.contact_ratio),
        ("table1.mesh_frequency", "mesh frequency at 2500 rpm", false, d.mesh_frequency_at_2500_rpm_hz, frequency),
    ];
    let mut checks = Vec::new();
    for (id, title, is_printed, expected, actual) in rows {
        let source = match is_printed {
            true => reference.parker.source.as_str(),
            false => "worked out by hand from Table 1 (reference/parker_2000.toml)",
        };
        checks.push(reference.about(id, title)?.source(source).number(expected, actual));
    }
    Ok(checks)
}

/// Gears placed by γ and the mesh phases touch on the loaded flanks of all meshes.
fn closure(
    reference: &Reference,
    set: &Scene,
    geometry: &Geometry,
) -> Result<Check, ValidationError> {
    let title = "gears placed by γ and the phases touch on the loaded flanks of all meshes";
    let misfit = largest_misfit(set, geometry)?;
    Ok(reference.about("table1.gamma.closure", title)?.at_most(1e6 * misfit))
}

fn mesh_frequency(set: &Scene) -> Result<f64, ValidationError> {
    Ok(LoadCase::of_scene(set)?.at_speed(2500.0).mesh_frequency_hz)
}

/// Largest deviation of any normal gap from its theoretical value (0 on the loaded flanks, the normal
/// backlash on the others), over one sun pitch, both senses of load, m.
fn largest_misfit(set: &Scene, geometry: &Geometry) -> Result<f64, ValidationError> {
    let incomplete = || ValidationError::Incomplete("whole set of gears");
    let phasing = Phasing::new(geometry, &set.planets).ok_or_else(incomplete)?;
    let sun_pitch = geometry.sun.as_ref().ok_or_else(incomplete)?.pitch_angle();
    let mut misfits = Vec::new();
    for loaded in [Facing::CounterClockwise, Facing::Clockwise] {
        for i in 0..20 {
            let angles = phasing.gear_angles(sun_pitch * f64::from(i) / 20.0, loaded);
            for n in 0..set.planets.count() {
                for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
                    let backlash = geometry.normal_backlash(kind).ok_or_else(incomplete)?;
                    let [touching, open] = phasing.normal_gaps(&angles, n, kind, loaded);
                    misfits.extend([touching, open - backlash]);
                }
            }
        }
    }
    Ok(worst(misfits))
}
