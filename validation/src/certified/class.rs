//! How far a value is certain.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Class of a value.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
pub enum Class {
    /// Certified: two independent codes, or a code and a theorem or closed form, agree on its digits.
    A,
    /// Two numerical routes of this project agree that share mechanics.
    B,
    /// One route.
    C,
}

impl Class {
    /// All of them, the surest first.
    pub const ALL: [Self; 3] = [Self::A, Self::B, Self::C];

    /// As tables write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
        }
    }
}
