//! What each verb of the command needs of a scene.

use gearset::{GearInput, Member, MeshKind};

use crate::choices::{Fidelity, MeshKinematics};
use crate::keys::{KEYS, is_within, without_indices};
use crate::scene::{Freedom, PlanetOverride, Scene, SceneKind};

/// A verb of the command that reads a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verb {
    /// `modes`.
    Modes,
    /// `rules`.
    Rules,
    /// `mesh`.
    Mesh,
    /// `static`.
    Static,
    /// `impulse`.
    Impulse,
    /// `sweep` of the scene at this fidelity.
    Sweep(Fidelity),
    /// `branches` of the scene at this fidelity.
    Branches(Fidelity),
    /// `compare`.
    Compare,
}

impl Verb {
    /// Every verb, `sweep` and `branches` at each fidelity that they have.
    pub const ALL: [Self; 13] = [
        Self::Modes,
        Self::Rules,
        Self::Mesh,
        Self::Static,
        Self::Impulse,
        Self::Sweep(Fidelity::MeshLaw),
        Self::Sweep(Fidelity::QuasiStatic),
        Self::Sweep(Fidelity::Modal(1)),
        Self::Sweep(Fidelity::Full),
        Self::Branches(Fidelity::MeshLaw),
        Self::Branches(Fidelity::QuasiStatic),
        Self::Branches(Fidelity::Modal(1)),
        Self::Compare,
    ];

    /// Its name; of `sweep` and `branches` with the fidelity.
    pub fn name(self) -> &'static str {
        match self {
            Self::Modes => "modes",
            Self::Rules => "rules",
            Self::Mesh => "mesh",
            Self::Static => "static",
            Self::Impulse => "impulse",
            Self::Sweep(Fidelity::MeshLaw) => "sweep (mesh_law)",
            Self::Sweep(Fidelity::QuasiStatic) => "sweep (quasi_static)",
            Self::Sweep(Fidelity::Modal(_)) => "sweep (modal)",
            Self::Sweep(Fidelity::Full) => "sweep (full)",
            Self::Branches(Fidelity::MeshLaw) => "branches (mesh_law)",
            Self::Branches(Fidelity::QuasiStatic) => "branches (quasi_static)",
            Self::Branches(Fidelity::Modal(_)) => "branches (modal)",
            Self::Branches(Fidelity::Full) => "branches (full)",
            Self::Compare => "compare",
        }
    }
}

impl Verb {
    /// Whether a value of this key, or of a key of this table, can change a result of the verb for some scene.
    pub fn reads(self, key: &str) -> bool {
        let key = without_indices(key);
        let name = match self {
            Self::Compare => Self::Modes.name(),
            _ => self.name().split(' ').next().unwrap_or_default(),
        };
        let mut declared = KEYS.iter().filter(|declared| is_within(&declared.path, &key));
        declared.any(|declared| declared.changes.split(", ").any(|verb| verb == name))
    }
}

/// A key that a verb needs and that is absent or unfit for it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lack {
    /// Full dotted path of the key, or name of the table.
    pub key: String,
    /// What it is needed for, and what is allowed.
    pub why: String,
    /// Argument of the command that stands in for the key.
    pub argument: Option<&'static str>,
}

fn lack(key: impl Into<String>, why: impl Into<String>) -> Lack {
    Lack { key: key.into(), why: why.into(), argument: None }
}

