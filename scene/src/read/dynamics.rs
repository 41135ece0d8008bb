//! The `[dynamics]` table.

use crate::choices::{
    AutoInput, AutoModeType, AutoQuantity, AutoResponse, DynamicsInput, Fidelity, MeshKinematics,
};
use crate::keys::bound::Bound;
use crate::read::document::Section;

/// Fidelities by name; the number of modes has a key of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Name {
    MeshLaw,
    QuasiStatic,
    Modal,
    Full,
    Auto,
}

/// Quantities by name; some have keys of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    NaturalFrequency,
    TransmissionError,
    MeanTransmissionError,
    Amplitude,
}

const QUANTITIES: [(&str, Quantity); 4] = [
    ("natural_frequency", Quantity::NaturalFrequency),
    ("transmission_error", Quantity::TransmissionError),
    ("mean_transmission_error", Quantity::MeanTransmissionError),
    ("amplitude", Quantity::Amplitude),
];

/// Keys that say what `fidelity = "auto"` is to choose for, the quantity that alone has each, and what is allowed.
const AUTO_KEYS: [(&str, Option<Quantity>, &str); 5] = [
    (
        "quantity",
        None,
        "\"natural_frequency\", \"transmission_error\", \"mean_transmission_error\", \"amplitude\"",
    ),
    (
        "mode_type",
        Some(Quantity::NaturalFrequency),
        "\"rotational\", \"translational\", \"planet\"",
    ),
    ("mode_number", Some(Quantity::NaturalFrequency), "a whole number from 1 to 1000"),
    ("response", Some(Quantity::Amplitude), "\"transmission_error\", \"sun_translation\""),
    ("tolerance_percent", None, "a number between 0 and 100"),
];

/// What settings are to be chosen for: with `fidelity = "auto"` the keys of its quantity, none with any other.
fn auto(s: &Section<'_, '_>, is_auto: bool, is_known: bool) -> Option<AutoInput> {
    let quantity = s.choice("quantity", &QUANTITIES, "what is to be accurate");
    let types = [
        ("rotational", AutoModeType::Rotational),
        ("translational", AutoModeType::Translational),
        ("planet", AutoModeType::Planet),
    ];
    let mode_type = s.choice("mode_type", &types, "type of the mode");
    let number = s.integer("mode_number", (1, 1000), "number of the mode among those of its type");
    let responses = [
        ("transmission_error", AutoResponse::TransmissionError),
        ("sun_translation", AutoResponse::SunTranslation),
    ];
    let response = s.choice("response", &responses, "motion whose amplitude is asked for");
    let why = "largest error of the quantity that is allowed";
    let tolerance = s.number("tolerance_percent", Bound::Between(0.0, 100.0), why);
    for (key, of, allowed) in AUTO_KEYS.into_iter().filter(|_| is_known) {
        let is_of = of.is_none() || of == quantity;
        if is_auto && is_of && !s.may_hold(key) {
            let why = "fidelity = \"auto\" chooses the settings for one quantity and tolerance";
            s.fault(key, allowed, why);
        } else if !is_auto && s.has(key) {
            s.fault(key, "with fidelity = \"auto\"", "no other fidelity is chosen for a quantity");
        } else if let (false, Some(_), true) = (is_of, quantity, s.has(key)) {
            let own = QUANTITIES.iter().find(|(_, q)| Some(*q) == of);
            let name = own.map_or("", |(name, _)| *name);
            s.fault(key, format!("with quantity = \"{name}\""), "no other quantity has it");
        }
    }
    if is_auto && quantity == Some(Quantity::Amplitude) && s.has("steps_per_cycle") {
        let why = "the number of steps is among the settings that are chosen for an amplitude";
        s.fault("steps_per_cycle", "no value with quantity = \"amplitude\"", why);
    }
    let quantity = match quantity? {
        Quantity::NaturalFrequency => {
            AutoQuantity::NaturalFrequency { mode_type: mode_type?, number: number? as u32 }
        }
        Quantity::TransmissionError => AutoQuantity::TransmissionError,
        Quantity::MeanTransmissionError => AutoQuantity::MeanTransmissionError,
        Quantity::Amplitude => AutoQuantity::Amplitude { response: response? },
    };
    is_auto.then_some(AutoInput { quantity, tolerance_percent: tolerance? })
}

pub(crate) fn dynamics(s: Section<'_, '_>) -> DynamicsInput {
    let default = DynamicsInput::default();
    let names = [
        ("mesh_law", Name::MeshLaw),
        ("quasi_static", Name::QuasiStatic),
        ("modal", Name::Modal),
        ("full", Name::Full),
        ("auto", Name::Auto),
    ];
    let name = s.choice("fidelity", &names, "what stands behind the teeth");
    let modes = s.integer("modes", (1, 400), "modes of each body with its race held");
    let is_known = !s.is_doubtful("fidelity");
    if modes.is_some() && name != Some(Name::Modal) && is_known {
        s.fault("modes", "with fidelity = \"modal\"", "no other fidelity takes a number of modes");
    }
    let auto = auto(&s, name == Some(Name::Auto), is_known);
    if name == Some(Name::Modal) && !s.may_hold("modes") {
        s.fault("modes", "a whole number from 1 to 400", "fidelity = \"modal\" needs it");
    }
    // Fewer than 16 steps do not resolve the changing number of pairs in a mesh cycle.
    let steps = s.integer("steps_per_cycle", (16, 100_000), "time steps in a mesh cycle");
    let switch = [("off", false), ("on", true)];
    let gyroscopic = s.choice("gyroscopic", &switch, "terms of the turning carrier frame");
    let ways = [("about_mean", MeshKinematics::AboutMean), ("exact", MeshKinematics::Exact)];
    let kinematics = s.choice("kinematics", &ways, "how meshes follow the displaced gears");
    if kinematics == Some(MeshKinematics::Exact) && !matches!(name, None | Some(Name::QuasiStatic))
    {
        s.fault(
            "kinematics",
            "\"about_mean\" on this fidelity",
            "only quasi-static bodies follow exactly",
        );
    }
    s.finish();
    let fidelity = match (name, modes) {
        (Some(Name::MeshLaw), _) => Fidelity::MeshLaw,
        (Some(Name::Full), _) => Fidelity::Full,
        (Some(Name::Modal), Some(n)) => Fidelity::Modal(n as u32),
        _ => Fidelity::QuasiStatic,
    };
    DynamicsInput {
        fidelity,
        steps_per_cycle: steps.map_or(default.steps_per_cycle, |n| n as u32),
        gyroscopic: gyroscopic.unwrap_or(default.gyroscopic),
        kinematics: kinematics.unwrap_or(default.kinematics),
        auto,
    }
}
