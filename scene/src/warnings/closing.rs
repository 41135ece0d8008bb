//! Backlash and numbers of teeth that do not belong together.

use gearset::{Geometry, MeshKind, MeshMember, ShiftedMesh, ThicknessInput};

use crate::scene::Scene;
use crate::warnings::{Found, Warning, shown};

/// Backlash over the module: gears have 0.02 to 0.1.
pub(crate) const LARGE_BACKLASH: f64 = 0.15;
/// Teeth of the ring, more or less, that profile shifts make up for.
const SHIFTED_TEETH: u32 = 2;
/// Missing bottom clearance, m, that rounding in the computer does not make.
const CLEARANCE: f64 = 1e-9;

/// A ring's shift that leaves unusual backlash in this sign, and a usual one in the other; lengths in m.
pub(crate) fn sign_warning(value: String, this: f64, other: f64, module: f64) -> Warning {
    Warning {
        key: "geometry.thickness.profile_shift.ring".into(),
        value,
        what: format!(
            "it leaves the ring_planet mesh backlash {} mm, {:.3} of the module, where the other sign would leave {} mm",
            signed_mm(this),
            this / module,
            signed_mm(other)
        ),
        likely: "likely it has the other sign: `ring_sign` says which, \"outward\" (the default) or \"iso_21771\"".into(),
    }
}

/// A length (m) in mm with as many decimals as show it: −0.0005, 0.00002.
pub(crate) fn signed_mm(length: f64) -> String {
    let decimals = (-(1e3 * length).abs().log10()).ceil().clamp(4.0, 7.0) as usize;
    format!("{:.decimals$}", 1e3 * length).replace('-', "−")
}

/// Backlash of more than a few hundredths of a module.
pub(super) fn backlash(scene: &Scene, geometry: &Geometry, found: &mut Found) {
    let Some(input) = &scene.geometry else { return };
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let (Some(mesh), Some(backlash)) = (geometry.mesh(kind), geometry.backlash(kind)) else {
            continue;
        };
        let module = input.rack.map_or(mesh.operating_module, |rack| rack.module_m);
        if backlash <= LARGE_BACKLASH * module {
            continue;
        }
        let what = |of: &str| {
            format!(
                "{of} {} mm, {} of the module, where gears have 0.02 to 0.1",
                shown(1e3 * backlash),
                shown(backlash / module)
            )
        };
        let shifted = input.rack.zip(scene.teeth).and_then(|(rack, teeth)| {
            let a = input.center_distance_m;
            ShiftedMesh::new(kind, &teeth, rack, a, &input.thickness)
        });
        if let (ThicknessInput::ProfileShift { ring, .. }, Some(mesh), MeshKind::RingPlanet) =
            (input.thickness, shifted, kind)
            && let Some(this) = mesh.backlash()
            && let Some(other) = mesh.with_shift_sum(mesh.shift_sum - 2.0 * ring).backlash()
            && ring != 0.0
            && other.abs() <= LARGE_BACKLASH * module
        {
            found.0.push(sign_warning(shown(ring), this, other, module));
            continue;
        }
        match (input.thickness, shifted.and_then(|mesh| mesh.closing_distance())) {
            (ThicknessInput::ProfileShift { .. }, Some(a)) => {
                let likely = format!(
                    "likely distance or shifts belong to another set: with these shifts the mesh has none at {} mm",
                    shown(1e3 * a)
                );
                let key = "geometry.center_distance_mm";
                let what =
                    what(&format!("with the shifts given the {} mesh has backlash", kind.name()));
                found.add(key, 1e3 * geometry.center_distance, what, &likely);
            }
            _ => {
                let key = format!("geometry.thickness.{}_backlash_mm", kind.name());
                let likely = "likely it is in another unit, or a diameter's";
                found.add(key, 1e3 * backlash, what("a backlash of"), likely);
            }
        }
    }
}

/// Tips that reach the mating root circle by no more than the rounding of the printed diameters: more is a fault.
pub(super) fn bottom_clearance(geometry: &Geometry, found: &mut Found) {
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let Some(mesh) = geometry.mesh(kind) else { continue };
        let names = match kind {
            MeshKind::SunPlanet => ["sun", "planet"],
            MeshKind::RingPlanet => ["planet", "ring"],
        };
        let members = [MeshMember::Driver, MeshMember::Driven];
        for (member, name, mate) in
            [(members[0], names[0], names[1]), (members[1], names[1], names[0])]
        {
            let missing = -mesh.root_clearance(member);
            if missing > CLEARANCE {
                let key = format!("geometry.{name}.tip_diameter_mm");
                let what = format!(
                    "in the {} mesh it lies {} mm beyond the {mate}'s root circle, within the rounding of the diameters",
                    kind.name(),
                    shown(1e3 * missing)
                );
                let likely = "likely bottom clearance was left out: gears have 0.2 to 0.4 modules";
                found.add(key, 2e3 * mesh.gear(member).tip_radius, what, likely);
            }
        }
    }
}

/// Numbers of teeth that close only with profile shifts, of which a set without geometry has none.
pub(super) fn ring_teeth(scene: &Scene, found: &mut Found) {
    let Some(teeth) = scene.teeth.filter(|_| scene.geometry.is_none()) else { return };
    let Some((sun, ring)) = teeth.sun_ring() else { return };
    let closing = sun + 2 * teeth.planet;
    if ring.abs_diff(closing) > SHIFTED_TEETH {
        let what = format!("without profile shifts Z_r = Z_s + 2 Z_p = {closing}");
        let likely = "shifts make up for a tooth or two, seldom for more; likely a slip in one of the numbers of teeth";
        found.add("teeth.ring", f64::from(ring), what, likely);
    }
}
