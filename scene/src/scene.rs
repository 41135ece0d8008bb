//! The scene: plain types, SI units, everything one run needs to know about a gear set.

use gearset::{Body, GeometryInput, MeshKind, Operation, PlanetPositions, Teeth};
use serde::{Deserialize, Serialize};

use crate::choices::{DynamicsInput, FeContactInput, PlaneState};

/// What the scene describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SceneKind {
    /// A whole planetary set.
    Planetary,
    /// One mesh alone: sun–planet or ring–planet. The bearings of its gears stand still; the gear called sun drives.
    GearPair,
}

/// A validated scene. Lengths in m, angles in rad, masses in kg, stiffnesses in N/m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Whole set or one mesh.
    pub kind: SceneKind,
    /// The mesh of a gear pair.
    pub pair: Option<MeshKind>,
    /// What the set is called.
    pub title: String,
    /// Where its numbers come from.
    pub source: Option<String>,
    /// Planet positions.
    pub planets: PlanetPositions,
    /// Numbers of teeth; absent in parameter-only sets.
    pub teeth: Option<Teeth>,
    /// Tooth geometry as given; absent in parameter-only sets.
    pub geometry: Option<GeometryInput>,
    /// Elastic constants and density.
    pub material: Material,
    /// How the members are held.
    pub supports: Supports,
    /// Parameters of the lumped model; absent if the scene is for FE/contact only.
    pub lumped: Option<LumpedInput>,
    /// Planets that differ from the others.
    pub overrides: Vec<PlanetOverride>,
    /// Proportional damping.
    pub damping: Damping,
    /// Speed and torque.
    pub operation: Option<Operation>,
    /// Choices of the FE/contact model.
    pub fe_contact: FeContactInput,
    /// Choices for simulation in time.
    pub dynamics: DynamicsInput,
}

/// Elastic constants and density.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// E, Pa.
    pub young_modulus_pa: f64,
    /// ν.
    pub poisson_ratio: f64,
    /// ρ, kg/m³.
    pub density_kg_per_m3: f64,
}

impl Material {
    /// E (Pa) and ν of the plane-strain body that behaves as this one does in a state of the plane: plane stress is
    /// plane strain with E (1+2ν)/(1+ν)² and ν/(1+ν).
    pub fn plane_strain_equivalent(&self, plane: PlaneState) -> (f64, f64) {
        let (e, nu) = (self.young_modulus_pa, self.poisson_ratio);
        match plane {
            PlaneState::Strain => (e, nu),
            PlaneState::Stress => (e * (1.0 + 2.0 * nu) / (1.0 + nu).powi(2), nu / (1.0 + nu)),
        }
    }
}

/// How a central member may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Freedom {
    /// Translates and rotates.
    Free,
    /// Translates; its rotation is held.
    RotationHeld,
    /// Rotates; rigid bearings hold its centre. Only gears of a pair.
    CentreHeld,
    /// Does not move.
    Held,
}

impl Freedom {
    /// Whether the centre can move.
    pub fn translates(self) -> bool {
        matches!(self, Self::Free | Self::RotationHeld)
    }

    /// Whether the member can turn.
    pub fn rotates(self) -> bool {
        matches!(self, Self::Free | Self::CentreHeld)
    }
}

/// Support of one central member.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// Which coordinates exist.
    pub motion: Freedom,
    /// Bearing stiffness, equal in both directions, N/m.
    pub bearing_n_per_m: f64,
    /// Torsional stiffness, if any.
    pub torsional: Torsional,
}

impl Support {
    /// A member that cannot move.
    pub const HELD: Self =
        Self { motion: Freedom::Held, bearing_n_per_m: 0.0, torsional: Torsional::PerLength(0.0) };

    /// Whether nothing holds the rotation: neither a support nor a torsional spring.
    pub fn turns_freely(&self) -> bool {
        let (Torsional::PerLength(k) | Torsional::PerAngle(k)) = self.torsional;
        self.motion.rotates() && k == 0.0
    }
}

/// Torsional stiffness of a central member.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Torsional {
    /// Per u = r·θ, N/m.
    PerLength(f64),
    /// Per θ, N·m/rad.
    PerAngle(f64),
}

/// Supports of all members.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Supports {
    /// Carrier.
    pub carrier: Support,
    /// Ring.
    pub ring: Support,
    /// Sun.
    pub sun: Support,
    /// Stiffness between each planet and the carrier, N/m.
    pub planet_bearing_n_per_m: f64,
    /// Mass and inertia fixed to each planet's rigid race.
    pub planet_added: AddedMass,
    /// What only a gear pair has; `None` for a set.
    pub pair: Option<PairSupports>,
}

/// The gears of a sun–planet pair in time, beyond the sun's support.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PairSupports {
    /// Support of the planet, to ground.
    pub planet: Support,
    /// Mass and inertia of the sun with its shaft.
    pub sun_inertia: GivenInertia,
    /// Mass and inertia of the planet with its shaft.
    pub planet_inertia: GivenInertia,
}

/// Mass and inertia of a gear with its shaft; what is `None` follows from the finite-element mesh of the gear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct GivenInertia {
    /// Mass, kg.
    pub mass_kg: Option<f64>,
    /// Polar inertia about the centre, kg m².
    pub inertia_kg_m2: Option<f64>,
}

/// A rigid piece fixed to a race, centred on it; none by default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct AddedMass {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Polar inertia about its centre, kg m².
    pub inertia_kg_m2: f64,
}