impl Scene {
    /// What the scene lacks for a verb, empty if the verb can run.
    pub fn lacks(&self, verb: Verb) -> Vec<Lack> {
        let mut lacks = Vec::new();
        if self.kind == SceneKind::GearPair && matches!(verb, Verb::Rules | Verb::Compare) {
            lacks.push(lack("kind", "one mesh alone is \"gear_pair\": \"planetary\" is needed"));
            return lacks;
        }
        let is_at_rest = matches!(verb, Verb::Mesh | Verb::Static);
        if self.pair == Some(MeshKind::RingPlanet) && !is_at_rest {
            let why = "it is \"ring_planet\": of gear pairs only \"sun_planet\" has modes and motion in time; mesh and static run";
            lacks.push(lack("mesh", why));
            return lacks;
        }
        if let Some(auto) = self.dynamics.auto {
            let (quantity, own) = auto.quantity.names();
            if verb == Verb::Modes && own == "modes" {
                self.lacks_for_auto(&mut lacks);
                self.lacks_no_gyroscopic(&mut lacks);
                return lacks;
            }
            let is_chosen = own == "sweep" && matches!(verb, Verb::Sweep(_));
            let names_one =
                matches!(verb, Verb::Modes | Verb::Impulse | Verb::Sweep(_) | Verb::Branches(_));
            if names_one && !is_chosen {
                let why = format!(
                    "\"auto\" chooses settings for {quantity}, which `{own}` gives: name the fidelity here"
                );
                lacks.push(lack("dynamics.fidelity", why));
            }
            if is_chosen || own == "static" && verb == Verb::Static {
                self.lacks_planetary(&mut lacks);
                self.lacks_turning_sun(&mut lacks);
            }
            if is_chosen {
                self.lacks_no_gyroscopic(&mut lacks);
            }
        }
        match verb {
            Verb::Modes | Verb::Compare if self.has_closed_forms() => {
                self.lacks_closed_forms(&mut lacks);
            }
            Verb::Modes | Verb::Compare => {
                if self.lumped.is_none() {
                    lacks.push(lack(
                        "lumped",
                        "masses, inertias and mesh stiffnesses of the lumped model; of a planetary set with [geometry] they follow from it, and of one mesh `epicyclic mesh` computes masses and inertias, `epicyclic static` the mesh stiffness",
                    ));
                }
            }
            Verb::Rules => {
                if self.teeth.and_then(|t| t.sun_ring()).is_none() {
                    lacks.push(lack("teeth", "mesh phases follow from the numbers of teeth"));
                }
            }
            Verb::Mesh => self.lacks_bodies(&mut lacks),
            Verb::Static => {
                self.lacks_bodies(&mut lacks);
                match self.kind {
                    SceneKind::GearPair if self.pair_force_n().is_some() => {}
                    SceneKind::GearPair => {
                        let (key, why) = match self.pair {
                            Some(MeshKind::RingPlanet) => (
                                "operation",
                                "one mesh alone is loaded by a normal force, which no key gives",
                            ),
                            _ => (
                                "operation.torque_nm",
                                "a torque other than 0 loads the teeth by |T|/r_b",
                            ),
                        };
                        let argument = Some("--normal-force-n");
                        lacks.push(Lack { argument, ..lack(key, why) });
                    }
                    SceneKind::Planetary => {
                        self.lacks_torque(&mut lacks);
                        self.lacks_torque_path(&mut lacks);
                        self.lacks_floating(&mut lacks);
                    }
                }
                self.lacks_equal_planets(&mut lacks);
            }
            Verb::Impulse => {
                self.lacks_bodies(&mut lacks);
                self.lacks_torque(&mut lacks);
                self.lacks_torque_path(&mut lacks);
                self.lacks_floating(&mut lacks);
                self.lacks_carrier_mass(&mut lacks);
                self.lacks_equal_planets(&mut lacks);
                self.lacks_elastic_pair(self.dynamics.fidelity, &mut lacks);
                if self.dynamics.fidelity == Fidelity::MeshLaw {
                    let why = "\"mesh_law\" solves no contact: \"quasi_static\", \"modal\" or \"full\" is needed";
                    lacks.push(lack("dynamics.fidelity", why));
                }
            }
            Verb::Sweep(fidelity) | Verb::Branches(fidelity) => {
                if verb == Verb::Branches(Fidelity::Full) {
                    let why = "\"full\" has no derivative of its time steps: \"mesh_law\", \"quasi_static\" or \"modal\" is needed";
                    lacks.push(lack("dynamics.fidelity", why));
                }
                if matches!(verb, Verb::Branches(_)) {
                    self.lacks_isolated_motions(fidelity, &mut lacks);
                }
                // A scene cannot name both; what is asked here is whether it would run with another fidelity.
                let is_exact = self.dynamics.kinematics == MeshKinematics::Exact;
                if is_exact && fidelity != Fidelity::QuasiStatic {
                    let why = "it is \"exact\", which only quasi-static bodies follow: \"about_mean\" is needed";
                    lacks.push(lack("dynamics.kinematics", why));
                }
                self.lacks_bodies(&mut lacks);
                if self.operation.is_none() {
                    lacks.push(lack("operation", "it says which member's speed is swept"));
                }
                self.lacks_torque(&mut lacks);
                self.lacks_torque_path(&mut lacks);
                self.lacks_floating(&mut lacks);
                self.lacks_carrier_mass(&mut lacks);
                self.lacks_equal_planets(&mut lacks);
                self.lacks_one_flexibility(fidelity, &mut lacks);
                self.lacks_elastic_pair(fidelity, &mut lacks);
            }
        }
        lacks
    }

    /// Damping, without which periodic motions are not isolated, and time steps that have a derivative.
    fn lacks_isolated_motions(&self, fidelity: Fidelity, lacks: &mut Vec<Lack>) {
        if !self.is_damped() {
            let why = "it is 0, and neither `damping.stiffness_proportional_s` nor `damping.bearing_s` damps the set: one \
                       of them above 0 is needed, because without damping periodic motions are not isolated and make no branch";
            let argument = Some("--over damping.mass_proportional_per_s");
            lacks.push(Lack { argument, ..lack("damping.mass_proportional_per_s", why) });
        }
        if fidelity == Fidelity::QuasiStatic && self.dynamics.kinematics == MeshKinematics::Exact {
            let why =
                "it is \"exact\", whose time steps have no derivative: \"about_mean\" is needed";
            let argument = Some("--model lumped");
            lacks.push(Lack { argument, ..lack("dynamics.kinematics", why) });
        }
    }

