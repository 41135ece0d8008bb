//! Faults of choices and positions that show only when several keys are seen together.

pub(crate) mod geometry;
pub(crate) mod load;

use gearset::{PlanetPositions, assembly};

use crate::choices::{DynamicsInput, FeContactInput, Fidelity};
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
    let default = FeContactInput::default();
    let settings = [
        (
            "element",
            own.element != default.element,
            "\"quadratic\"".to_owned(),
            "family of elements",
        ),
        (
            "flank_elements",
            own.flank_elements != default.flank_elements,
            default.flank_elements.to_string(),
            "number of elements",
        ),
        (
            "flank_layer",
            own.flank_layer != default.flank_layer,
            "\"whole\"".to_owned(),
            "layer of elements next to the flanks",
        ),
        (
            "cell_layout_at_rest",
            own.cell_layout_at_rest != default.cell_layout_at_rest,
            "\"even\"".to_owned(),
            "layout of contact cells at rest",
        ),
        (
            "contact_cells",
            own.contact_cells != default.contact_cells,
            default.contact_cells.to_string(),
            "number of contact cells",
        ),
        ("matching_depth_mm", own.matching_depth.is_some(), String::new(), "matching depth"),
        (
            "matching_depth_elements",
            own.matching_depth_elements.is_some(),
            String::new(),
            "matching depth",
        ),
    ];
    for (key, _, default, what) in settings.into_iter().filter(|(_, is_given, ..)| *is_given) {
        let allowed = match default.as_str() {
            "" => "no value with dynamics.fidelity = \"auto\"".to_owned(),
            value => format!("no value, or its default {value}, with dynamics.fidelity = \"auto\""),
        };
        let why = format!("the {what} is among the settings that are chosen");
        document.fault(&format!("fe_contact.{key}"), allowed, why);
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
