//! What is varied along a branch.

use gearset::LoadCase;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is varied along a branch; everything else is held fixed, above all what the model was made under
/// ([`SweepModel::turning`](crate::sweep::SweepModel::turning)).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchParameter {
    /// Speed of the input member, rpm.
    Speed,
    /// Torque on the sun, N·m, about the loaded configuration of the model's own torque.
    Torque,
    /// Factor on every damping of the scene.
    Damping,
}

impl BranchParameter {
    /// Its name as a clause.
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed of the input member",
            Self::Torque => "torque on the sun",
            Self::Damping => "factor on the damping",
        }
    }

    /// As the argument `--over` calls it.
    pub fn argument(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Torque => "torque",
            Self::Damping => "damping",
        }
    }

    /// Its unit with a space before it, empty for the factor.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Speed => " rpm",
            Self::Torque => " N·m",
            Self::Damping => "",
        }
    }

    /// Share of the middle of its range that counts as a unit of arc. Resonances are some per cent of the speed wide;
    /// load and damping change motions in proportion to themselves.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Speed => 0.02,
            Self::Torque | Self::Damping => 0.2,
        }
    }

    /// Load case and factor on the damping at one value; `fixed` says the rest.
    pub(super) fn at(self, fixed: &LoadCase, value: f64) -> (LoadCase, f64) {
        match self {
            Self::Speed => (fixed.at_speed(value), 1.0),
            Self::Torque => (fixed.with_sun_torque(value), 1.0),
            Self::Damping => (*fixed, value),
        }
    }
}