    /// Whether a value above 0 of a key would damp the motion.
    pub fn is_damped_by(&self, key: &str) -> bool {
        let of_bearings = key == "damping.bearing_s";
        key.starts_with("damping.") && !(of_bearings && self.is_free_pair())
    }

    /// Whether anything damps the motion; the bearings of a pair whose rotations are both free do not move in it.
    fn is_damped(&self) -> bool {
        let damping = self.damping;
        damping.mass_proportional_per_s > 0.0
            || damping.stiffness_proportional_s > 0.0
            || damping.bearing_s > 0.0 && !self.is_free_pair()
    }

    /// Teeth, races and fillets of the gears that are meshed.
    fn lacks_bodies(&self, lacks: &mut Vec<Lack>) {
        let Some(geometry) = &self.geometry else {
            lacks.push(lack("geometry", "teeth are needed to mesh and to touch"));
            return;
        };
        let is_meshed = |kind: MeshKind| self.pair.is_none_or(|pair| pair == kind);
        let gears: [(&str, Option<&GearInput>, &str); 3] = [
            ("sun", geometry.sun.as_ref().filter(|_| is_meshed(MeshKind::SunPlanet)), "bore"),
            ("planet", Some(&geometry.planet), "bore"),
            ("ring", geometry.ring.as_ref().filter(|_| is_meshed(MeshKind::RingPlanet)), "rim"),
        ];
        for (name, gear, body) in gears {
            let Some(gear) = gear else { continue };
            if gear.body_radius_m.is_none() {
                let key = format!("geometry.{name}.{body}_diameter_mm");
                lacks.push(lack(key, "it is the rigid race of the finite-element body"));
            }
            if gear.fillet_radius_m <= 0.0 {
                let key = format!("geometry.{name}.fillet_radius_mm");
                lacks.push(lack(key, "above 0: stresses at a sharp root have no limit"));
            }
        }
    }

    /// A planetary set, of which alone errors are estimated.
    fn lacks_planetary(&self, lacks: &mut Vec<Lack>) {
        if self.kind == SceneKind::GearPair {
            let why =
                "fidelity = \"auto\" estimates errors of planetary sets: \"planetary\" is needed";
            lacks.push(lack("kind", why));
        }
    }

    /// A torque that acts on the sun, whose motion alone is the quantity that errors are estimated of.
    fn lacks_turning_sun(&self, lacks: &mut Vec<Lack>) {
        if self.kind == SceneKind::Planetary
            && self.loaded_member().is_ok_and(|loaded| loaded != Member::Sun)
        {
            let why = "the torque acts on another member: with fidelity = \"auto\" errors are estimated of sets whose sun turns";
            lacks.push(lack("sun.motion", why));
        }
    }

    /// A planetary set with teeth, under a torque by keys alone: `modes` has no argument for it.
    fn lacks_for_auto(&self, lacks: &mut Vec<Lack>) {
        self.lacks_planetary(lacks);
        if self.kind == SceneKind::GearPair {
            return;
        }
        self.lacks_bodies(lacks);
        self.lacks_torque(lacks);
        self.lacks_torque_path(lacks);
        self.lacks_turning_sun(lacks);
        self.lacks_carrier_mass(lacks);
        self.lacks_equal_planets(lacks);
        lacks.iter_mut().for_each(|lack| lack.argument = None);
    }

    /// Bodies and a torque by keys, from which parameters in closed form follow.
    fn lacks_closed_forms(&self, lacks: &mut Vec<Lack>) {
        let before = lacks.len();
        self.lacks_bodies(lacks);
        self.lacks_torque(lacks);
        self.lacks_torque_path(lacks);
        self.lacks_carrier_mass(lacks);
        for lack in &mut lacks[before..] {
            lack.argument = None;
            lack.why += "; or numbers in [lumped], which are then taken from there";
        }
    }

    /// No gyroscopic terms, which no estimate of an error covers.
    fn lacks_no_gyroscopic(&self, lacks: &mut Vec<Lack>) {
        if self.dynamics.gyroscopic {
            let why = "it is \"on\": \"off\" is needed, because \"auto\" estimates errors of a set without gyroscopic terms";
            lacks.push(lack("dynamics.gyroscopic", why));
        }
    }

