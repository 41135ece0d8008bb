//! From scene text to the plain `Scene`, every fault collected.

use std::path::Path;

use crate::assembly;
use crate::check;
use crate::fault::{Fault, SceneError};
use crate::geometry::Geometry;
use crate::mesh_kind::MeshKind;
use crate::parse_dynamics::dynamics;
use crate::parse_fe_contact::fe_contact;
use crate::parse_geometry::geometry;
use crate::parse_lumped::lumped;
use crate::reader::{Bound, Document, Section};
use crate::scene::*;
use crate::text_file::read_text;

/// Longest scene file that is read, bytes; the longest of this project has some 4 kB.
const MOST_BYTES: u64 = 1_000_000;

/// Most planets a scene may have; a circle of more would not fit any real set.
const MOST_PLANETS: i64 = 64;

impl Scene {
    /// Reads and validates a scene file.
    ///
    /// # Errors
    /// [`SceneError::Unreadable`] if the file cannot be read, [`SceneError::Invalid`] with every
    /// fault found otherwise.
    pub fn from_file(path: &Path) -> Result<Self, SceneError> {
        let unreadable = |cause| SceneError::Unreadable { path: path.to_owned(), cause };
        Self::from_toml(&read_text(path, MOST_BYTES).map_err(unreadable)?)
    }

    /// Reads and validates scene text.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with every fault found.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let document = Document::new(text);
        let table = document.parse();
        let scene = read(&document, Section::new(&document, "", &table));
        if let Some(scene) = &scene {
            check::whole(&document, scene);
        }
        let faults = document.into_faults();
        match scene {
            Some(scene) if faults.is_empty() => Ok(scene),
            _ => Err(SceneError::Invalid { text: text.to_owned(), faults: or_unknown(faults) }),
        }
    }
}

/// Every missing value comes with a fault of its own; this only guards that promise.
fn or_unknown(faults: Vec<Fault>) -> Vec<Fault> {
    if !faults.is_empty() {
        return faults;
    }
    vec![Fault {
        key: "kind".into(),
        value: "incomplete".into(),
        allowed: "a complete scene".into(),
        why: "the scene could not be put together".into(),
        span: 0..0,
    }]
}

fn read(document: &Document<'_>, root: Section<'_, '_>) -> Option<Scene> {
    let why = "the number says how to read the file";
    if root.has("format") {
        root.integer("format", (1, 1), why);
    } else {
        root.integer("format", (1, 1), why);
        root.fault("format", "1", why);
    }
    let kinds = [("planetary", SceneKind::Planetary), ("gear_pair", SceneKind::GearPair)];
    let why = "it says whether the scene is a whole set or one mesh";
    let kind = root.choice("kind", &kinds, why);
    if !root.has("kind") {
        root.fault("kind", "\"planetary\" or \"gear_pair\"", why);
    }
    let title = root.string("title");
    let source = root.string("source");
    let meshes = [("sun_planet", MeshKind::SunPlanet), ("ring_planet", MeshKind::RingPlanet)];
    let pair = root.choice("mesh", &meshes, "the mesh of a gear pair");
    let is_pair = kind == Some(SceneKind::GearPair);
    if is_pair && !root.has("mesh") {
        root.fault("mesh", "\"sun_planet\" or \"ring_planet\"", "a gear pair is one of the two");
    }
    if kind == Some(SceneKind::Planetary) && root.has("mesh") {
        root.fault("mesh", "nothing here", "only a gear pair names one mesh");
    }
    let teeth = root.section("teeth").and_then(|s| teeth(s, kind, pair));
    let planets = planets(&root, is_pair, teeth.as_ref());
    let geometry = root.section("geometry").and_then(|s| geometry(s, teeth.as_ref()));
    if root.has("geometry") && !root.has("teeth") {
        root.fault("teeth", "[teeth] with sun, planet, ring", "geometry needs numbers of teeth");
    }
    if is_pair && !root.has("geometry") {
        root.fault("geometry", "[geometry]", "a gear pair is nothing without its tooth geometry");
    }
    let material = material(root.section("material"));
    let supports = supports(&root, is_pair);
    let resolved = geometry.as_ref().zip(teeth.as_ref()).map(|(g, t)| Geometry::new(g, t));
    let resolved = resolved.and_then(Result::ok);
    let lumped = root.section("lumped").and_then(|s| {
        let may_give_angles = resolved.is_none() && !root.has("geometry");
        lumped(s, resolved.as_ref(), supports.as_ref(), may_give_angles)
    });
    if is_pair && root.has("lumped") {
        root.fault("lumped", "nothing here", "a gear pair has no lumped model");
    }
    let overrides = overrides(document, &root, planets.as_ref(), lumped.as_ref());
    let damping = damping(root.section("damping"));
    let operation = root.section("operation").and_then(operation);
    let fe_contact = root.section("fe_contact").map(fe_contact).unwrap_or_default();
    let dynamics = root.section("dynamics").map(dynamics).unwrap_or_default();
    root.finish();
    Some(Scene {
        kind: kind?,
        pair,
        title: title.unwrap_or_else(|| "untitled".into()),
        source,
        planets: planets?,
        teeth,
        geometry,
        material,
        supports: supports?,
        lumped,
        overrides,
        damping,
        operation,
        fe_contact,
        dynamics,
    })
}

