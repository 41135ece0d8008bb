//! The two meshes of a planet and their members.

use serde::{Deserialize, Serialize};

/// Which mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeshKind {
    /// Sun drives planet.
    SunPlanet,
    /// Planet drives ring.
    RingPlanet,
}

impl MeshKind {
    /// Name as used in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::SunPlanet => "sun_planet",
            Self::RingPlanet => "ring_planet",
        }
    }
}

/// Which member of a mesh: the one nearer the power input (sun driving) or the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshMember {
    /// Sun in the sun–planet mesh, planet in the ring–planet mesh.
    Driver,
    /// Planet in the sun–planet mesh, ring in the ring–planet mesh.
    Driven,
}
