//! Parameters of the lumped model that contradict the geometry or another key of the same scene.

use gearset::{Geometry, MeshKind};

use crate::load::estimates::estimated_mesh_stiffness;
use crate::read::lumped::radii;
use crate::scene::{GivenInertia, LumpedInput, Scene, SceneKind};
use crate::warnings::{Found, STIFF_MESH, is_outside, shown};

/// Part by which a radius may differ from that of the geometry: printed tables round to three digits.
const RADIUS: f64 = 5e-3;
/// Difference of pressure angles, °, that changes tan α by 1 % at 20°.
const ANGLE_DEG: f64 = 0.2;
/// Factor of a mesh stiffness on c_γ of ISO 6336-1 in either direction: webs, width of contact and profile shifts
/// change it by less, a slip of unit by more. Teeth stiffer than [`STIFF_MESH`] times the estimate are meant to be
/// rigid.
const MESH_FACTOR: f64 = 4.0;
/// Part by which two keys for the mass of one gear may differ.
const SAME: f64 = 1e-2;

pub(super) fn contradictions(scene: &Scene, geometry: &Geometry, found: &mut Found) {
    let Some(lumped) = &scene.lumped else { return };
    lengths(scene, lumped, geometry, found);
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let Some(mesh) = geometry.mesh(kind) else { continue };
        if scene.kind == SceneKind::GearPair && kind == MeshKind::RingPlanet {
            continue;
        }
        let (given, name) = (lumped.pressure_angle_rad.of(kind).to_degrees(), kind.name());
        let operating = mesh.pressure_angle.to_degrees();
        if (given - operating).abs() > ANGLE_DEG {
            let what = format!(
                "centre distance and base circles of [geometry] make {}°",
                shown(operating)
            );
            let key = format!("lumped.pressure_angle_deg.{name}");
            let likely = "likely it is the nominal angle of the rack, where the operating one is meant: leave it out";
            found.add(key, given, what, likely);
        }
        let k = lumped.mesh_n_per_m.of(kind);
        if let Some(estimate) = estimated_mesh_stiffness(scene, mesh)
            && is_outside([estimate / MESH_FACTOR, estimate * MESH_FACTOR], k)
            && k < STIFF_MESH * estimate
        {
            let what = format!(
                "teeth of this face width and contact ratio have about {} N/m (ISO 6336-1)",
                shown(estimate)
            );
            let likely = "likely it is in N/mm or N/µm, per width, or of a set of another size";
            found.add(format!("lumped.mesh_n_per_m.{name}"), k, what, likely);
        }
    }
    same_gears(scene, lumped, found);
}

/// r of u = r·θ, which reduces inertias and torsional stiffnesses per angle, against the base radii and the centre
/// distance.
fn lengths(scene: &Scene, lumped: &LumpedInput, geometry: &Geometry, found: &mut Found) {
    let rack = scene.geometry.as_ref().and_then(|g| g.rack).zip(scene.teeth);
    let reference = rack.map(|(rack, teeth)| {
        let half = |z: u32| 0.5 * rack.module_m * f64::from(z);
        [
            ("sun", teeth.sun.map(half)),
            ("planet", Some(half(teeth.planet))),
            ("ring", teeth.ring.map(half)),
        ]
    });
    let meant = radii(geometry).by_name();
    for ((name, given), (_, meant)) in lumped.radius_m.by_name().into_iter().zip(meant) {
        let (Some(given), Some(meant)) = (given, meant) else { continue };
        if (given / meant - 1.0).abs() <= RADIUS {
            continue;
        }
        let is_reference = reference
            .iter()
            .flatten()
            .any(|(body, r)| *body == name && r.is_some_and(|r| (given / r - 1.0).abs() <= RADIUS));
        let is_diameter = (0.5 * given / meant - 1.0).abs() <= RADIUS;
        let (whose, likely) = match name {
            _ if is_diameter => ("", "likely it is a diameter"),
            "carrier" => (
                "the centre distance",
                "likely one of the two is of another set; frequencies of rotations go with both: leave the radius out",
            ),
            _ if is_reference => (
                "the base radius",
                "likely it is the reference radius m Z/2, where meshes act at the base radius: leave it out",
            ),
            _ => ("the base radius", "likely it is another circle or set: leave it out"),
        };
        let whose = if whose.is_empty() { "r" } else { whose };
        let what = format!("{whose} that [geometry] gives is {} mm", shown(1e3 * meant));
        found.add(format!("lumped.radius_mm.{name}"), 1e3 * given, what, likely);
    }
}

/// Mass and inertia of a pair's gears with their shafts, which FE/contact and the lumped model have by keys of
/// their own.
fn same_gears(scene: &Scene, lumped: &LumpedInput, found: &mut Found) {
    let Some(pair) = &scene.supports.pair else { return };
    let gears = [
        (
            "sun",
            pair.sun_inertia,
            lumped.mass_kg.sun,
            lumped.inertia_over_r2_kg.sun,
            lumped.radius_m.sun,
        ),
        (
            "planet",
            pair.planet_inertia,
            lumped.mass_kg.planet,
            lumped.inertia_over_r2_kg.planet,
            lumped.radius_m.planet,
        ),
    ];
    for (name, GivenInertia { mass_kg, inertia_kg_m2 }, mass, over_r2, radius) in gears {
        let inertia = over_r2.zip(radius).map(|(i, r)| i * r * r);
        for (key, one, other) in
            [("mass_kg", mass_kg, mass), ("inertia_kg_m2", inertia_kg_m2, inertia)]
        {
            if let (Some(one), Some(other)) = (one, other)
                && (one / other - 1.0).abs() > SAME
            {
                let what = format!("`lumped.{key}.{name}` is {}, for the same gear", shown(other));
                let likely = "modes and compare take the one in [lumped], impulse, sweep and branches this one";
                found.add(format!("{name}.{key}"), one, what, likely);
            }
        }
    }
}