fn teeth(s: Section<'_, '_>, kind: Option<SceneKind>, pair: Option<MeshKind>) -> Option<Teeth> {
    let limits = (5, 10_000);
    let count = |key: &'static str, needed: bool| {
        let why = "number of teeth";
        if needed && !s.has(key) {
            s.integer(key, limits, why);
            s.fault(key, "a whole number from 5 to 10000", why);
            return None;
        }
        s.integer(key, limits, why).map(|z| z as u32)
    };
    let whole = kind != Some(SceneKind::GearPair);
    let sun = count("sun", whole || pair == Some(MeshKind::SunPlanet));
    let planet = count("planet", true);
    let ring = count("ring", whole || pair == Some(MeshKind::RingPlanet));
    if let (Some(z_p), Some(z_r)) = (planet, ring)
        && z_r <= z_p
    {
        s.fault("ring", format!("more than the planet's {z_p} teeth"), "the planet runs inside");
    }
    s.finish();
    Some(Teeth { sun, planet: planet?, ring })
}

fn planets(
    root: &Section<'_, '_>,
    is_pair: bool,
    teeth: Option<&Teeth>,
) -> Option<PlanetPositions> {
    let Some(s) = root.section("planets") else {
        if is_pair {
            return Some(PlanetPositions::equally_spaced(1));
        }
        if !root.has("planets") {
            root.fault("planets", "[planets] with count", "a planetary set has planets");
        }
        return None;
    };
    if is_pair {
        root.fault("planets", "nothing here", "a gear pair has one planet, at zero");
    }
    let count = s.integer("count", (1, MOST_PLANETS), "number of planets N");
    if !s.has("count") {
        s.fault("count", format!("1 to {MOST_PLANETS}"), "number of planets N");
    }
    let steps = s.integers("position_steps", "assembly steps of 360°/(Z_s+Z_r) from planet 0");
    let degrees = s.numbers("positions_deg", "planet positions, counter-clockwise from planet 0");
    let (has_steps, has_degrees) = (s.has("position_steps"), s.has("positions_deg"));
    let result = positions(&s, count, steps, degrees, teeth);
    let is_asked = has_steps || has_degrees;
    s.finish();
    let sun_ring = teeth.and_then(Teeth::sun_ring);
    match (result, is_asked) {
        (Some(found), _) => Some(found),
        (None, true) => None,
        (None, false) => {
            let n = usize::try_from(count?).ok()?;
            equal_positions(root, n, sun_ring)
        }
    }
}

