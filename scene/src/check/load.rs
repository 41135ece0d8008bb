//! Faults of the operating point that show only beside the stiffnesses.

use crate::load::estimates;
use crate::load::size::MOST_MODULES;
use crate::read::document::Document;
use crate::scene::{Scene, SceneKind};
use crate::warnings::{Warning, warnings};

/// An unlikely value on which the deflection under a load depends: it explains more than the load does.
fn slip_of_unit(document: &Document<'_>, scene: &Scene) -> Option<Warning> {
    let is_stiffness = |key: &str| key.ends_with("bearing_n_per_m") || key.contains(".torsional_");
    let decides = |key: &str| {
        matches!(key, "material.young_modulus_pa" | "geometry.face_width_mm" | MODULE)
            || is_stiffness(key)
    };
    let mut found = warnings(scene).into_iter().find(|warning| decides(&warning.key))?;
    if found.key == MODULE && !document.has(MODULE) {
        found.key = "geometry.rack.module_mm".into();
    }
    Some(found)
}

/// The key of which an unlikely module is warned.
const MODULE: &str = "geometry.center_distance_mm";

/// Refuses a torque under which the set gives way by more than a module.
pub(crate) fn deflection(document: &Document<'_>, scene: &Scene) {
    // Values at fault are replaced by defaults, from which nothing follows.
    let tables =
        ["teeth", "planets", "geometry", "material", "operation", "planet", "ring", "carrier"];
    if tables.iter().any(|table| document.is_doubtful(table)) {
        return;
    }
    let Ok(geometry) = scene.tooth_geometry() else { return };
    let Some(length) = estimates::deflection(scene, &geometry) else { return };
    let Some(module) = estimates::module(&geometry) else { return };
    if length > MOST_MODULES * module {
        if let Some(slip) = slip_of_unit(document, scene) {
            let Warning { key, what, likely, .. } = slip;
            let why = format!(
                "{what}; {likely}; by estimate the teeth give way by {:.3e} mm under the torque",
                1e3 * length
            );
            document.fault(&key, "a value with which they give way by less than the module", why);
            return;
        }
        let torque = scene.operation.map_or(0.0, |operation| operation.torque_nm.abs());
        let (or, of, and) = match scene.kind {
            SceneKind::Planetary => (
                ", or stiffer bearings",
                "meshes of E b/13, planet bearing and torsional supports in series",
                ", `planet.bearing_n_per_m`",
            ),
            SceneKind::GearPair => ("", "a mesh of E b/13", ""),
        };
        let allowed = format!("a magnitude below {:.3e} N·m{or}", torque * module / length);
        let why = format!(
            "by estimate ({of}) the teeth give way by {:.3e} mm, more than the module {:.3} mm: displacements are no longer linear in the load; look at the units of `operation.torque_nm`{and} and `material.young_modulus_pa`",
            1e3 * length,
            1e3 * module
        );
        document.fault("operation.torque_nm", allowed, why);
    }
}
