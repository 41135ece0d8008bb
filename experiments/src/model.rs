//! What can be asked of a model of a gear set, whoever wrote it.
//!
//! A model that answers one of these questions can be judged by every suite of checks that asks it, beside the
//! two models of this project: implement the trait in a crate of your own. Errors travel as they are.

use gearset::MeshKind;
use scene::{LoadCase, Scene};

use crate::mesh_cycle::MeshCycle;
use crate::mesh_stiffness::MeshStiffness;
use crate::natural_mode::NaturalMode;
use crate::sweep::SteadyState;
use crate::torque::TorquePeak;

/// Why a model could not answer: any error, kept as it is.
pub type ModelError = Box<dyn std::error::Error + Send + Sync>;

/// A model that has natural frequencies.
pub trait ModalModel {
    /// Natural modes of a set linearised about the load case, in any order; modes that occur twice are listed
    /// twice, rigid-body motion with 0 Hz.
    ///
    /// # Errors
    /// Whatever keeps the model from an answer.
    fn natural_modes(&self, scene: &Scene, case: &LoadCase)
    -> Result<Vec<NaturalMode>, ModelError>;
}

/// A model that has a static deflection.
pub trait StaticModel {
    /// Static equilibrium at `positions` even positions of one mesh cycle under the torque of the load case;
    /// position 0 is where the pair of planet 0's sun mesh that carries the counter-clockwise flank enters
    /// contact, or any other that is the same for all torques.
    ///
    /// # Errors
    /// Whatever keeps the model from an answer.
    fn mesh_cycle(
        &self,
        scene: &Scene,
        case: &LoadCase,
        positions: usize,
    ) -> Result<MeshCycle, ModelError>;
}

/// A model that has a mesh stiffness.
pub trait MeshStiffnessModel {
    /// Secant stiffness of that mesh of planet 0 at `positions` even positions of one mesh cycle or more, under the
    /// load that the torque of the load case puts on one planet.
    ///
    /// # Errors
    /// Whatever keeps the model from an answer.
    fn mesh_stiffness(
        &self,
        scene: &Scene,
        case: &LoadCase,
        kind: MeshKind,
        positions: usize,
    ) -> Result<MeshStiffness, ModelError>;
}

/// A model whose resonant peaks at several torques are known.
pub trait TorquePeakModel {
    /// Resonant peaks of a set at all torques at which they are known, in any order.
    ///
    /// # Errors
    /// Whatever keeps the model from an answer.
    fn torque_peaks(&self, scene: &Scene) -> Result<Vec<TorquePeak>, ModelError>;
}

/// Speeds at which steady states are asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedRequest<'a> {
    /// Speeds of the driven member, ascending, rpm.
    pub speeds_rpm: &'a [f64],
    /// Highest harmonic of the mesh frequency that is read.
    pub harmonics: usize,
    /// Largest change from one mesh cycle to the next, in parts of the largest peak-to-peak vibration, that a
    /// steady state may have left.
    pub tolerance: f64,
}

/// Speeds to be asked for next, rpm, ascending, after all answers so far; `None` ends the questions.
pub type NextSpeeds<'a> = &'a mut dyn FnMut(&[SteadyState]) -> Option<Vec<f64>>;

/// A model that has steady states in time.
pub trait SteadyStateModel {
    /// Steady states under the torque of the load case, ascending in speed. A model that has speeds of its own
    /// (a table) gives those within the range asked for.
    ///
    /// # Errors
    /// Whatever keeps the model from an answer.
    fn steady_states(
        &self,
        scene: &Scene,
        case: &LoadCase,
        request: &SpeedRequest<'_>,
    ) -> Result<Vec<SteadyState>, ModelError>;

    /// Several requests under one load case, each following from the answers before: all answers, ascending in
    /// speed. A model that prepares something for a load case does so once here.
    ///
    /// # Errors
    /// As [`SteadyStateModel::steady_states`].
    fn explore(
        &self,
        scene: &Scene,
        case: &LoadCase,
        (harmonics, tolerance): (usize, f64),
        next: NextSpeeds<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        gather(next, |speeds_rpm| {
            let request = SpeedRequest { speeds_rpm, harmonics, tolerance };
            self.steady_states(scene, case, &request)
        })
    }
}

/// Asks for speeds until none are left, each once; all answers, ascending in speed.
pub(crate) fn gather<E>(
    next: NextSpeeds<'_>,
    ask: impl Fn(&[f64]) -> Result<Vec<SteadyState>, E>,
) -> Result<Vec<SteadyState>, E> {
    let mut all: Vec<SteadyState> = Vec::new();
    while let Some(mut speeds) = next(&all) {
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        if speeds.is_empty() {
            break;
        }
        all.extend(ask(&speeds)?);
        all.sort_by(|a, b| a.case.speed_rpm.total_cmp(&b.case.speed_rpm));
        all.dedup_by(|b, a| a.case.speed_rpm == b.case.speed_rpm);
    }
    Ok(all)
}

/// One request of a model whose own way is [`SteadyStateModel::explore`].
pub(crate) fn one_request(
    model: &dyn SteadyStateModel,
    scene: &Scene,
    case: &LoadCase,
    request: &SpeedRequest<'_>,
) -> Result<Vec<SteadyState>, ModelError> {
    let mut speeds = Some(request.speeds_rpm.to_vec());
    model.explore(scene, case, (request.harmonics, request.tolerance), &mut |_| speeds.take())
}
