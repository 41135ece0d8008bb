//! Choices of the numerics that are allowed and cost more accuracy than their place in a scene shows.

use std::f64::consts::TAU;

use gearset::{Geometry, Symmetry};

use crate::choices::{AutoQuantity, ElementFamily};
use crate::keys::{KEYS, SceneKey};
use crate::scene::Scene;
use crate::warnings::Warning;

/// Its default is nobody's choice and warned of by no verb.
const STEPS: &str = "dynamics.steps_per_cycle";

/// Largest difference from a whole number of phases that count as equal, cycles.
const EQUAL: f64 = 1e-9;

/// Those of a valid scene.
pub(crate) fn numerics(scene: &Scene, geometry: Option<&Geometry>) -> Vec<Warning> {
    let mut found = Vec::new();
    if scene.fe_contact.element == ElementFamily::Linear {
        found.push(Warning {
            key: "fe_contact.element".into(),
            value: "\"linear\"".into(),
            what: "bilinear elements lock in bending: about half too stiff where they are square, more where they are longer".into(),
            likely: "\"quadratic\" costs about as much and does not".into(),
        });
    }
    let quantity = scene.dynamics.auto.map(|auto| auto.quantity);
    if matches!(quantity, Some(AutoQuantity::Amplitude { .. })) {
        // The number of steps is chosen, a multiple of these parts among others.
        return found;
    }
    let steps = scene.dynamics.steps_per_cycle;
    let is_default =
        |key: &&SceneKey| key.path == STEPS && key.default() == Some(steps.to_string().as_str());
    if KEYS.iter().any(|key| is_default(&key)) {
        return found;
    }
    let parts = geometry.and_then(|g| phased_parts(scene, g)).unwrap_or(1);
    if !(steps as usize).is_multiple_of(parts) {
        found.push(Warning {
            key: STEPS.into(),
            value: steps.to_string(),
            what: format!(
                "the set is itself again, with its planets renumbered, after 1/{parts} of a mesh cycle, which is no whole number \
                 of steps: harmonics that planet phasing cancels will not vanish"
            ),
            likely: format!("take a multiple of {parts}"),
        });
    }
    found
}

/// Into how many equal parts, after which another planet meshes as this one did, phasing divides the mesh cycle: the
/// largest denominator of Z_s (ψ_(n+s) − ψ_n)/2π among the shifts s that leave the planets' places as they are.
fn phased_parts(scene: &Scene, geometry: &Geometry) -> Option<usize> {
    let teeth = f64::from(geometry.sun.as_ref()?.teeth);
    geometry.ring.as_ref()?;
    let psi = &scene.planets.psi_rad;
    // Every number of parts up to the number of planets fits this many steps.
    let any: usize = (2..=psi.len()).product();
    let parts = |own: Symmetry| {
        let phase = teeth * own.angle_rad / TAU;
        (1..=psi.len()).find(|q| {
            let times = *q as f64 * phase;
            (times - times.round()).abs() < EQUAL
        })
    };
    Symmetry::candidates(psi, any).into_iter().filter_map(parts).max()
}
