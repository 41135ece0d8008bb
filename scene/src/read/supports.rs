//! The tables `[sun]`, `[ring]`, `[carrier]` and `[planet]`.

use gearset::MeshKind;

use crate::keys::bound::Bound;
use crate::read::document::Section;
use crate::scene::*;

/// Reads the supports of all members; `kind` is `None` where the file does not say it, `mesh` is that of a gear
/// pair. Values at fault are replaced by 0; their faults are noted.
pub(crate) fn supports(
    root: &Section<'_, '_>,
    kind: Option<SceneKind>,
    mesh: Option<MeshKind>,
) -> Supports {
    if kind == Some(SceneKind::GearPair) {
        return pair_supports(root, mesh);
    }
    let free =
        Support { motion: Freedom::Free, bearing: 0.0, torsional: Torsional::PerLength(0.0) };
    let central = |key: &'static str| match root.section(key) {
        Some(s) => {
            let found = support(&s, false, Bound::NonNegative);
            s.finish();
            found
        }
        None => free,
    };
    let (carrier, ring, sun) = (central("carrier"), central("ring"), central("sun"));
    let mut planet_added = AddedMass::default();
    let mut planet_bearing = 0.0;
    match root.section("planet") {
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
    Supports { carrier, ring, sun, planet_bearing, planet_added, pair: None }
}

/// Supports of the two gears of a pair. Where no bearing stiffness is given, bearings are rigid.
fn pair_supports(root: &Section<'_, '_>, mesh: Option<MeshKind>) -> Supports {
    for key in ["carrier", "ring"] {
        if root.section(key).is_some() {
            root.fault(key, "nothing here", "the bearings of a gear pair stand on the ground");
        }
    }
    let rigid = Support { motion: Freedom::CentreHeld, ..Support::HELD };
    let gear = |key: &'static str| match root.section(key) {
        Some(_) if mesh == Some(MeshKind::RingPlanet) => {
            let why = "only a sun–planet pair is computed in time; at rest its bores are rigid";
            root.fault(key, "nothing here", why);
            (rigid, GivenInertia::default())
        }
        Some(s) => {
            // The planet of a set has a bearing in any case, so that its key allows no 0.
            let bound = if key == "planet" { Bound::Positive } else { Bound::NonNegative };
            let found = support(&s, true, bound);
            let value = |key, why| s.number(key, Bound::Positive, why);
            let given = GivenInertia {
                mass_kg: value("mass_kg", "mass of the gear with its shaft"),
                inertia_kg_m2: value("inertia_kg_m2", "polar inertia of the gear with its shaft"),
            };
            for key in ["added_mass_kg", "added_inertia_kg_m2"] {
                if key_of_sets(&s, key) {
                    let why = "mass_kg and inertia_kg_m2 of a pair's gear include its shaft";
                    s.fault(key, "nothing here", why);
                }
            }
            s.finish();
            (found, given)
        }
        None => (rigid, GivenInertia::default()),
    };
    let ((sun, sun_inertia), (planet, planet_inertia)) = (gear("sun"), gear("planet"));
    Supports {
        carrier: Support::HELD,
        ring: Support::HELD,
        sun,
        planet_bearing: 0.0,
        planet_added: AddedMass::default(),
        pair: Some(PairSupports { planet, sun_inertia, planet_inertia }),
    }
}

/// Whether a key that only sets have is there; it is then known.
fn key_of_sets(s: &Section<'_, '_>, key: &'static str) -> bool {
    let is_there = s.has(key);
    if is_there {
        s.skip(key);
    }
    is_there
}

/// Support of a member. Without a bearing a gear of a pair has its centre held, and a member of a set floats.
fn support(s: &Section<'_, '_>, is_pair: bool, bound: Bound) -> Support {
    let motions = [
        ("free", Freedom::Free),
        ("rotation_held", Freedom::RotationHeld),
        ("held", Freedom::Held),
    ];
    let motion = s.choice("motion", &motions, "which coordinates the member has");
    let motion = motion.unwrap_or(Freedom::Free);
    let why = "stiffness to ground, equal in both directions";
    let bearing = s.number("bearing_n_per_m", bound, why);
    if is_pair && bearing == Some(0.0) {
        let why = "a gear of a pair is held by nothing else; leave it out for a rigid bearing";
        s.fault("bearing_n_per_m", "a number above 0, or nothing", why);
    }
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
    let torsional = match (per_length, per_angle) {
        (_, Some(k)) => Torsional::PerAngle(k),
        (k, None) => Torsional::PerLength(k.unwrap_or(0.0)),
    };
    let motion = match motion {
        Freedom::Free if is_pair && bearing.is_none() => Freedom::CentreHeld,
        Freedom::RotationHeld if is_pair && bearing.is_none() => Freedom::Held,
        motion => motion,
    };
    Support { motion, bearing: bearing.unwrap_or(0.0), torsional }
}
