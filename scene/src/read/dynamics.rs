//! The `[dynamics]` table.

use crate::choices::{AutoInput, AutoQuantity, DynamicsInput, Fidelity, MeshKinematics};
use crate::read::document::Section;

/// Keys that say what `fidelity = "auto"` is to choose for, and the quantity that alone has each.
const AUTO_KEYS: [(&str, Option<&str>); 5] = [
    ("quantity", None),
    ("mode_type", Some("natural_frequency")),
    ("mode_number", Some("natural_frequency")),
    ("response", Some("amplitude")),
    ("tolerance_percent", None),
];

/// What settings are to be chosen for: with `fidelity = "auto"` the keys of its quantity, none with any other.
fn auto(s: &Section<'_, '_>, is_auto: bool, is_known: bool) -> Option<AutoInput> {
    let quantity = s.word("quantity");
    let (mode_type, number) = (s.choice("mode_type"), s.integer("mode_number"));
    let (response, tolerance) = (s.choice("response"), s.optional("tolerance_percent"));
    for (key, of) in AUTO_KEYS.into_iter().filter(|_| is_known) {
        let is_asked = of.is_none() || of == quantity;
        if is_auto && is_asked && !s.may_hold(key) {
            s.demand_because(
                key,
                "fidelity = \"auto\" chooses the settings for one quantity and tolerance",
            );
        } else if !is_auto && s.has(key) {
            s.fault(key, "with fidelity = \"auto\"", "no other fidelity is chosen for a quantity");
        } else if let (Some(of), Some(_), false) = (of, quantity, is_asked)
            && s.has(key)
        {
            s.fault(key, format!("with quantity = \"{of}\""), "no other quantity has it");
        }
    }
    if is_auto && quantity == Some("amplitude") && s.has("steps_per_cycle") {
        let why = "the number of steps is among the settings that are chosen for an amplitude";
        s.fault("steps_per_cycle", "no value with quantity = \"amplitude\"", why);
    }
    let quantity = match quantity? {
        "natural_frequency" => {
            AutoQuantity::NaturalFrequency { mode_type: mode_type?, number: number? }
        }
        "transmission_error" => AutoQuantity::TransmissionError,
        "mean_transmission_error" => AutoQuantity::MeanTransmissionError,
        _ => AutoQuantity::Amplitude { response: response? },
    };
    is_auto.then_some(AutoInput { quantity, tolerance_percent: tolerance? })
}

pub(crate) fn dynamics(s: &Section<'_, '_>) -> Option<DynamicsInput> {
    let name = s.word("fidelity")?;
    let modes = s.integer("modes");
    let is_known = !s.is_doubtful("fidelity");
    if modes.is_some() && name != "modal" && is_known {
        s.fault("modes", "with fidelity = \"modal\"", "no other fidelity takes a number of modes");
    }
    let auto = auto(s, name == "auto", is_known);
    if name == "modal" {
        s.demand_because("modes", "fidelity = \"modal\" needs it");
    }
    let kinematics = s.choice("kinematics")?;
    if kinematics == MeshKinematics::Exact && name != "quasi_static" {
        let allowed = "\"about_mean\" on this fidelity";
        s.fault("kinematics", allowed, "only quasi-static bodies follow exactly");
    }
    let fidelity = match (name, modes) {
        ("mesh_law", _) => Fidelity::MeshLaw,
        ("full", _) => Fidelity::Full,
        ("modal", Some(modes)) => Fidelity::Modal(modes),
        _ => Fidelity::QuasiStatic,
    };
    Some(DynamicsInput {
        fidelity,
        steps_per_cycle: s.integer("steps_per_cycle")?,
        gyroscopic: s.word("gyroscopic")? == "on",
        kinematics,
        auto,
    })
}
