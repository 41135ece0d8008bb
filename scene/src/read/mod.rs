//! From scene text to the plain `Scene`, every fault collected.

pub(crate) mod document;
mod dynamics;
pub(crate) mod fault;
mod fe_contact;
pub(crate) mod geometry;
mod lumped;
mod planets;
mod supports;
pub(crate) mod text_file;
mod unread;

use std::path::Path;

use gearset::{Geometry, Member, MeshKind, Operation, PlanetPositions, Teeth};

use crate::check;
use crate::keys::bound::Bound;
use crate::read::document::{Document, Section};
use crate::read::dynamics::dynamics;
use crate::read::fault::{Fault, SceneError, printable};
use crate::read::fe_contact::fe_contact;
use crate::read::geometry::{GeometryRead, geometry};
use crate::read::planets::planets;
use crate::read::supports::supports;
use crate::read::text_file::read_text;
use crate::scene::*;

/// Longest scene file that is read, bytes; the longest of this project has some 4 kB.
pub const MOST_SCENE_BYTES: u64 = 1_000_000;

/// Most planets a scene may have; a circle of more would not fit any real set.
pub(crate) const MOST_PLANETS: i64 = 64;

impl Scene {
    /// Reads and validates a scene file.
    ///
    /// # Errors
    /// [`SceneError::Unreadable`] if the file cannot be read, [`SceneError::Invalid`] with every
    /// fault found otherwise.
    pub fn from_file(path: &Path) -> Result<Self, SceneError> {
        let unreadable = |cause| SceneError::Unreadable { path: path.to_owned(), cause };
        Self::from_toml(&read_text(path, MOST_SCENE_BYTES).map_err(unreadable)?)
    }

    /// Reads and validates scene text.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with every fault found: of syntax, of single keys and of what only several keys
    /// together show. What follows from a fault is not reported beside it.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let document = Document::new(text);
        let scene = read_document(&document);
        let faults = document.into_faults();
        match scene {
            Some(scene) if faults.is_empty() => Ok(scene),
            _ => Err(SceneError::Invalid { text: printable(text), faults: or_unknown(faults) }),
        }
    }
}

/// Reads a whole document; faults go to it. `None` where a part without which there is no scene is absent.
pub(crate) fn read_document(document: &Document<'_>) -> Option<Scene> {
    let table = document.parse();
    let scene = read(document, Section::new(document, "", &table));
    if let Some(scene) = &scene {
        check::load::deflection(document, scene);
    }
    scene
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

/// Numbers of teeth as far as they can be read.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TeethRead {
    pub(crate) sun: Option<u32>,
    pub(crate) planet: Option<u32>,
    pub(crate) ring: Option<u32>,
}

impl TeethRead {
    fn complete(&self) -> Option<Teeth> {
        Some(Teeth { sun: self.sun, planet: self.planet?, ring: self.ring })
    }
}

fn read(document: &Document<'_>, root: Section<'_, '_>) -> Option<Scene> {
    root.required_integer("format", (1, 1), "the number says how to read the file");
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
    let teeth = root.section("teeth").map(|s| teeth(s, kind, pair)).unwrap_or_default();
    let planets = planets(&root, kind, &teeth);
    let shape = root.section("geometry").map(|s| geometry(s, &teeth));
    if root.has("geometry") && !root.has("teeth") {
        root.fault("teeth", "[teeth] with sun, planet, ring", "geometry needs numbers of teeth");
    }
    if is_pair && !root.has("geometry") {
        root.fault("geometry", "[geometry]", "a gear pair is nothing without its tooth geometry");
    }
    let material = material(root.section("material"));
    let supports = supports(&root, kind, pair);
    let dynamics = root.section("dynamics").map(dynamics).unwrap_or_default();
    let fe_contact = root.section("fe_contact").map(fe_contact).unwrap_or_default();
    let geometry = shape.as_ref().and_then(GeometryRead::complete);
    let whole_teeth = teeth.complete();
    let resolved = geometry.as_ref().zip(whole_teeth.as_ref()).map(|(g, t)| Geometry::new(g, t));
    let resolved = resolved.and_then(Result::ok);
    let lumped = root.section("lumped");
    let lumped = match lumped {
        Some(_) if is_pair && pair == Some(MeshKind::RingPlanet) => {
            root.fault("lumped", "nothing here", "only a sun–planet pair has a lumped model");
            None
        }
        Some(s) => lumped::lumped(s, document, resolved.as_ref(), &supports),
        None => None,
    };
    let overrides = overrides(&root, planets.as_ref());
    let damping = damping(root.section("damping"));
    let operation = root.section("operation").and_then(|s| operation(s, is_pair));
    root.finish();
    if let Some(positions) = &planets {
        check::distinct_positions(document, positions);
    }
    check::factors_need_quasi_static(document, &fe_contact, &dynamics);
    check::auto_chooses(document, &fe_contact, &dynamics);
    if is_pair && dynamics.gyroscopic {
        let why = "the bearings of a gear pair stand still: there is no turning carrier frame";
        document.fault("dynamics.gyroscopic", "\"off\"", why);
    }
    if let Some(shape) = &shape {
        check::geometry::shape(document, shape, &teeth, planets.as_ref());
    }
    Some(Scene {
        kind: kind?,
        pair,
        title: title.unwrap_or_else(|| "untitled".into()),
        source,
        planets: planets?,
        teeth: whole_teeth,
        geometry,
        material,
        supports,
        lumped,
        overrides,
        damping,
        operation,
        fe_contact,
        dynamics,
    })
}

