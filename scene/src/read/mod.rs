//! From scene text to the plain `Scene`, every fault collected.

mod digits;
pub(crate) mod document;
mod dynamics;
pub(crate) mod fault;
mod fe_contact;
pub(crate) mod geometry;
pub(crate) mod lumped;
mod nearest;
mod planets;
mod rack_defaults;
pub(crate) mod remarks;
mod scope;
mod supports;
pub(crate) mod text_file;
pub(crate) mod thickness;
mod tip_rounding;
mod unread;

use std::path::Path;

use gearset::{Geometry, Member, MeshKind, Operation, PlanetPositions, Teeth};

use crate::check;
use crate::choices::FeContactInput;
use crate::keys::is_within;
use crate::load::estimates::PAIR_STIFFNESS_DIVISOR;
use crate::read::document::{Document, Section};
use crate::read::dynamics::dynamics;
use crate::read::fault::{Fault, SceneError, SceneFaults, printable};
use crate::read::fe_contact::fe_contact;
use crate::read::geometry::geometry;
use crate::read::planets::planets;
use crate::read::remarks::Remarks;
use crate::read::supports::supports;
use crate::read::text_file::read_text;
use crate::scene::*;

/// Longest scene file that is read, bytes; the longest of this project has some 4 kB.
pub const MOST_SCENE_BYTES: u64 = 1_000_000;

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
        Ok(Self::with_remarks(text)?.0)
    }

    /// The same, and what was chosen for keys that the text leaves out and what its digits show.
    ///
    /// # Errors
    /// As [`from_toml`](Self::from_toml).
    pub fn with_remarks(text: &str) -> Result<(Self, Remarks), SceneError> {
        Self::read_text(text, false)
    }

    /// Reads text whose numbers are rounded to the digits they have, or exact.
    fn read_text(text: &str, is_exact: bool) -> Result<(Self, Remarks), SceneError> {
        let mut document = Document::new(text);
        document.is_exact = is_exact;
        let scene = read_document(&document);
        let written = document.keys();
        let (faults, mut remarks) = document.into_findings();
        match scene {
            Some(scene) if faults.is_empty() => {
                remarks.idle = scene.idle_keys(written);
                Ok((scene, remarks))
            }
            _ => Err(SceneError::Invalid { text: printable(text), faults: or_unknown(faults) }),
        }
    }
}

impl Scene {
    /// A planetary set of so many equally spaced planets, each on a bearing of this stiffness (N/m), and nothing else:
    /// every other value is the default of its key. Fields are set afterwards, and [`Scene::check`] judges the result.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] for no planets, too many, or a stiffness that is not above 0.
    pub fn planetary(planets: usize, planet_bearing_n_per_m: f64) -> Result<Self, SceneError> {
        Self::from_toml(&format!(
            "format = 1\nkind = \"planetary\"\n[planets]\ncount = {planets}\n\
             [planet]\nbearing_n_per_m = {}\n",
            toml::Value::Float(planet_bearing_n_per_m)
        ))
    }

    /// Whether a scene that was built or changed in a program is one: judged as its file ([`Scene::to_toml`]) is.
    ///
    /// # Errors
    /// [`SceneFaults`] with every fault, each with its key and the value in the unit of the key.
    pub fn check(&self) -> Result<(), SceneFaults> {
        match Self::read_text(&self.to_toml(), true) {
            Ok((read, _))
                if self.planets.steps.is_some() && self.planets.steps != read.planets.steps =>
            {
                Err(SceneFaults(vec![Fault {
                    key: "planets.position_steps".into(),
                    value: format!("{:?}", self.planets.steps.as_deref().unwrap_or_default()),
                    allowed: "the steps that the angles are".into(),
                    why: "steps and angles both say where the planets stand".into(),
                    span: 0..0,
                }]))
            }
            Ok(_) => Ok(()),
            Err(error) => Err(SceneFaults(error.faults().to_vec())),
        }
    }

