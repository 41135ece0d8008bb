//! Faults of choices and positions that show only when several keys are seen together.

mod closing;
pub(crate) mod geometry;
pub(crate) mod load;

use gearset::{PlanetPositions, assembly};

use crate::choices::{DynamicsInput, FeContactInput, Fidelity};
use crate::keys::{KEYS, SceneKey};
use crate::read::default_fe_contact;
use crate::read::document::Document;

/// Refuses flexibility factors at every fidelity but `quasi_static`: elastic states of a body act in several
/// meshes at once and cannot be scaled for one mesh.
pub(crate) fn factors_need_quasi_static(
    document: &Document<'_>,
    fe_contact: &FeContactInput,
    dynamics: &DynamicsInput,
) {
    let factor = fe_contact.flexibility_factor;
    if dynamics.fidelity == Fidelity::QuasiStatic {
        return;
    }
    for (name, value) in [("sun_planet", factor.sun_planet), ("ring_planet", factor.ring_planet)] {
        if value != 1.0 {
            let key = format!("fe_contact.flexibility_factor.{name}");
            let why = "a planet that vibrates within itself cannot be softer for one mesh alone";
            document.fault(&key, "1, or dynamics.fidelity = \"quasi_static\"", why);
        }
    }
}

/// Refuses settings that `fidelity = "auto"` chooses. Those with their default may stand, as templates write them.
pub(crate) fn auto_chooses(
    document: &Document<'_>,
    own: &FeContactInput,
    dynamics: &DynamicsInput,
) {
    if dynamics.auto.is_none() {
        return;
    }
    let Some(default) = default_fe_contact() else { return };
    let depth = "matching depth";
    let settings = [
        ("element", own.element != default.element, "family of elements"),
        ("flank_elements", own.flank_elements != default.flank_elements, "number of elements"),
        (
            "flank_layer",
            own.flank_layer != default.flank_layer,
            "layer of elements next to the flanks",
        ),
        (
            "cell_layout_at_rest",
            own.cell_layout_at_rest != default.cell_layout_at_rest,
            "layout of contact cells at rest",
        ),
        ("contact_cells", own.contact_cells != default.contact_cells, "number of contact cells"),
        ("matching_depth_mm", own.matching_depth_m.is_some(), depth),
        ("matching_depth_elements", own.matching_depth_elements.is_some(), depth),
    ];
    for (key, _, what) in settings.into_iter().filter(|(_, is_given, _)| *is_given) {
        let path = format!("fe_contact.{key}");
        let declared = KEYS.iter().find(|declared| declared.path == path);
        let or_default = declared
            .and_then(SceneKey::default_as_written)
            .map_or(String::new(), |value| format!(", or its default {value},"));
        let allowed = format!("no value{or_default} with dynamics.fidelity = \"auto\"");
        let why = format!("the {what} is among the settings that are chosen");
        document.fault(&path, allowed, why);
    }
}

/// Refuses planets at one place.
pub(crate) fn distinct_positions(document: &Document<'_>, positions: &PlanetPositions) {
    let psi = &positions.psi_rad;
    for (p, q, chord) in assembly::planet_clearances(psi, 1.0, 0.0) {
        if chord < 1e-9 {
            let key = if document.has("planets.position_steps") {
                "planets.position_steps"
            } else {
                "planets.positions_deg"
            };
            let why = format!("planets {p} and {q} stand at the same place");
            document.fault(key, "distinct positions", why);
        }
    }
}
