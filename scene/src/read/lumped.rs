//! The `[lumped]` table: given values, completed from the geometry; or the word that all follow from it.

use gearset::Geometry;

use crate::read::document::Section;
use crate::scene::*;

fn per_body(s: &Section<'_, '_>, key: &'static str) -> PerBody {
    let s = s.table(key);
    PerBody {
        carrier: s.optional("carrier"),
        ring: s.optional("ring"),
        sun: s.optional("sun"),
        planet: s.optional("planet"),
    }
}

/// Values of both meshes, if the table is there; those of the ring–planet meshes are 0 of a gear pair, which has none.
fn per_mesh(s: &Section<'_, '_>, key: &'static str, is_pair: bool) -> Option<PerMesh> {
    let s = s.section(key)?;
    let sun_planet = s.number("sun_planet");
    if !is_pair {
        s.demand("ring_planet");
        return Some(PerMesh { sun_planet, ring_planet: s.number("ring_planet") });
    }
    s.refuse("ring_planet", "a sun–planet pair has no ring");
    Some(PerMesh { sun_planet, ring_planet: 0.0 })
}

/// r of u = r·θ: the base radius of a gear, the centre distance for the carrier.
pub(crate) fn radii(geometry: &Geometry) -> PerBody {
    PerBody {
        carrier: Some(geometry.center_distance),
        ring: geometry.ring.as_ref().map(|ring| ring.base_radius),
        sun: geometry.sun.as_ref().map(|sun| sun.base_radius),
        planet: Some(geometry.planet.base_radius),
    }
}

/// Operating pressure angles; 0 for the ring–planet meshes of a pair, which has none.
pub(crate) fn pressure_angles(geometry: &Geometry, is_pair: bool) -> Option<PerMesh> {
    let ring_planet = match &geometry.ring_planet {
        _ if is_pair => 0.0,
        mesh => mesh.as_ref()?.pressure_angle,
    };
    Some(PerMesh { sun_planet: geometry.sun_planet.as_ref()?.pressure_angle, ring_planet })
}

/// The entry of one body.
type Entry = fn(&mut PerBody) -> &mut Option<f64>;

/// Reads the table. Pressure angles and radii that are not given are taken from the geometry; in a scene without
/// geometry the angles must be given.
pub(crate) fn lumped(
    s: &Section<'_, '_>,
    geometry: Option<&Geometry>,
    supports: &Supports,
) -> Option<LumpedInput> {
    let is_pair = supports.pair.is_some();
    if follows_geometry(s, is_pair) {
        return None;
    }
    // A geometry at fault would give angles and radii once it is mended.
    let has_geometry = s.document.may_hold("geometry");
    let mass = per_body(s, "mass_kg");
    let inertia = per_body(s, "inertia_kg_m2");
    let over_r2 = per_body(s, "inertia_over_r2_kg");
    let given_radius = per_body(s, "radius_mm");
    let mesh = per_mesh(s, "mesh_n_per_m", is_pair);
    if !s.has("mesh_n_per_m") {
        let why = "the lumped model needs both mesh stiffnesses";
        s.fault("mesh_n_per_m", "{ sun_planet = …, ring_planet = … }", why);
    }
    let given_angle = per_mesh(s, "pressure_angle_deg", is_pair);
    if !s.has("pressure_angle_deg") && !has_geometry {
        let why = "without [geometry] the operating pressure angles must be given";
        s.fault("pressure_angle_deg", "{ sun_planet = …, ring_planet = … }", why);
    }
    let pressure_angle = given_angle.or_else(|| pressure_angles(geometry?, is_pair));
    let from_geometry = geometry.map(radii).unwrap_or_default();
    let radius = PerBody {
        carrier: given_radius.carrier.or(from_geometry.carrier),
        ring: given_radius.ring.or(from_geometry.ring),
        sun: given_radius.sun.or(from_geometry.sun),
        planet: given_radius.planet.or(from_geometry.planet),
    };
    let mut inertia_over_r2 = over_r2;
    let planet = supports.pair.map_or(Freedom::Free, |pair| pair.planet.motion);
    let bodies: [(&str, Freedom, Entry); 4] = [
        ("carrier", supports.carrier.motion, |p| &mut p.carrier),
        ("ring", supports.ring.motion, |p| &mut p.ring),
        ("sun", supports.sun.motion, |p| &mut p.sun),
        ("planet", planet, |p| &mut p.planet),
    ];
    let (mut own_mass, mut inertia, mut over_r2, mut own_radius) = (mass, inertia, over_r2, radius);
    for (name, motion, of) in bodies {
        if (name != "planet" || is_pair) && s.document.is_doubtful(&format!("{name}.motion")) {
            continue; // Whether it can move is not known.
        }
        let is_doubtful = |table: &str| s.is_doubtful(&format!("{table}.{name}"));
        if motion.translates() && of(&mut own_mass).is_none() && !is_doubtful("mass_kg") {
            let why = format!("the {name} can move");
            fault_in(s, "mass_kg", name, "a mass above 0", &why);
        }
        if is_doubtful("inertia_kg_m2") || is_doubtful("inertia_over_r2_kg") {
            continue;
        }
        match (*of(&mut inertia), *of(&mut over_r2), *of(&mut own_radius)) {
            (Some(_), Some(_), _) => {
                let allowed = "one of inertia_kg_m2 and inertia_over_r2_kg";
                fault_in(s, "inertia_over_r2_kg", name, allowed, "both say the same");
            }
            (None, None, _) if motion.rotates() => {
                let allowed = "inertia_kg_m2, or inertia_over_r2_kg";
                let why = format!("the {name} can rotate");
                fault_in(s, "inertia_kg_m2", name, allowed, &why);
            }
            (Some(_), None, None)
                if motion.rotates() && !has_geometry && !is_doubtful("radius_mm") =>
            {
                let why = format!("I/r² of the {name} needs r, and no [geometry] gives it");
                fault_in(s, "radius_mm", name, "a radius above 0", &why);
            }
            (Some(i), None, Some(r)) => *of(&mut inertia_over_r2) = Some(i / (r * r)),
            _ => {}
        }
    }
    if !has_geometry {
        torsional_needs_radius(s, supports, &radius);
        let is_known = !s.is_doubtful("radius_mm.planet");
        if supports.planet_added.inertia_kg_m2 > 0.0 && radius.planet.is_none() && is_known {
            let why = "added_inertia_kg_m2 of the planet needs r";
            fault_in(s, "radius_mm", "planet", "a radius above 0", why);
        }
    }
    Some(LumpedInput {
        mass_kg: mass,
        inertia_over_r2_kg: inertia_over_r2,
        radius_m: radius,
        mesh_n_per_m: mesh?,
        pressure_angle_rad: pressure_angle?,
    })
}

