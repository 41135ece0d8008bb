//! The FE/contact model, at the fidelity of the scene it is asked about.

use std::sync::Arc;

use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, SetState, StaticSet};
use gearset::{Body, MeshKind};
use scene::{Fidelity, LoadCase, Scene};

use crate::bodies_cache::BodiesCache;
use crate::mesh_cycle::{MeshCycle, RestState};
use crate::modal::{FeMode, ImpulseSettings, Preload, impulse_test, linear_modes, preloaded};
use crate::model::{
    ModalModel, ModelError, NextSpeeds, SpeedRequest, StaticModel, SteadyStateModel, gather,
    one_request,
};
use crate::natural_mode::NaturalMode;
use crate::sweep::{
    Direction, FeModel, Memory, MeshLawModel, Plan, SteadySettings, SteadyState, SweepError,
    SweepModel, run,
};

/// How natural modes are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModalRoute {
    /// Eigenvalues of the set linearised at position 0 of the mesh cycle.
    #[default]
    Linearised,
    /// A virtual impulse test at position 0: modes in its band only.
    ImpulseTest,
}

/// The FE/contact model with the gears of every scene it was asked about.
///
/// ```no_run
/// use experiments::models::FeContact;
/// use experiments::sweep::{Coordinate, Part};
/// use experiments::{SpeedRequest, SteadyStateModel};
/// use scene::{LoadCase, Scene, SceneKind, template};
///
/// let set = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
/// let case = LoadCase::of_scene(&set).unwrap();
/// let request = SpeedRequest { speeds_rpm: &[1600.0], harmonics: 5, tolerance: 1e-6 };
/// let states = FeContact::default().steady_states(&set, &case, &request).unwrap();
/// println!("{:e} rad", states[0].amplitude(Part::SUN, Coordinate::Rotation, 1));
/// ```
#[derive(Debug, Default)]
pub struct FeContact {
    bodies: Arc<BodiesCache>,
    imperfections: Imperfections,
    route: ModalRoute,
}

impl FeContact {
    /// With gears shared with others.
    pub fn sharing(bodies: Arc<BodiesCache>) -> Self {
        Self { bodies, ..Self::default() }
    }

    /// The same with imperfect gears; natural modes stay those of perfect ones.
    pub fn with_imperfections(self, imperfections: Imperfections) -> Self {
        Self { imperfections, ..self }
    }

    /// The same with natural modes found another way.
    pub fn by(self, route: ModalRoute) -> Self {
        Self { route, ..self }
    }

    /// The gears of a scene.
    ///
    /// # Errors
    /// If they cannot be meshed.
    pub fn bodies(&self, scene: &Scene) -> Result<Arc<Bodies>, FeError> {
        self.bodies.of(scene)
    }
}

impl ModalModel for FeContact {
    fn natural_modes(
        &self,
        scene: &Scene,
        case: &LoadCase,
    ) -> Result<Vec<NaturalMode>, ModelError> {
        let bodies = self.bodies(scene)?;
        let modes: Vec<FeMode> = match self.route {
            ModalRoute::Linearised => {
                let preload = Preload { load: *case, position: 0.0, step_s: 5e-6 };
                let set = preloaded(scene, &bodies, &preload)?;
                linear_modes(&set, &set.linearised()?)?
            }
            ModalRoute::ImpulseTest => {
                impulse_test(scene, &bodies, &ImpulseSettings::at(*case, 0.0))?.modes
            }
        };
        Ok(modes.iter().map(NaturalMode::from).collect())
    }
}

impl StaticModel for FeContact {
    fn mesh_cycle(
        &self,
        scene: &Scene,
        case: &LoadCase,
        positions: usize,
    ) -> Result<MeshCycle, ModelError> {
        let bodies = self.bodies(scene)?;
        let set = StaticSet::new(scene, &bodies, case.sense(), self.imperfections.clone())?;
        let cycle = set.cycle(case.sun_load_nm(), positions, &ActiveSet)?;
        Ok(MeshCycle { case: *case, states: cycle.states.iter().map(RestState::from).collect() })
    }
}

impl From<&SetState> for RestState {
    fn from(state: &SetState) -> Self {
        let forces = |kind: MeshKind| {
            state.meshes.iter().filter(|m| m.kind == kind).map(|m| m.force).collect()
        };
        Self {
            position: state.position,
            sun: state.central[Body::Sun.index()],
            sun_mesh_n: forces(MeshKind::SunPlanet),
            ring_mesh_n: forces(MeshKind::RingPlanet),
        }
    }
}

impl SteadyStateModel for FeContact {
    fn steady_states(
        &self,
        scene: &Scene,
        case: &LoadCase,
        request: &SpeedRequest<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        one_request(self, scene, case, request)
    }

    fn explore(
        &self,
        scene: &Scene,
        case: &LoadCase,
        accuracy: (usize, f64),
        next: NextSpeeds<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        let bodies = self.bodies(scene)?;
        let found = if scene.dynamics.fidelity == Fidelity::MeshLaw {
            march(&MeshLawModel::new(scene, &bodies, *case)?, accuracy, next)?
        } else {
            let own = self.imperfections.clone();
            march(&FeModel::new(scene, &bodies, own, *case), accuracy, next)?
        };
        Ok(found)
    }
}

/// Steady states of a model that is marched, ascending in speed.
pub(super) fn march(
    model: &dyn SweepModel,
    (harmonics, tolerance): (usize, f64),
    next: NextSpeeds<'_>,
) -> Result<Vec<SteadyState>, SweepError> {
    let settings =
        SteadySettings { tolerance, harmonics, between_cycles: 0, ..SteadySettings::default() };
    gather(next, |speeds| {
        let plan = Plan::new(speeds, &[Direction::Up], settings.clone())?;
        let sweep = run(model, &plan, &Memory, &|_| ())?.complete()?.steady()?;
        Ok(sweep.states().into_iter().cloned().collect())
    })
}