/// Positions given explicitly, checked against count and assembly.
fn positions(
    s: &Section<'_, '_>,
    count: Option<i64>,
    steps: Option<Vec<i64>>,
    degrees: Option<Vec<f64>>,
    teeth: Option<&Teeth>,
) -> Option<PlanetPositions> {
    let sun_ring = teeth.and_then(Teeth::sun_ring);
    if s.has("position_steps") && s.has("positions_deg") {
        s.fault("positions_deg", "one of positions_deg and position_steps", "both say the same");
        return None;
    }
    let length_is_right = |key: &str, length: usize| match count {
        Some(n) if n as usize == length => true,
        Some(n) => {
            s.fault(key, format!("{n} entries, as in count"), "one position a planet");
            false
        }
        None => false,
    };
    if let Some(steps) = steps {
        let ok = length_is_right("position_steps", steps.len());
        if ok && steps[0] != 0 {
            s.fault("position_steps", "0 first", "angles are counted from planet 0");
            return None;
        }
        let Some((z_s, z_r)) = sun_ring else {
            let why = "a step is 360°/(Z_s+Z_r)";
            s.fault("position_steps", "with [teeth] sun and ring given", why);
            return None;
        };
        let step = assembly::assembly_step_rad(z_s, z_r);
        let psi_rad = steps.iter().map(|&k| k as f64 * step).collect();
        return ok.then_some(PlanetPositions { psi_rad, steps: Some(steps) });
    }
    let degrees = degrees?;
    if !length_is_right("positions_deg", degrees.len()) {
        return None;
    }
    if degrees[0] != 0.0 {
        s.fault("positions_deg", "0 first", "angles are counted from planet 0");
        return None;
    }
    if let Some(&far) = degrees.iter().find(|d| d.abs() > 360.0) {
        let why = format!("{far} is more than one turn");
        s.fault("positions_deg", "angles from -360 to 360", why);
        return None;
    }
    let psi_rad: Vec<f64> = degrees.iter().map(|d| d.to_radians()).collect();
    let Some((z_s, z_r)) = sun_ring else {
        return Some(PlanetPositions { psi_rad, steps: None });
    };
    let mut steps = Vec::new();
    let mut all_fit = true;
    for (&degree, &psi) in degrees.iter().zip(&psi_rad) {
        let (nearest, off) = assembly::nearest_steps(psi, z_s, z_r);
        steps.push(nearest);
        // Rounding of degrees written with 8 decimals; anything more misplaces teeth.
        if off.abs() > 1e-6 {
            all_fit = false;
            let exact = nearest as f64 * 360.0 / f64::from(z_s + z_r);
            let allowed = format!("multiples of 360°/{}", z_s + z_r);
            let why = format!(
                "{degree}° cannot be assembled: the nearest position that can is {nearest} steps, {exact:.8}°; write position_steps"
            );
            s.fault("positions_deg", allowed, why);
        }
    }
    let step = assembly::assembly_step_rad(z_s, z_r);
    let psi_rad = steps.iter().map(|&k| k as f64 * step).collect();
    all_fit.then_some(PlanetPositions { psi_rad, steps: Some(steps) })
}

/// Equal spacing; with teeth known it must be possible to assemble it.
fn equal_positions(
    root: &Section<'_, '_>,
    n: usize,
    sun_ring: Option<(u32, u32)>,
) -> Option<PlanetPositions> {
    let mut positions = PlanetPositions::equally_spaced(n);
    let Some((z_s, z_r)) = sun_ring else {
        return Some(positions);
    };
    let total = u64::from(z_s) + u64::from(z_r);
    if total % n as u64 != 0 {
        let n = n as u64;
        // n·total/N, rounded in whole numbers.
        let nearest: Vec<_> = (0..n).map(|i| ((2 * i * total + n) / (2 * n)).to_string()).collect();
        let why = format!(
            "(Z_s+Z_r)/N = {total}/{n} is not whole, so equal spacing cannot be assembled; nearest: position_steps = [{}]",
            nearest.join(", ")
        );
        root.fault("planets", "positions that can be assembled", why);
        return None;
    }
    let each = (total / n as u64) as i64;
    positions.steps = Some((0..n as i64).map(|i| i * each).collect());
    Some(positions)
}

