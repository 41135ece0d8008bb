//! Central members, and how a set is driven.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A central member.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Member {
    /// Sun.
    Sun,
    /// Ring.
    Ring,
    /// Carrier.
    Carrier,
}

impl Member {
    /// Name as used in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sun => "sun",
            Self::Ring => "ring",
            Self::Carrier => "carrier",
        }
    }
}

/// Operating point: one member held, one turned at a given speed with a given torque.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// The member that stands still.
    pub fixed: Member,
    /// The member whose speed and torque are given.
    pub input: Member,
    /// Its speed, rpm, counter-clockwise positive: the sense also counts where speeds are swept, as magnitudes.
    pub speed_rpm: f64,
    /// Its external torque, N·m, counter-clockwise positive.
    pub torque_nm: f64,
}
