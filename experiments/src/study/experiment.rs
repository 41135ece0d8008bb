//! What is done to a model for one or several quantities, and the work it takes.

use gearset::MeshKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::quantity::WorkKind;
use crate::sweep::Response;

/// What is done to a model under a load; quantities of the same experiment share it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Experiment {
    /// Torque on the sun, N m; that of the study if left out.
    pub(super) sun_torque_nm: Option<f64>,
    pub(super) action: Action,
}

/// What is done to a model.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Action {
    /// Natural modes about the load, at position 0.
    Modes,
    /// A mesh cycle at rest.
    MeshCycle { positions: usize },
    /// One mesh alone at one phase, under the even share of the load.
    Pressure { mesh: MeshKind, phase: f64 },
    /// Steady states over speed, each from the one before, and three more about the highest if refined.
    Peak { speeds_rpm: Vec<f64>, response: Response, harmonic: usize, is_refined: bool },
    /// The same peak under the torque of the experiment and under another one on the sun, N m.
    PeakRatio { peak: Box<Action>, reference_nm: f64 },
    /// A steady state from rest.
    Motion { speed_rpm: f64 },
}

/// Counted work: it depends on the setting and on no clock. What an experiment does not have is 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Work {
    /// Time steps.
    pub steps: f64,
    /// Solutions for the forces of all meshes in these steps.
    pub contact_solutions: f64,
    /// Iterations of equilibrium and of contact at rest.
    pub iterations: f64,
    /// Derivatives of mesh cycles that shooting computed.
    pub derivatives: f64,
    /// Steady states that were marched although shooting was asked for, because it found no stable periodic motion.
    pub marched_instead: f64,
    /// Coordinates that are stepped.
    pub coordinates: f64,
    /// Degrees of freedom of the finite elements of all gears.
    pub fe_unknowns: f64,
    /// Contact cells of one tooth pair.
    pub contact_cells: f64,
    /// Memory of gears once made, contact tables, maps and frames, bytes; estimated from the meshes for the gears,
    /// counted for the rest.
    pub bytes: f64,
}

impl Work {
    /// One number of it.
    pub fn of(&self, kind: WorkKind) -> f64 {
        match kind {
            WorkKind::Steps => self.steps,
            WorkKind::StepCoordinates => self.steps * self.coordinates,
            WorkKind::ContactSolutions => self.contact_solutions,
            WorkKind::Iterations => self.iterations,
            WorkKind::Derivatives => self.derivatives,
            WorkKind::FeUnknowns => self.fe_unknowns,
            WorkKind::ContactCells => self.contact_cells,
            WorkKind::Bytes => self.bytes,
        }
    }
}

impl WorkKind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Steps => "time steps",
            Self::StepCoordinates => "time steps × coordinates",
            Self::ContactSolutions => "contact solutions",
            Self::Iterations => "iterations at rest",
            Self::Derivatives => "derivatives of cycles",
            Self::FeUnknowns => "FE degrees of freedom",
            Self::ContactCells => "contact cells of a pair",
            Self::Bytes => "bytes",
        }
    }
}