fn teeth(s: Section<'_, '_>, kind: Option<SceneKind>, pair: Option<MeshKind>) -> TeethRead {
    let limits = (5, 10_000);
    let count = |key: &'static str, needed: bool| {
        let why = "number of teeth";
        let read =
            if needed { s.required_integer(key, limits, why) } else { s.integer(key, limits, why) };
        read.map(|z| z as u32)
    };
    let whole = kind == Some(SceneKind::Planetary);
    let sun = count("sun", whole || pair == Some(MeshKind::SunPlanet));
    let planet = count("planet", true);
    let ring = count("ring", whole || pair == Some(MeshKind::RingPlanet));
    if let (Some(z_p), Some(z_r)) = (planet, ring)
        && z_r <= z_p
    {
        s.fault("ring", format!("more than the planet's {z_p} teeth"), "the planet runs inside");
    }
    s.finish();
    TeethRead { sun, planet, ring }
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

fn overrides(root: &Section<'_, '_>, planets: Option<&PlanetPositions>) -> Vec<PlanetOverride> {
    let mut list: Vec<PlanetOverride> = Vec::new();
    let count = planets.map_or(MOST_PLANETS as usize, PlanetPositions::count);
    for s in root.sections("planet_override") {
        let why = "index of the planet, from 0";
        let index = s.required_integer("planet", (0, MOST_PLANETS - 1), why);
        if index.is_some_and(|i| i >= count as i64) {
            s.fault("planet", format!("a whole number from 0 to {}", count - 1), why);
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
    if !list.is_empty() && !root.may_hold("lumped") {
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

fn operation(s: Section<'_, '_>, is_pair: bool) -> Option<Operation> {
    let members = [Member::Sun, Member::Ring, Member::Carrier].map(|m| (m.name(), m));
    let mut fixed = s.choice("fixed", &members, "the member that stands still");
    let input = s.choice("input", &members, "the member whose speed and torque are given");
    if is_pair {
        if s.has("fixed") {
            let why = "the bearings of a gear pair stand still";
            s.fault("fixed", "nothing here", why);
        }
        if input.is_some_and(|input| input != Member::Sun) {
            let why = "speed and torque of a gear pair are those of the sun";
            s.fault("input", "\"sun\", or nothing", why);
        }
        fixed = Some(Member::Carrier);
    }
    let is_known = !s.is_doubtful("fixed") && !s.is_doubtful("input");
    let (fixed, input) = (fixed.unwrap_or(Member::Ring), input.unwrap_or(Member::Sun));
    if fixed == input && is_known && !is_pair {
        s.fault("input", "another member than `fixed`", "a held member cannot be driven");
    }
    let speed = s.required("speed_rpm", Bound::Finite, "speed of the input member");
    let torque = s.required("torque_nm", Bound::Finite, "torque on the input member");
    s.finish();
    Some(Operation { fixed, input, speed_rpm: speed?, torque_nm: torque? })
}
