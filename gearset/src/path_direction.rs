//! Direction in which meshes run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Direction in which tooth pairs run along the path of contact of the loaded flanks, d.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PathDirection {
    /// From the start of the path to its end, d = +1.
    #[default]
    Forward,
    /// From the end of the path to its start, d = −1.
    Backward,
}

impl PathDirection {
    /// d.
    pub fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
        }
    }

    /// d as a whole number.
    pub fn whole(self) -> i64 {
        match self {
            Self::Forward => 1,
            Self::Backward => -1,
        }
    }
}
