//! Mesh stiffness over a mesh cycle, of any model.

use gearset::MeshKind;
use scene::LoadCase;

/// Secant stiffness k = F/δ of one mesh of planet 0 along its line of action over one mesh cycle. F = |T|/(N r_b) is
/// the load of one of N planets under the torque T on the sun of base radius r_b, δ the approach of the two gears.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshStiffness {
    /// Torque; the speed is not used.
    pub case: LoadCase,
    /// Which mesh.
    pub kind: MeshKind,
    /// Phases of planet 0's sun mesh, cycles, ascending and even.
    pub positions: Vec<f64>,
    /// k at each of them, N/m.
    pub secant_n_per_m: Vec<f64>,
}

impl MeshStiffness {
    /// Mean of k over the positions, N/m; not a number without any.
    pub fn mean_n_per_m(&self) -> f64 {
        self.secant_n_per_m.iter().sum::<f64>() / self.secant_n_per_m.len() as f64
    }
}