fn material(s: Option<Section<'_, '_>>) -> Material {
    let default =
        Material { young_modulus_pa: 206e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let Some(s) = s else { return default };
    let e = s.number("young_modulus_pa", Bound::Positive, "modulus of elasticity E");
    let nu = s.number("poisson_ratio", Bound::Between(-1.0, 0.5), "an isotropic solid");
    let rho = s.number("density_kg_per_m3", Bound::Positive, "density ρ");
    s.finish();
    Material {
        young_modulus_pa: e.unwrap_or(default.young_modulus_pa),
        poisson_ratio: nu.unwrap_or(default.poisson_ratio),
        density_kg_per_m3: rho.unwrap_or(default.density_kg_per_m3),
    }
}

fn supports(root: &Section<'_, '_>, is_pair: bool) -> Option<Supports> {
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
    let planet_bearing = match root.section("planet") {
        Some(s) => {
            let why = "stiffness between planet and carrier, equal in both directions";
            let k = s.required("bearing_n_per_m", Bound::Positive, why);
            let added = |key, why| s.number(key, Bound::NonNegative, why).unwrap_or(0.0);
            planet_added = AddedMass {
                mass_kg: added("added_mass_kg", "mass fixed to each planet's race"),
                inertia_kg_m2: added("added_inertia_kg_m2", "its polar inertia"),
            };
            s.finish();
            if is_pair {
                root.fault("planet", "nothing here", "races of a gear pair are rigid");
            }
            k
        }
        None if is_pair => Some(0.0),
        None => {
            if !root.has("planet") {
                let why = "every planet runs on a bearing on the carrier";
                root.fault("planet", "[planet] with bearing_n_per_m", why);
            }
            None
        }
    };
    Some(Supports { carrier, ring, sun, planet_bearing: planet_bearing?, planet_added })
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

fn overrides(
    document: &Document<'_>,
    root: &Section<'_, '_>,
    planets: Option<&PlanetPositions>,
    lumped: Option<&LumpedInput>,
) -> Vec<PlanetOverride> {
    let mut list: Vec<PlanetOverride> = Vec::new();
    let count = planets.map_or(MOST_PLANETS as usize, PlanetPositions::count);
    for s in root.sections("planet_override") {
        let why = "index of the planet, from 0";
        let index = s.integer("planet", (0, count as i64 - 1), why);
        if !s.has("planet") {
            s.fault("planet", format!("0 to {}", count - 1), why);
        }
        let value = |key, why| s.number(key, Bound::Positive, why);
        let found = PlanetOverride {
            planet: index.unwrap_or(0) as usize,
            mass: value("mass_kg", "mass of this planet"),
            inertia_over_r2: value("inertia_over_r2_kg", "I/r² of this planet"),
            bearing: value("bearing_n_per_m", "bearing stiffness of this planet"),
            sun_mesh: value("sun_planet_n_per_m", "sun mesh stiffness of this planet"),
            ring_mesh: value("ring_planet_n_per_m", "ring mesh stiffness of this planet"),
        };
        if index.is_some() && list.iter().any(|o| o.planet == found.planet) {
            s.fault("planet", "each planet once", "two tables for one planet contradict");
        }
        s.finish();
        list.push(found);
    }
    if !list.is_empty() && lumped.is_none() && !document.is_faulty("lumped") {
        root.fault("planet_override", "with [lumped]", "its keys change the lumped model");
    }
    list
}

fn damping(s: Option<Section<'_, '_>>) -> Damping {
    // 2 % of critical at 780 and 2100 Hz.
    let (alpha, beta) = (142.9, 2.21e-6);
    let default =
        Damping { mass_proportional_per_s: alpha, stiffness_proportional_s: beta, bearing_s: beta };
    let Some(s) = s else { return default };
    let alpha = s.number("mass_proportional_per_s", Bound::NonNegative, "α in C = αM + βK");
    let beta = s.number("stiffness_proportional_s", Bound::NonNegative, "β in C = αM + βK");
    let why = "viscous damping of every bearing over its stiffness";
    let bearing = s.number("bearing_s", Bound::NonNegative, why);
    s.finish();
    Damping {
        mass_proportional_per_s: alpha.unwrap_or(default.mass_proportional_per_s),
        stiffness_proportional_s: beta.unwrap_or(default.stiffness_proportional_s),
        // With the same β the set as a whole is proportionally damped.
        bearing_s: bearing.or(beta).unwrap_or(default.bearing_s),
    }
}

fn operation(s: Section<'_, '_>) -> Option<Operation> {
    let members = [Member::Sun, Member::Ring, Member::Carrier].map(|m| (m.name(), m));
    let fixed = s.choice("fixed", &members, "the member that stands still");
    let input = s.choice("input", &members, "the member whose speed and torque are given");
    let (fixed, input) = (fixed.unwrap_or(Member::Ring), input.unwrap_or(Member::Sun));
    if fixed == input {
        s.fault("input", "another member than `fixed`", "a held member cannot be driven");
    }
    let speed = s.required("speed_rpm", Bound::Finite, "speed of the input member");
    let torque = s.required("torque_nm", Bound::Finite, "torque on the input member");
    s.finish();
    Some(Operation { fixed, input, speed_rpm: speed?, torque_nm: torque? })
}
