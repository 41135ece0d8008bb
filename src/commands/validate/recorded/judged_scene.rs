//! Which scenes tables are about, and with which parameters.

use scene::{Freedom, PerBody, Scene, Torsional};
use schemars::JsonSchema;
use serde::Serialize;
use validation::certified::sha256;
use validation::results::{KnownScene, ResultsFolder};

/// A scene of some tables.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct JudgedScene {
    /// By which tables may call it.
    pub(super) id: String,
    pub(super) title: String,
    /// Places ψ_n of the planets, degrees.
    pub(super) planets_deg: Vec<f64>,
    /// Torques on the sun in the tables, ascending, N m.
    pub(super) sun_torques_nm: Vec<f64>,
    /// Whether `modes.csv` has the type of every mode; none without natural frequencies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) types_given: Option<bool>,
    /// Whether it has the multiplicity of every frequency.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) multiplicities_given: Option<bool>,
    /// Members that cannot move in some way, in words.
    pub(super) held: Vec<String>,
    pub(super) parameters: Vec<Parameter>,
    /// SHA-256 of the scene with its keys in order, as `Scene::to_toml` writes it, hexadecimal.
    pub(super) sha256: String,
}

/// One quantity of the bodies; of meshes it stands at the sun and at the ring.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct Parameter {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    /// Of carrier, ring, sun and planet, where they have it.
    pub(super) values: [Option<f64>; 4],
}

impl JudgedScene {
    /// Of all tables, by id.
    pub(super) fn of_folder(folder: &ResultsFolder) -> Vec<Self> {
        let mut scenes: Vec<Self> = Vec::new();
        let mut place = |known: &KnownScene| {
            let found = scenes.iter().position(|scene| scene.id == known.id);
            found.unwrap_or_else(|| {
                scenes.push(Self::new(known));
                scenes.len() - 1
            })
        };
        let modes: Vec<usize> = folder.modes.iter().map(|row| place(&row.scene)).collect();
        let mut loads: Vec<(usize, f64)> = Vec::new();
        let cycles = folder.mesh_cycle.iter().map(|row| (&row.scene, row.sun_torque_nm));
        let stiffness = folder.mesh_stiffness.iter().map(|row| (&row.scene, row.sun_torque_nm));
        let states = folder.steady_states.iter().map(|row| (&row.scene, row.sun_torque_nm));
        let peaks = folder.torque_peaks.iter().map(|row| (&row.scene, row.peak.sun_torque_nm));
        for (scene, torque) in cycles.chain(stiffness).chain(states).chain(peaks) {
            loads.push((place(scene), torque));
        }
        for row in &folder.rules {
            place(&row.scene);
        }
        for (row, at) in folder.modes.iter().zip(modes) {
            let scene = &mut scenes[at];
            let and = |so_far: Option<bool>, given: bool| Some(so_far.unwrap_or(true) && given);
            scene.types_given = and(scene.types_given, row.mode_type.is_some());
            scene.multiplicities_given =
                and(scene.multiplicities_given, row.multiplicity.is_some());
        }
        for (at, torque) in loads {
            let list = &mut scenes[at].sun_torques_nm;
            if let Err(place) = list.binary_search_by(|known| known.total_cmp(&torque)) {
                list.insert(place, torque);
            }
        }
        scenes.sort_by(|a, b| a.id.cmp(&b.id));
        scenes
    }

    /// Planets, torques, what is held and what `modes.csv` gives, in sentences.
    pub(super) fn words(&self) -> String {
        let listed = |numbers: &[f64], unit: &str| {
            let all: Vec<String> =
                numbers.iter().map(|x| format!("{}", (1e4 * x).round() / 1e4)).collect();
            format!("{}{unit}", all.join(", "))
        };
        let mut sentences = vec![format!("Planets at {}.", listed(&self.planets_deg, "°"))];
        if !self.sun_torques_nm.is_empty() {
            sentences.push(format!("Torque on the sun {}.", listed(&self.sun_torques_nm, " N·m")));
        }
        if !self.held.is_empty() {
            sentences.push(format!("Held: {}.", self.held.join(", ")));
        }
        if let Some((types, multiplicities)) = self.types_given.zip(self.multiplicities_given) {
            let word = |given| if given { "given" } else { "not given for every row" };
            sentences.push(format!(
                "In modes.csv types are {}, multiplicities {}.",
                word(types),
                word(multiplicities)
            ));
        }
        sentences.join(" ")
    }

    fn new(known: &KnownScene) -> Self {
        let scene = &known.scene;
        let supports = [
            ("carrier", scene.supports.carrier),
            ("ring", scene.supports.ring),
            ("sun", scene.supports.sun),
        ];
        let held = supports.iter().filter_map(|(name, support)| match support.motion {
            Freedom::Free => None,
            Freedom::RotationHeld => Some(format!("rotation of the {name}")),
            Freedom::CentreHeld => Some(format!("centre of the {name}")),
            Freedom::Held => Some((*name).to_owned()),
        });
        Self {
            id: known.id.clone(),
            title: scene.title.clone(),
            planets_deg: scene.planets.psi_rad.iter().map(|psi| psi.to_degrees()).collect(),
            sun_torques_nm: Vec::new(),
            types_given: None,
            multiplicities_given: None,
            held: held.collect(),
            parameters: parameters(scene),
            sha256: sha256(scene.to_toml().as_bytes()),
        }
    }
}

/// What the scene says of its bodies; stiffnesses of members that are held have no meaning.
fn parameters(scene: &Scene) -> Vec<Parameter> {
    let mut list = Vec::new();
    let mut add = |name, unit, values: [Option<f64>; 4]| {
        if values.iter().any(Option::is_some) {
            list.push(Parameter { name, unit, values });
        }
    };
    let teeth = scene.teeth;
    let count = |z: Option<u32>| z.map(f64::from);
    add(
        "teeth",
        "",
        [
            None,
            count(teeth.and_then(|z| z.ring)),
            count(teeth.and_then(|z| z.sun)),
            count(teeth.map(|z| z.planet)),
        ],
    );
    if let Some(lumped) = &scene.lumped {
        let bodies = |b: PerBody| [b.carrier, b.ring, b.sun, b.planet];
        add("mass", "kg", bodies(lumped.mass_kg));
        add("inertia over r²", "kg", bodies(lumped.inertia_over_r2_kg));
        let mesh = &lumped.mesh_n_per_m;
        add("mesh stiffness", "N/m", [None, Some(mesh.ring_planet), Some(mesh.sun_planet), None]);
    }
    let supports = [scene.supports.carrier, scene.supports.ring, scene.supports.sun];
    let bearing = supports.map(|s| s.motion.translates().then_some(s.bearing_n_per_m));
    let planet = Some(scene.supports.planet_bearing_n_per_m);
    add("bearing stiffness", "N/m", [bearing[0], bearing[1], bearing[2], planet]);
    let torsional = |of: fn(Torsional) -> Option<f64>| {
        let turning = supports.map(|s| of(s.torsional).filter(|k| *k != 0.0 && s.motion.rotates()));
        [turning[0], turning[1], turning[2], None]
    };
    let per_length = |torsional| match torsional {
        Torsional::PerLength(k) => Some(k),
        Torsional::PerAngle(_) => None,
    };
    let per_angle = |torsional| match torsional {
        Torsional::PerAngle(k) => Some(k),
        Torsional::PerLength(_) => None,
    };
    add("torsional stiffness per u", "N/m", torsional(per_length));
    add("torsional stiffness per angle", "N·m/rad", torsional(per_angle));
    list
}
