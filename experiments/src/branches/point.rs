//! A periodic motion on a branch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sweep::{CriticalMotion, SteadyState};

/// What a point of a branch is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchPointKind {
    /// Any point.
    Regular,
    /// The branch turns back in the parameter: a multiplier is +1.
    Fold,
    /// A multiplier is +1 without a fold: another branch crosses.
    BranchPoint,
    /// A multiplier is −1: motions that repeat after twice as many mesh cycles branch off.
    PeriodDoubling,
    /// Stability changes at a complex pair of multipliers on the unit circle.
    NeimarkSacker,
    /// Multipliers jump across ±1 or the unit circle, where flanks meet or part.
    Kink,
}

impl BranchPointKind {
    /// As tables print it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Fold => "fold",
            Self::BranchPoint => "branch_point",
            Self::PeriodDoubling => "period_doubling",
            Self::NeimarkSacker => "neimark_sacker",
            Self::Kink => "kink",
        }
    }
}

/// A periodic motion, stable or not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BranchPoint {
    /// Harmonics of everything, with speed and load.
    #[serde(flatten)]
    pub state: SteadyState,
    /// Value of what is varied along the branch: speed in rpm, torque on the sun in N m, the factor on the damping, or
    /// a number of the scene in the unit of its key.
    pub parameter: f64,
    /// Factor on every damping of the scene that is varied along the branch; 1 where it is not.
    pub damping_factor: f64,
    /// What the point is.
    pub kind: BranchPointKind,
    /// Whether all multipliers are smaller than 1.
    pub is_stable: bool,
    /// Floquet multipliers of size 1e-3 and above (real and imaginary part) by descending size.
    pub multipliers: Vec<[f64; 2]>,
    /// How the perturbation moves whose multiplier is nearest in size to 1; absent for sets of fewer than three
    /// planets.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub critical: Option<CriticalMotion>,
    /// Energy between harmonics of the mesh frequency over all vibration; absent for motions that repeat with the mesh
    /// cycle.
    pub between: Option<f64>,
    /// Deviation from periodicity over the largest peak-to-peak vibration.
    pub residual: f64,
    /// Length along the branch from its start, negative before it: 1 is a change of the motion by its peak-to-peak
    /// vibration at the start, of the speed by 2 % of the middle of the range, or of torque or damping by 20 % of it.
    pub arc: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Lowest force of any mesh, N; 0 where flanks part.
    pub lowest_force_n: f64,
    /// Largest part of the time in which a mesh carries no force, 0 to 1.
    pub contact_loss: f64,
    /// Part of the time in which backside flanks of any mesh press, 0 to 1; absent for a model without
    /// backside flanks.
    pub backside_contact: Option<f64>,
    /// Distance to grazing: the least of lowest over mean force of the meshes that never part, 0 where one is about to;
    /// absent if all meshes part.
    pub grazing_margin: Option<f64>,
}

impl BranchPoint {
    /// Size of the largest multiplier; 0 if all perturbations are gone after one cycle.
    pub fn largest_multiplier(&self) -> f64 {
        self.multipliers.first().map_or(0.0, |[re, im]| re.hypot(*im))
    }
}