    fn lacks_torque(&self, lacks: &mut Vec<Lack>) {
        if self.operation.is_none_or(|operation| operation.torque_nm == 0.0) {
            let argument = Some("--sun-torque-nm");
            lacks.push(Lack {
                argument,
                ..lack("operation.torque_nm", "a torque other than 0 loads the teeth")
            });
        }
    }

    fn lacks_torque_path(&self, lacks: &mut Vec<Lack>) {
        if let Err(e) = self.torque_path() {
            lacks.push(lack(
                e.key,
                format!("it is \"{}\": allowed is {}, because {}", e.value, e.allowed, e.why),
            ));
        }
    }

    /// Each mesh holds a member along its line of action alone: less than three do not hold its centre.
    fn lacks_floating(&self, lacks: &mut Vec<Lack>) {
        if self.kind == SceneKind::GearPair || self.planets.count() > 2 {
            return;
        }
        let members = [("sun", &self.supports.sun), ("ring", &self.supports.ring)];
        for (name, support) in members {
            if support.motion.translates() && support.bearing_n_per_m == 0.0 {
                let why = "above 0: the meshes of one planet, or of two, do not hold its centre";
                lacks.push(lack(format!("{name}.bearing_n_per_m"), why));
            }
        }
    }

    /// The carrier's mass, from its shape or from the lumped parameters.
    fn lacks_carrier_mass(&self, lacks: &mut Vec<Lack>) {
        let has_shape = self.geometry.as_ref().is_some_and(|g| g.carrier.is_some());
        let has_mass = self.lumped.as_ref().is_some_and(|l| l.mass_kg.carrier.is_some());
        if !has_shape && !has_mass && self.supports.carrier.motion != Freedom::Held {
            let why = "the carrier can move and has no mass: give its shape, or `lumped.mass_kg.carrier`, or \
                       `carrier.motion` = \"held\"";
            lacks.push(lack("geometry.carrier", why));
        }
    }

    /// Planets that differ in nothing but their bearings: masses and mesh stiffnesses of single planets are those
    /// of the lumped model, and finite-element planets are meshed alike.
    fn lacks_equal_planets(&self, lacks: &mut Vec<Lack>) {
        for (i, planet) in self.overrides.iter().enumerate() {
            let PlanetOverride {
                planet: _,
                mass_kg,
                inertia_over_r2_kg,
                bearing_n_per_m: _,
                sun_mesh_n_per_m,
                ring_mesh_n_per_m,
            } = *planet;
            let given = [
                ("mass_kg", mass_kg),
                ("inertia_over_r2_kg", inertia_over_r2_kg),
                ("sun_planet_n_per_m", sun_mesh_n_per_m),
                ("ring_planet_n_per_m", ring_mesh_n_per_m),
            ];
            for (key, _) in given.into_iter().filter(|(_, value)| value.is_some()) {
                let why = "nothing: it is of the lumped model (modes, compare) and would change nothing here, where all planets \
                           are meshed alike and differ in `bearing_n_per_m` alone";
                lacks.push(lack(format!("planet_override.{i}.{key}"), why));
            }
        }
    }

    /// A held or sprung rotation, and inertias of the meshes, of a pair whose gears have elastic states.
    fn lacks_elastic_pair(&self, fidelity: Fidelity, lacks: &mut Vec<Lack>) {
        let Some(pair) = &self.supports.pair else { return };
        if !matches!(fidelity, Fidelity::Modal(_) | Fidelity::Full) {
            return;
        }
        if self.is_free_pair() {
            let why = "above 0, or `sun.torsional_nm_per_rad`, or `planet.motion` = \"rotation_held\": with both rotations \
                       free only \"quasi_static\" and \"mesh_law\" compute the relative rotation alone";
            lacks.push(lack("planet.torsional_nm_per_rad", why));
        }
        for (name, given) in [("sun", pair.sun_inertia), ("planet", pair.planet_inertia)] {
            let keys = [("mass_kg", given.mass_kg), ("inertia_kg_m2", given.inertia_kg_m2)];
            for (key, _) in keys.into_iter().filter(|(_, value)| value.is_some()) {
                let why = "nothing: at \"modal\" and \"full\" masses and inertias follow from the finite-element meshes";
                lacks.push(lack(format!("{name}.{key}"), why));
            }
        }
    }

    /// Factors of 1 where elastic states of a body act in several meshes at once.
    fn lacks_one_flexibility(&self, fidelity: Fidelity, lacks: &mut Vec<Lack>) {
        if fidelity == Fidelity::QuasiStatic {
            return;
        }
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            if self.fe_contact.flexibility_factor.of(kind) != 1.0 {
                let key = format!("fe_contact.flexibility_factor.{}", kind.name());
                lacks.push(lack(
                    key,
                    "1: a planet that vibrates within itself cannot be softer for one mesh alone",
                ));
            }
        }
    }
}
