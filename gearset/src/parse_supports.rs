//! The tables `[sun]`, `[ring]`, `[carrier]` and `[planet]`.

use crate::bound::Bound;
use crate::reader::Section;
use crate::scene::*;

/// Reads the supports of all members; `kind` is `None` where the file does not say it. Values at fault are
/// replaced by 0; their faults are noted.
pub(crate) fn supports(root: &Section<'_, '_>, kind: Option<SceneKind>) -> Supports {
    let is_pair = kind == Some(SceneKind::GearPair);
    let free =
        Support { motion: Freedom::Free, bearing: 0.0, torsional: Torsional::PerLength(0.0) };
    let central = |key: &'static str| match root.section(key) {
        Some(_) if is_pair => {
            root.fault(key, "nothing here", "races of a gear pair are rigid");
            free
        }
        Some(s) => support(s),
        None => free,
    };
    let (carrier, ring, sun) = (central("carrier"), central("ring"), central("sun"));
    let mut planet_added = AddedMass::default();
    let mut planet_bearing = 0.0;
    match root.section("planet") {
        Some(_) if is_pair => {
            root.fault("planet", "nothing here", "races of a gear pair are rigid");
        }
        Some(s) => {
            let why = "stiffness between planet and carrier, equal in both directions";
            planet_bearing = s.required("bearing_n_per_m", Bound::Positive, why).unwrap_or(0.0);
            let added = |key, why| s.number(key, Bound::NonNegative, why).unwrap_or(0.0);
            planet_added = AddedMass {
                mass_kg: added("added_mass_kg", "mass fixed to each planet's race"),
                inertia_kg_m2: added("added_inertia_kg_m2", "its polar inertia"),
            };
            s.finish();
        }
        None if kind == Some(SceneKind::Planetary) && !root.has("planet") => {
            let why = "every planet runs on a bearing on the carrier";
            root.fault("planet", "[planet] with bearing_n_per_m", why);
        }
        None => {}
    }
    Supports { carrier, ring, sun, planet_bearing, planet_added }
}

fn support(s: Section<'_, '_>) -> Support {
    let motions = [
        ("free", Freedom::Free),
        ("rotation_held", Freedom::RotationHeld),
        ("held", Freedom::Held),
    ];
    let motion = s.choice("motion", &motions, "which coordinates the member has");
    let motion = motion.unwrap_or(Freedom::Free);
    let why = "stiffness to ground, equal in both directions";
    let bearing = s.number("bearing_n_per_m", Bound::NonNegative, why);
    let per_length = s.number(
        "torsional_n_per_m",
        Bound::NonNegative,
        "torsional stiffness to ground per u = r·θ",
    );
    let why = "torsional stiffness to ground per θ";
    let per_angle = s.number("torsional_nm_per_rad", Bound::NonNegative, why);
    if s.has("torsional_n_per_m") && s.has("torsional_nm_per_rad") {
        let allowed = "one of torsional_n_per_m and torsional_nm_per_rad";
        s.fault("torsional_nm_per_rad", allowed, "both say the same");
    }
    let idle = |key: &str, why: &str| {
        if s.has(key) {
            s.fault(key, "nothing here", why);
        }
    };
    if motion != Freedom::Free {
        idle("torsional_n_per_m", "a held rotation has no torsional spring");
        idle("torsional_nm_per_rad", "a held rotation has no torsional spring");
    }
    if motion == Freedom::Held {
        idle("bearing_n_per_m", "a held member has no bearing that could yield");
    }
    s.finish();
    let torsional = match (per_length, per_angle) {
        (_, Some(k)) => Torsional::PerAngle(k),
        (k, None) => Torsional::PerLength(k.unwrap_or(0.0)),
    };
    Support { motion, bearing: bearing.unwrap_or(0.0), torsional }
}