/// Keys that hold numbers.
const NUMBERS: [&str; 6] = [
    "mass_kg",
    "inertia_kg_m2",
    "inertia_over_r2_kg",
    "radius_mm",
    "mesh_n_per_m",
    "pressure_angle_deg",
];

/// Whether the table says that the parameters follow from the geometry, as they do without the table; it then holds
/// no numbers.
fn follows_geometry(s: &Section<'_, '_>, is_pair: bool) -> bool {
    let is_read = s.word("from").is_some();
    if !s.has("from") {
        return false;
    }
    for key in NUMBERS {
        let why = "`lumped.from` = \"geometry\" gives every parameter";
        match is_read {
            true => s.refuse_as(key, "nothing beside `from`", why),
            false => s.skip(key),
        }
    }
    if is_read && is_pair {
        s.fault("from", "nothing here", "parameters in closed form are those of planetary sets");
    } else if is_read && !s.document.may_hold("geometry") {
        s.fault("from", "nothing, or [geometry] in the scene", "there is no geometry to follow");
    }
    true
}

/// Adds a fault about the key `table.name`.
fn fault_in(s: &Section<'_, '_>, table: &str, name: &str, allowed: &str, why: &str) {
    s.fault(&format!("{table}.{name}"), allowed, why);
}

/// Reports torsional stiffnesses per angle whose body has no radius r: per u = r·θ they are k_θ/r².
fn torsional_needs_radius(s: &Section<'_, '_>, supports: &Supports, radius: &PerBody) {
    let mut members = vec![
        ("carrier", supports.carrier, radius.carrier),
        ("ring", supports.ring, radius.ring),
        ("sun", supports.sun, radius.sun),
    ];
    members.extend(supports.pair.map(|pair| ("planet", pair.planet, radius.planet)));
    for (name, support, radius) in members {
        if let (Torsional::PerAngle(k), None) = (support.torsional, radius)
            && k > 0.0
            && !s.is_doubtful(&format!("radius_mm.{name}"))
        {
            let why = format!("torsional_nm_per_rad of the {name} needs r");
            fault_in(s, "radius_mm", name, "a radius above 0", &why);
        }
    }
}
