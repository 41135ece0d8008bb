//! Numbers of teeth.

use serde::{Deserialize, Serialize};

/// Numbers of teeth; a gear pair lacks the sun or the ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Teeth {
    /// Z_s.
    pub sun: Option<u32>,
    /// Z_p.
    pub planet: u32,
    /// Z_r.
    pub ring: Option<u32>,
}

impl Teeth {
    /// (Z_s, Z_r) of a whole set.
    pub fn sun_ring(&self) -> Option<(u32, u32)> {
        Some((self.sun?, self.ring?))
    }
}
