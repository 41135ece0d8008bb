//! What a scene says about results on it.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use gearset::{Facing, MeshKind, Phasing};
use lumped::{LumpedModel, NaturalModes};
use scene::{Freedom, LoadCase, Scene, SceneKind, Torsional};

use crate::model_kind::ModelKind;
use crate::results::known_scenes::KnownScene;

/// Phases closer than this, in cycles, are one.
const SAME_PHASE: f64 = 1e-6;

/// Facts about the scenes of a folder, each found when it is first asked for.
pub(in crate::results) struct Facts {
    /// Whether frequencies are those of rotations alone.
    is_torsional: bool,
    found: HashMap<String, Rc<SceneFacts>>,
}

/// Facts about one scene.
pub(super) struct SceneFacts {
    /// Number of planets N.
    pub(super) planets: usize,
    /// Base radius of the sun, m.
    pub(super) sun_base_radius: Option<f64>,
    /// Mesh frequency of one rpm of the driven member, Hz.
    pub(super) mesh_frequency_per_rpm_hz: Option<f64>,
    /// Whether the sun turns freely and neither ring nor carrier does: it then turns with its torque at rest.
    pub(super) sun_alone_turns: bool,
    /// Whether meshes of that kind carry the whole torque.
    pub(super) carries_all: [bool; 2],
    /// Natural frequencies of the lumped model, or of its limit of rotations alone, Hz, ascending, each as often as it
    /// occurs; empty without parameters.
    pub(super) lumped_hz: Vec<f64>,
    /// Phases of the sun meshes, cycles; empty without geometry.
    phases: Vec<f64>,
}

impl Facts {
    /// For results of a model of that kind.
    pub(in crate::results) fn new(kind: Option<ModelKind>) -> Self {
        Self { is_torsional: kind == Some(ModelKind::Torsional), found: HashMap::new() }
    }

    pub(super) fn about(&mut self, known: &Arc<KnownScene>) -> Rc<SceneFacts> {
        let make = || Rc::new(SceneFacts::new(&known.scene, self.is_torsional));
        self.found.entry(known.id.clone()).or_insert_with(make).clone()
    }
}

impl SceneFacts {
    fn new(scene: &Scene, is_torsional: bool) -> Self {
        let geometry = scene.tooth_geometry().ok();
        let sun = geometry.as_ref().and_then(|geometry| geometry.sun.as_ref());
        let radius = scene.lumped.as_ref().and_then(|lumped| lumped.radius_m.sun);
        let phasing = geometry.as_ref().and_then(|g| Phasing::new(g, &scene.planets));
        let phases = phasing.map(|p| p.phases(0.0, Facing::CounterClockwise).sun_planet);
        let case = LoadCase::of_scene(scene).ok();
        let per_rpm = case.map(|case| case.mesh_frequency_per_rpm_hz());
        let limit = |model: LumpedModel| if is_torsional { model.torsional() } else { model };
        let model = LumpedModel::from_scene(scene).map(limit);
        let modes = model.and_then(|model| NaturalModes::of(&model));
        let mut lumped_hz = Vec::new();
        for group in modes.iter().flat_map(|modes| &modes.groups) {
            lumped_hz.extend(std::iter::repeat_n(group.frequency_hz, group.multiplicity));
        }
        lumped_hz.sort_by(f64::total_cmp);
        let is_sprung = |torsional| {
            let (Torsional::PerLength(k) | Torsional::PerAngle(k)) = torsional;
            k != 0.0
        };
        let supports = &scene.supports;
        let unsprung =
            ![supports.sun.torsional, supports.ring.torsional].into_iter().any(is_sprung);
        let has_mesh = |kind| scene.kind == SceneKind::Planetary || scene.pair == Some(kind);
        let carries_all =
            [MeshKind::SunPlanet, MeshKind::RingPlanet].map(|kind| unsprung && has_mesh(kind));
        Self {
            planets: scene.planets.count(),
            sun_base_radius: sun.map(|sun| sun.base_radius).or(radius),
            mesh_frequency_per_rpm_hz: per_rpm.filter(|hz| *hz > 0.0),
            sun_alone_turns: scene.kind == SceneKind::Planetary
                && supports.sun.motion.rotates()
                && ![supports.ring.motion, supports.carrier.motion]
                    .into_iter()
                    .any(Freedom::rotates),
            carries_all,
            lumped_hz,
            phases: phases.unwrap_or_default(),
        }
    }

    /// Whether meshes of two planets run alike, so that their results may agree to the last digit.
    pub(super) fn are_in_phase(&self, a: usize, b: usize) -> bool {
        let Some((a, b)) = self.phases.get(a).zip(self.phases.get(b)) else { return false };
        let apart = (a - b).rem_euclid(1.0);
        apart.min(1.0 - apart) < SAME_PHASE
    }
}