/// One value for each kind of body; `None` where the scene gives none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PerBody {
    /// Carrier.
    pub carrier: Option<f64>,
    /// Ring.
    pub ring: Option<f64>,
    /// Sun.
    pub sun: Option<f64>,
    /// Planet.
    pub planet: Option<f64>,
}

impl PerBody {
    /// The value of a body.
    pub fn of(&self, body: Body) -> Option<f64> {
        match body {
            Body::Carrier => self.carrier,
            Body::Ring => self.ring,
            Body::Sun => self.sun,
            Body::Planet(_) => self.planet,
        }
    }

    /// The values with the names of the bodies in scene files.
    pub fn by_name(&self) -> [(&'static str, Option<f64>); 4] {
        let Self { carrier, ring, sun, planet } = *self;
        [("carrier", carrier), ("ring", ring), ("sun", sun), ("planet", planet)]
    }
}

/// One value for each kind of mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PerMesh {
    /// Sun–planet.
    pub sun_planet: f64,
    /// Ring–planet.
    pub ring_planet: f64,
}

impl PerMesh {
    /// The value of one kind of mesh.
    pub fn of(&self, kind: MeshKind) -> f64 {
        match kind {
            MeshKind::SunPlanet => self.sun_planet,
            MeshKind::RingPlanet => self.ring_planet,
        }
    }
}

/// Parameters of the Lin–Parker model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LumpedInput {
    /// Masses, kg.
    pub mass_kg: PerBody,
    /// I/r² of each body, kg (r: base radius; for the carrier the centre distance).
    pub inertia_over_r2_kg: PerBody,
    /// Radii r in u = r·θ, m, where known.
    pub radius_m: PerBody,
    /// Constant mesh stiffnesses, N/m; 0 for the ring–planet mesh of a gear pair, which has none.
    pub mesh_n_per_m: PerMesh,
    /// Operating pressure angles, rad, from the geometry or as given; 0 as above.
    pub pressure_angle_rad: PerMesh,
}

/// One planet that differs from the others; `None` keeps the common value.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanetOverride {
    /// Index n of the planet.
    pub planet: usize,
    /// Mass, kg.
    pub mass_kg: Option<f64>,
    /// I/r², kg.
    pub inertia_over_r2_kg: Option<f64>,
    /// Bearing stiffness, N/m.
    pub bearing_n_per_m: Option<f64>,
    /// Sun–planet mesh stiffness, N/m.
    pub sun_mesh_n_per_m: Option<f64>,
    /// Ring–planet mesh stiffness, N/m.
    pub ring_mesh_n_per_m: Option<f64>,
}

/// Proportional damping C = αM + βK.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Damping {
    /// α, 1/s.
    pub mass_proportional_per_s: f64,
    /// β, s.
    pub stiffness_proportional_s: f64,
    /// Viscous damping of every bearing over its stiffness, s.
    pub bearing_s: f64,
}

impl Damping {
    /// Every damping multiplied by a factor.
    pub fn times(self, factor: f64) -> Self {
        Self {
            mass_proportional_per_s: factor * self.mass_proportional_per_s,
            stiffness_proportional_s: factor * self.stiffness_proportional_s,
            bearing_s: factor * self.bearing_s,
        }
    }
}

impl Scene {
    /// A copy to be modified, with `what` added to the title: recorded results are found by title, and must
    /// not be taken for those of the modified set.
    pub fn variant(&self, what: &str) -> Self {
        Self { title: format!("{}: {what}", self.title), ..self.clone() }
    }

    /// Whether the scene is a gear pair with neither gear's rotation held or sprung. The rotation of both gears
    /// without relative motion then has no stiffness; in time only the relative rotation is computed.
    pub fn is_free_pair(&self) -> bool {
        let pair = self.supports.pair;
        pair.is_some_and(|pair| pair.planet.turns_freely() && self.supports.sun.turns_freely())
    }

    /// Whether parameters of the lumped model follow from the geometry: those of a planetary set that gives none.
    pub fn has_closed_forms(&self) -> bool {
        self.kind == SceneKind::Planetary && self.lumped.is_none() && self.geometry.is_some()
    }

    /// What the scene lacks and what therefore cannot be computed, one entry each.
    pub fn limits(&self) -> Vec<String> {
        let mut limits = Vec::new();
        if self.kind == SceneKind::GearPair {
            limits.push("one mesh alone: no excitation rules".to_owned());
            if self.pair == Some(MeshKind::RingPlanet) {
                limits.push("a ring–planet pair: statics only".to_owned());
            } else {
                if self.lumped.is_none() {
                    limits.push("no [lumped]: no lumped natural modes".to_owned());
                }
                if self.operation.is_none() {
                    limits.push("no [operation]: no speed or mesh frequency of its own".to_owned());
                }
            }
        } else {
            if self.teeth.is_none() {
                limits.push("no [teeth]: no mesh phases, excitation rules or speeds".to_owned());
            }
            if self.lumped.is_none() && self.geometry.is_none() {
                limits.push("no [lumped]: no lumped natural modes".to_owned());
            }
            if self.operation.is_none() {
                limits.push("no [operation]: no speed or mesh frequency of its own".to_owned());
            }
        }
        if self.geometry.is_none() {
            limits.push("no [geometry]: no contact ratios, γ, tooth contact or FE".to_owned());
        }
        limits
    }
}
