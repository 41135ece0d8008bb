//! Where the planets stand.

use serde::{Deserialize, Serialize};

/// Where the planets stand on the carrier.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanetPositions {
    /// ψ_n, counter-clockwise from planet 0, rad. Planet 0 is at zero.
    pub psi_rad: Vec<f64>,
    /// The same in assembly steps of 2π/(Z_s+Z_r), when the teeth are known.
    pub steps: Option<Vec<i64>>,
}

impl PlanetPositions {
    /// N planets at ψ_n = 2πn/N, without assembly steps.
    pub fn equally_spaced(count: usize) -> Self {
        let psi_rad = (0..count).map(|n| std::f64::consts::TAU * n as f64 / count as f64).collect();
        Self { psi_rad, steps: None }
    }

    /// Number of planets N.
    pub fn count(&self) -> usize {
        self.psi_rad.len()
    }
}
