//! What results come from.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What results come from. Only checks whose reference is of the same kind can fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelKind {
    /// Rigid bodies on springs that move in the plane.
    Lumped,
    /// Elastic teeth in contact.
    FeContact,
    /// Rigid bodies on springs that only turn.
    Torsional,
    /// A test rig: compared, never failed.
    Measured,
}

impl ModelKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Lumped, Self::FeContact, Self::Torsional, Self::Measured];

    /// As `results.toml` and the registry call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lumped => "lumped",
            Self::FeContact => "fe_contact",
            Self::Torsional => "torsional",
            Self::Measured => "measured",
        }
    }
}
