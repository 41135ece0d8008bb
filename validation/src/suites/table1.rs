//! Table 1 closed on itself: one base pitch, two operating angles, one centre distance.

use gearset::{Facing, Geometry, Kinematics, Mesh, MeshKind, MeshMember, Phasing, Scene};

use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::Reference;

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let set = scene(PublishedScene::Oh58FourPlanets)?;
    let no_geometry = ValidationError::Incomplete("geometry");
    let geometry = Geometry::from_scene(&set).ok().ok_or(no_geometry)?;
    let mesh = |kind| geometry.mesh(kind).ok_or(ValidationError::Incomplete("mesh"));
    let (sp, rp) = (mesh(MeshKind::SunPlanet)?, mesh(MeshKind::RingPlanet)?);
    let (t, d) = (&reference.parker.table1, &reference.parker.derived);
    let base = |m: &Mesh, member| 2e3 * m.gear(member).base_radius;
    // The centre distance each mesh's printed angle asks for.
    let asked = |sum_mm: f64, angle_deg: f64| 0.5 * sum_mm / angle_deg.to_radians().cos();
    let (sun, planet) = (base(sp, MeshMember::Driver), base(sp, MeshMember::Driven));
    let ring = base(rp, MeshMember::Driven);
    let a_sun = asked(sun + planet, t.sun_planet_pressure_angle_deg);
    let a_ring = asked(ring - planet, t.ring_planet_pressure_angle_deg);
    let (alpha_s, alpha_r) = (sp.pressure_angle.to_degrees(), rp.pressure_angle.to_degrees());
    let frequency = mesh_frequency(&set)?;
    let (printed, derived) = (ReferenceKind::Published, ReferenceKind::OtherCode);
    #[rustfmt::skip]
    let rows = [
        ("table1.base_diameter.sun", "sun base diameter", printed, t.sun_base_diameter_mm, sun, "mm"),
        ("table1.base_diameter.ring", "ring base diameter", printed, t.ring_base_diameter_mm, ring, "mm"),
        ("table1.base_pitch", "base pitch", derived, d.base_pitch_mm, 1e3 * geometry.base_pitch, "mm"),
        ("table1.pressure_angle.sun_planet", "operating angle, sun–planet", printed, t.sun_planet_pressure_angle_deg, alpha_s, "°"),
        ("table1.pressure_angle.ring_planet", "operating angle, ring–planet", printed, t.ring_planet_pressure_angle_deg, alpha_r, "°"),
        ("table1.module.sun_planet", "operating module, sun–planet", printed, t.sun_planet_module_mm, 1e3 * sp.operating_module, "mm"),
        ("table1.module.ring_planet", "operating module, ring–planet", printed, t.ring_planet_module_mm, 1e3 * rp.operating_module, "mm"),
        ("table1.center_distance.sun_planet", "centre distance by the sun–planet angle", derived, d.center_distance_mm, a_sun, "mm"),
        ("table1.center_distance.ring_planet", "centre distance by the ring–planet angle", derived, d.center_distance_mm, a_ring, "mm"),
        ("table1.contact_ratio.sun_planet", "contact ratio, sun–planet", derived, d.contact_ratio_sun_planet, sp.contact_ratio, ""),
        ("table1.contact_ratio.ring_planet", "contact ratio, ring–planet", derived, d.contact_ratio_ring_planet, rp.contact_ratio, ""),
        ("table1.mesh_frequency", "mesh frequency at 2500 rpm", derived, d.mesh_frequency_at_2500_rpm_hz, frequency, "Hz"),
    ];
    let mut checks = Vec::new();
    for (id, title, kind, expected, actual, unit) in rows {
        let source = match kind {
            ReferenceKind::Published => reference.parker.source.clone(),
            _ => "worked out by hand from Table 1 (reference/parker_2000.toml)".into(),
        };
        let subject = Subject { id, title, kind, source: &source, unit };
        checks.push(Check::number(subject, expected, actual, reference.tolerance(id, expected)?));
    }
    let id = "table1.gamma.closure";
    let subject = Subject {
        id,
        title: "gears placed by γ and the phases touch on the loaded flanks of all meshes",
        kind: ReferenceKind::Analytic,
        source: "conjugate flanks: every loaded gap is nil, every other one the backlash",
        unit: "µm",
    };
    let worst = largest_misfit(&set, &geometry)?;
    checks.push(Check::number(subject, 0.0, 1e6 * worst, reference.tolerance(id, 0.0)?));
    Ok(checks)
}

fn mesh_frequency(set: &Scene) -> Result<f64, ValidationError> {
    let mut set = set.clone();
    let operation = set.operation.as_mut().ok_or(ValidationError::Incomplete("operation"))?;
    operation.speed_rpm = 2500.0;
    let kinematics = Kinematics::from_scene(&set).ok();
    Ok(kinematics.ok_or(ValidationError::Incomplete("kinematics"))?.mesh_frequency_hz)
}

/// Largest deviation of any normal gap from what it should be (nil on the loaded flanks, the
/// normal backlash on the others), over one sun pitch, both senses of load, m.
fn largest_misfit(set: &Scene, geometry: &Geometry) -> Result<f64, ValidationError> {
    let incomplete = || ValidationError::Incomplete("whole set of gears");
    let phasing = Phasing::new(geometry, &set.planets).ok_or_else(incomplete)?;
    let sun_pitch = geometry.sun.as_ref().ok_or_else(incomplete)?.pitch_angle();
    let mut worst = 0.0f64;
    for loaded in [Facing::CounterClockwise, Facing::Clockwise] {
        for i in 0..20 {
            let angles = phasing.gear_angles(sun_pitch * f64::from(i) / 20.0, loaded);
            for n in 0..set.planets.count() {
                for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
                    let backlash = geometry.normal_backlash(kind).ok_or_else(incomplete)?;
                    let [touching, open] = phasing.normal_gaps(&angles, n, kind, loaded);
                    worst = worst.max(touching.abs()).max((open - backlash).abs());
                }
            }
        }
    }
    Ok(worst)
}
