//! Which bodies and meshes a set has.

use scene::{Scene, SceneKind};

/// Number of planets, and whether they mesh with a ring; a number of planets alone is a whole set.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SetShape {
    /// N; 1 of a gear pair.
    pub planets: usize,
    /// Whether each planet meshes with a ring; not in a gear pair.
    pub has_ring: bool,
}

impl SetShape {
    /// That of a scene.
    pub fn of(scene: &Scene) -> Self {
        let has_ring = scene.kind == SceneKind::Planetary;
        Self { planets: scene.planets.psi_rad.len(), has_ring }
    }

    /// Number of meshes: those of the sun, then those of the ring.
    pub fn meshes(&self) -> usize {
        self.planets * (1 + usize::from(self.has_ring))
    }
}

impl From<usize> for SetShape {
    fn from(planets: usize) -> Self {
        Self { planets, has_ring: true }
    }
}
