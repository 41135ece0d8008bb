//! Static equilibrium over a mesh cycle, of any model.

use gearset::MeshKind;
use scene::LoadCase;
use serde::{Deserialize, Serialize};

/// Static equilibrium at evenly spaced positions of one mesh cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshCycle {
    /// Torque; the speed is not used.
    pub case: LoadCase,
    /// Positions in order, at least one.
    pub states: Vec<RestState>,
}

/// Static equilibrium at one position.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RestState {
    /// Position in the mesh cycle, 0 to 1.
    pub position: f64,
    /// Displacement of the sun: x, y (m), rotation (rad), in the carrier frame, counter-clockwise.
    pub sun: [f64; 3],
    /// Forces of the sun meshes along their lines of action, one per planet, N.
    pub sun_mesh_n: Vec<f64>,
    /// Forces of the ring meshes, N.
    pub ring_mesh_n: Vec<f64>,
}

impl RestState {
    /// Forces of one kind of mesh, one per planet, N.
    pub fn forces(&self, kind: MeshKind) -> &[f64] {
        match kind {
            MeshKind::SunPlanet => &self.sun_mesh_n,
            MeshKind::RingPlanet => &self.ring_mesh_n,
        }
    }
}

/// Root mean squares about the mean over a mesh cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunRms {
    /// Of the rotation, rad.
    pub rotation_rad: f64,
    /// Of the translation: the square root of the mean of |(x, y) − mean|², m.
    pub translation_m: f64,
}

impl MeshCycle {
    /// Root mean squares of the sun's rotation and translation.
    pub fn sun_rms(&self) -> SunRms {
        let n = self.states.len() as f64;
        let mean = [0, 1, 2].map(|i| self.states.iter().map(|s| s.sun[i]).sum::<f64>() / n);
        let square =
            |i: usize| self.states.iter().map(|s| (s.sun[i] - mean[i]).powi(2)).sum::<f64>() / n;
        SunRms { rotation_rad: square(2).sqrt(), translation_m: (square(0) + square(1)).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_mean_squares_are_about_the_mean() {
        let at = |x: f64, theta: f64| RestState { sun: [x, 7.0, theta], ..RestState::default() };
        let case = LoadCase::standing(1.0);
        let cycle = MeshCycle { case, states: vec![at(1.0, 5.0), at(3.0, 9.0)] };
        let rms = cycle.sun_rms();
        assert_eq!((rms.translation_m, rms.rotation_rad), (1.0, 2.0));
    }
}