    /// The same for some keys or tables alone. Models ask for those without which they cannot be right; they take more
    /// than a file may hold, such as planets that are displaced from where they can be assembled.
    ///
    /// # Errors
    /// [`SceneFaults`] with the faults of these keys and of keys below them.
    pub fn check_keys(&self, keys: &[&str]) -> Result<(), SceneFaults> {
        let Err(SceneFaults(mut faults)) = self.check() else { return Ok(()) };
        faults.retain(|fault| keys.iter().any(|key| is_within(&fault.key, key)));
        if faults.is_empty() { Ok(()) } else { Err(SceneFaults(faults)) }
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

/// `[fe_contact]` where it is left out.
pub(crate) fn default_fe_contact() -> Option<FeContactInput> {
    let document = Document::new("");
    let table = document.parse();
    fe_contact(&Section::new(&document, "", &table).table("fe_contact"))
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
    pub(crate) fn complete(&self) -> Option<Teeth> {
        Some(Teeth { sun: self.sun, planet: self.planet?, ring: self.ring })
    }
}

fn read(document: &Document<'_>, root: Section<'_, '_>) -> Option<Scene> {
    root.integer::<i64>("format");
    let kind = root.choice("kind");
    let pair = root.choice("mesh");
    let is_pair = kind == Some(SceneKind::GearPair);
    if is_pair {
        root.demand("mesh");
    } else if kind.is_some() {
        root.refuse("mesh", "only a gear pair names one mesh");
    }
    let (title, source) = (root.string("title"), root.string("source"));
    let teeth = root.section("teeth").map(|s| teeth(&s, kind, pair)).unwrap_or_default();
    let planets = planets(&root, kind, &teeth);
    let geometry = root.section("geometry").map(|s| geometry(&s, &teeth));
    if root.has("geometry") && !root.has("teeth") {
        root.fault("teeth", "[teeth] with sun, planet, ring", "geometry needs numbers of teeth");
    }
    if is_pair && !root.has("geometry") && !root.has("lumped") {
        let why =
            "a gear pair has tooth geometry, or lumped parameters for its natural modes alone";
        root.fault("geometry", "[geometry], or [lumped]", why);
    }
    let material = material(&root.table("material"));
    let operation = root.section("operation").and_then(|s| operation(&s, is_pair));
    let pair_stiffness = geometry.as_ref().map(|read| read.input.face_width_m);
    let pair_stiffness = pair_stiffness
        .map(|width| material.young_modulus_pa * width / PAIR_STIFFNESS_DIVISOR)
        .filter(|stiffness| stiffness.is_finite());
    let supports = supports(&root, kind, pair, pair_stiffness, operation);
    let fe_contact = fe_contact(&root.table("fe_contact"));
    let dynamics = dynamics(&root.table("dynamics"));
    let (fe_contact, dynamics) = (fe_contact?, dynamics?);
    let whole_teeth = teeth.complete();
    let is_sound = !document.is_doubtful("geometry") && !document.is_doubtful("teeth");
    let resolved = geometry.as_ref().zip(whole_teeth.as_ref()).filter(|_| is_sound);
    let resolved = resolved.and_then(|(g, t)| Geometry::new(&g.input, t).ok());
    let lumped = match root.section("lumped") {
        Some(_) if is_pair && pair == Some(MeshKind::RingPlanet) => {
            root.fault("lumped", "nothing here", "only a sun–planet pair has a lumped model");
            None
        }
        Some(s) => lumped::lumped(&s, resolved.as_ref(), &supports),
        None => None,
    };
    let overrides = overrides(&root, planets.as_ref());
    let damping = damping(&root.table("damping"));
    if let Some(positions) = &planets {
        check::distinct_positions(document, positions);
    }
    check::factors_need_quasi_static(document, &fe_contact, &dynamics);
    check::auto_chooses(document, &fe_contact, &dynamics);
    if is_pair && dynamics.gyroscopic {
        let why = "the bearings of a gear pair stand still: there is no turning carrier frame";
        document.fault("dynamics.gyroscopic", "\"off\"", why);
    }
    if let Some(geometry) = &geometry {
        check::geometry::shape(document, geometry, &teeth, planets.as_ref());
    }
    Some(Scene {
        kind: kind?,
        pair,
        title: title?,
        source,
        planets: planets?,
        teeth: whole_teeth,
        geometry: geometry.map(|read| read.input),
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

fn teeth(s: &Section<'_, '_>, kind: Option<SceneKind>, pair: Option<MeshKind>) -> TeethRead {
    let count = |key, is_needed: bool| {
        if is_needed {
            s.demand(key);
        }
        s.integer(key)
    };
    let is_whole = kind == Some(SceneKind::Planetary);
    let sun = count("sun", is_whole || pair == Some(MeshKind::SunPlanet));
    let planet = s.integer("planet");
    let ring = count("ring", is_whole || pair == Some(MeshKind::RingPlanet));
    if let (Some(z_p), Some(z_r)) = (planet, ring)
        && z_r <= z_p
    {
        s.fault("ring", format!("more than the planet's {z_p} teeth"), "the planet runs inside");
    }
    TeethRead { sun, planet, ring }
}

fn material(s: &Section<'_, '_>) -> Material {
    Material {
        young_modulus_pa: s.number("young_modulus_pa"),
        poisson_ratio: s.number("poisson_ratio"),
        density_kg_per_m3: s.number("density_kg_per_m3"),
    }
}

fn overrides(root: &Section<'_, '_>, planets: Option<&PlanetPositions>) -> Vec<PlanetOverride> {
    let mut list: Vec<PlanetOverride> = Vec::new();
    for s in root.sections("planet_override") {
        let index = s.integer::<usize>("planet");
        if let (Some(i), Some(count)) = (index, planets.map(PlanetPositions::count))
            && i >= count
        {
            let why = "index of the planet, from 0";
            s.fault("planet", format!("a whole number from 0 to {}", count - 1), why);
        }
        if index.is_some() && list.iter().any(|o| Some(o.planet) == index) {
            s.fault("planet", "each planet once", "two tables for one planet contradict");
        }
        list.push(PlanetOverride {
            planet: index.unwrap_or(0),
            mass_kg: s.optional("mass_kg"),
            inertia_over_r2_kg: s.optional("inertia_over_r2_kg"),
            bearing_n_per_m: s.optional("bearing_n_per_m"),
            sun_mesh_n_per_m: s.optional("sun_planet_n_per_m"),
            ring_mesh_n_per_m: s.optional("ring_planet_n_per_m"),
        });
    }
    if !list.is_empty() && !root.may_hold("lumped") {
        root.fault("planet_override", "with [lumped]", "its keys change the lumped model");
    }
    list
}

fn damping(s: &Section<'_, '_>) -> Damping {
    let stiffness_proportional_s = s.number("stiffness_proportional_s");
    Damping {
        mass_proportional_per_s: s.number("mass_proportional_per_s"),
        stiffness_proportional_s,
        // With the same β the set as a whole is proportionally damped.
        bearing_s: s.optional("bearing_s").unwrap_or(stiffness_proportional_s),
    }
}

fn operation(s: &Section<'_, '_>, is_pair: bool) -> Option<Operation> {
    let input = s.choice("input");
    let fixed = match is_pair {
        true => {
            s.refuse("fixed", "the bearings of a gear pair stand still");
            Some(Member::Carrier)
        }
        false => s.choice("fixed"),
    };
    if is_pair && input != Some(Member::Sun) {
        let why = "speed and torque of a gear pair are those of the sun";
        s.fault("input", "\"sun\", or nothing", why);
    }
    let is_known = !s.is_doubtful("fixed") && !s.is_doubtful("input");
    if fixed == input && is_known {
        s.fault("input", "another member than `fixed`", "a held member cannot be driven");
    }
    let (speed_rpm, torque_nm) = (s.number("speed_rpm"), s.number("torque_nm"));
    if !s.may_hold("speed_rpm") {
        s.choose("speed_rpm", speed_rpm.to_string(), "a speed to begin with");
    }
    Some(Operation { fixed: fixed?, input: input?, speed_rpm, torque_nm })
}
