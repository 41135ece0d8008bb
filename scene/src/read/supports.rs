//! The tables `[sun]`, `[ring]`, `[carrier]` and `[planet]`.

use gearset::{Member, MeshKind, Operation};

use crate::read::document::Section;
use crate::scene::*;
use crate::warnings::shown;

/// Reads the supports of all members; `kind` is `None` where the file does not say it, `mesh` is that of a gear
/// pair, `pair_stiffness` (N/m) that of a pair of teeth where the geometry gives it.
///
/// Where `[planet]` is left out its bearing is as stiff as a pair of teeth, and of ring, carrier and sun those are held
/// whose tables are left out, but for the member on which the torque acts.
pub(crate) fn supports(
    root: &Section<'_, '_>,
    kind: Option<SceneKind>,
    mesh: Option<MeshKind>,
    pair_stiffness: Option<f64>,
    operation: Option<Operation>,
) -> Supports {
    if kind == Some(SceneKind::GearPair) {
        return pair_supports(root, mesh);
    }
    let central = |key| support(&root.table(key), false);
    let (mut carrier, mut ring, mut sun) = (central("carrier"), central("ring"), central("sun"));
    let chosen = pair_stiffness.filter(|_| {
        kind == Some(SceneKind::Planetary) && !root.may_hold("planet") && !root.document.is_exact
    });
    if let Some(stiffness) = chosen {
        root.choose(
            "planet.bearing_n_per_m",
            shown(stiffness),
            "as stiff as a pair of teeth, E b/13",
        );
        let loaded = loaded(operation);
        for (member, key, support) in [
            (Member::Sun, "sun", &mut sun),
            (Member::Ring, "ring", &mut ring),
            (Member::Carrier, "carrier", &mut carrier),
        ] {
            if member != loaded && !root.may_hold(key) {
                *support = Support::HELD;
                let why = format!("the torque acts on the {}", loaded.name());
                root.choose(&format!("{key}.motion"), "\"held\"".into(), &why);
            }
        }
    } else if kind == Some(SceneKind::Planetary)
        && !root.has("planet")
        && !(root.may_hold("geometry") && root.is_doubtful("geometry"))
    {
        let why = "every planet runs on a bearing on the carrier";
        root.fault("planet", "[planet] with bearing_n_per_m", why);
    }
    let s = root.table("planet");
    if root.has_table("planet") {
        s.demand("bearing_n_per_m");
    }
    let planet_added = AddedMass {
        mass_kg: s.number("added_mass_kg"),
        inertia_kg_m2: s.number("added_inertia_kg_m2"),
    };
    let planet_bearing = chosen.unwrap_or_else(|| s.number("bearing_n_per_m"));
    Supports {
        carrier,
        ring,
        sun,
        planet_bearing_n_per_m: planet_bearing,
        planet_added,
        pair: None,
    }
}

/// Member that is left free for the torque: the driven one or, in place of the carrier, which may have no mass, the
/// other one that turns.
fn loaded(operation: Option<Operation>) -> Member {
    match operation {
        Some(Operation { input: Member::Ring, .. })
        | Some(Operation { input: Member::Carrier, fixed: Member::Sun, .. }) => Member::Ring,
        _ => Member::Sun,
    }
}

/// Supports of the two gears of a pair. Where no bearing stiffness is given, bearings are rigid.
fn pair_supports(root: &Section<'_, '_>, mesh: Option<MeshKind>) -> Supports {
    for key in ["carrier", "ring"] {
        root.refuse(key, "the bearings of a gear pair stand on the ground");
    }
    let gear = |key| {
        if mesh == Some(MeshKind::RingPlanet) {
            let why = "only a sun–planet pair is computed in time; at rest its bores are rigid";
            root.refuse(key, why);
            let rigid = Support { motion: Freedom::CentreHeld, ..Support::HELD };
            return (rigid, GivenInertia::default());
        }
        let s = root.table(key);
        let found = support(&s, true);
        let given = GivenInertia {
            mass_kg: s.optional("mass_kg"),
            inertia_kg_m2: s.optional("inertia_kg_m2"),
        };
        for key in ["added_mass_kg", "added_inertia_kg_m2"] {
            s.refuse(key, "mass_kg and inertia_kg_m2 of a pair's gear include its shaft");
        }
        (found, given)
    };
    let ((sun, sun_inertia), (planet, planet_inertia)) = (gear("sun"), gear("planet"));
    Supports {
        carrier: Support::HELD,
        ring: Support::HELD,
        sun,
        planet_bearing_n_per_m: 0.0,
        planet_added: AddedMass::default(),
        pair: Some(PairSupports { planet, sun_inertia, planet_inertia }),
    }
}

/// Support of a member. Without a bearing a gear of a pair has its centre held, and a member of a set floats.
fn support(s: &Section<'_, '_>, is_pair: bool) -> Support {
    let motion = s.choice("motion").unwrap_or(Freedom::Free);
    let bearing = s.optional("bearing_n_per_m");
    if is_pair && bearing == Some(0.0) {
        let why = "a gear of a pair is held by nothing else; leave it out for a rigid bearing";
        s.fault("bearing_n_per_m", "a number above 0, or nothing", why);
    }
    let (length, angle) = ("torsional_n_per_m", "torsional_nm_per_rad");
    let (per_length, per_angle) = (s.optional(length), s.optional(angle));
    if s.has(length) && s.has(angle) {
        let allowed = "one of torsional_n_per_m and torsional_nm_per_rad";
        s.fault(angle, allowed, "both say the same");
    }
    if motion != Freedom::Free {
        s.refuse(length, "a held rotation has no torsional spring");
        s.refuse(angle, "a held rotation has no torsional spring");
    }
    if motion == Freedom::Held {
        s.refuse("bearing_n_per_m", "a held member has no bearing that could yield");
    }
    let motion = match motion {
        Freedom::Free if is_pair && bearing.is_none() => Freedom::CentreHeld,
        Freedom::RotationHeld if is_pair && bearing.is_none() => Freedom::Held,
        motion => motion,
    };
    let torsional = match per_angle {
        Some(k) => Torsional::PerAngle(k),
        None => Torsional::PerLength(per_length.unwrap_or(0.0)),
    };
    Support { motion, bearing_n_per_m: bearing.unwrap_or(0.0), torsional }
}
