//! What can be asked of a model of a gear set, whoever wrote it.
//!
//! A model that answers one of these questions can be judged by every suite of checks that asks it, beside the
//! two models of this project: implement the trait in a crate of your own. Errors travel as they are.

use gearset::{LoadCase, Scene};

use crate::mesh_cycle::MeshCycle;
use crate::natural_mode::NaturalMode;
use crate::sweep::SteadyState;

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
}
