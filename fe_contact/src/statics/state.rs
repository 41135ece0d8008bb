//! Results of a set in equilibrium, at one position and over a mesh cycle.

use gearset::MeshKind;

use super::pair::ToothPairLoad;
use super::rest::{KinematicRest, larger};

/// One mesh of a set in equilibrium.
#[derive(Debug, Clone)]
pub struct MeshState {
    /// Which mesh.
    pub kind: MeshKind,
    /// Planet n.
    pub planet: usize,
    /// Phase, cycles in [0, 1).
    pub phase: f64,
    /// Sum of the pair forces, N.
    pub force: f64,
    /// Rigid approach along the line of action, m.
    pub approach: f64,
    /// ∂F/∂δ, the approaches of all pairs growing equally, N/m.
    pub tangent: f64,
    /// Loaded pairs.
    pub pairs: Vec<ToothPairLoad>,
}

impl MeshState {
    /// Force over rigid approach along the line of action, N/m.
    pub fn secant_stiffness(&self) -> f64 {
        self.force / self.approach
    }
}

/// A set in equilibrium at one position. Displacements in the carrier frame, counter-clockwise.
#[derive(Debug, Clone)]
pub struct SetState {
    /// Position in the mesh cycle: phase of planet 0's sun mesh, cycles.
    pub position: f64,
    /// Displacements (x, y, m; θ, rad) of carrier, ring, sun.
    pub central: [[f64; 3]; 3],
    /// Displacements (ζ, η, m; θ, rad) of the planets.
    pub planets: Vec<[f64; 3]>,
    /// All meshes: sun meshes, then ring meshes.
    pub meshes: Vec<MeshState>,
    /// Loaded backside flanks; phases count in the mirrored mesh.
    pub backside: Vec<MeshState>,
    /// Torques that the gears exert on carrier and ring.
    pub reactions: ThroughTorques,
    /// Kinematic rest: largest difference of a loaded pair's approach, by exact kinematics at these
    /// displacements, from its linear form about the reference, m.
    pub kinematic_rest: f64,
    /// Largest imbalance of any race over the load.
    pub residual: f64,
    /// Equilibrium iterations.
    pub iterations: usize,
    /// Factorisations and pivots of the contact solver.
    pub contact_iterations: usize,
}

impl SetState {
    /// r_b · sun rotation, m.
    pub fn transmission_error(&self, sun_base_radius: f64) -> f64 {
        self.central[2][2] * sun_base_radius
    }
}

/// Torques that the gears exert on carrier and ring about the set's centre, counter-clockwise, N·m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThroughTorques {
    /// Planet bearings on the carrier.
    pub carrier_nm: f64,
    /// Ring meshes on the ring.
    pub ring_nm: f64,
}

/// A quantity over the positions of a mesh cycle, in its own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleRange {
    /// Mean.
    pub mean: f64,
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub largest: f64,
}

impl CycleRange {
    /// Largest value less smallest.
    pub fn peak_to_peak(&self) -> f64 {
        self.largest - self.least
    }
}

/// Equilibrium over one mesh cycle.
#[derive(Debug, Clone)]
pub struct SetCycle {
    /// Torque on the sun, N·m.
    pub torque_nm: f64,
    /// Change of the phase of planet 0's sun mesh by the windup under the torque, cycles. Positions
    /// count from where that mesh starts its path.
    pub lead: f64,
    /// States at evenly spaced positions from 0.
    pub states: Vec<SetState>,
}

impl SetCycle {
    /// Mean over positions and planets of a mesh's force over its rigid approach, F/δ, N/m.
    pub fn mean_secant_stiffness(&self, kind: MeshKind) -> f64 {
        let meshes = self.states.iter().flat_map(|s| &s.meshes).filter(|m| m.kind == kind);
        let (sum, count) =
            meshes.fold((0.0, 0u32), |(sum, n), m| (sum + m.secant_stiffness(), n + 1));
        sum / f64::from(count.max(1))
    }

    /// Mean, smallest and largest value of a quantity over the positions.
    pub fn range(&self, of: impl Fn(&SetState) -> f64) -> CycleRange {
        let values: Vec<f64> = self.states.iter().map(of).collect();
        CycleRange {
            mean: values.iter().sum::<f64>() / values.len() as f64,
            least: values.iter().fold(f64::INFINITY, |a, v| a.min(*v)),
            largest: values.iter().fold(f64::NEG_INFINITY, |a, v| a.max(*v)),
        }
    }

    /// Transmission error r_b θ of the sun, m.
    pub fn transmission_error(&self, sun_base_radius: f64) -> CycleRange {
        self.range(|s| s.transmission_error(sun_base_radius))
    }

    /// Force of one mesh, in the order of [`SetState::meshes`], N: how the planets share the load.
    pub fn mesh_force(&self, mesh: usize) -> CycleRange {
        self.range(|s| s.meshes[mesh].force)
    }

    /// Force over rigid approach of one mesh, in the order of [`SetState::meshes`], N/m.
    pub fn mesh_secant_stiffness(&self, mesh: usize) -> CycleRange {
        self.range(|s| s.meshes[mesh].secant_stiffness())
    }

    /// ∂F/∂δ of one mesh, in the order of [`SetState::meshes`], N/m.
    pub fn mesh_tangent_stiffness(&self, mesh: usize) -> CycleRange {
        self.range(|s| s.meshes[mesh].tangent)
    }

    /// Kinematic rest over the cycle.
    pub fn kinematic_rest(&self, sun_base_radius: f64) -> KinematicRest {
        let largest = larger(self.states.iter().map(|s| s.kinematic_rest));
        KinematicRest::new(largest, self.transmission_error(sun_base_radius).peak_to_peak())
    }

    /// Equilibrium and contact iterations of all positions.
    pub fn iterations(&self) -> (usize, usize) {
        let all = self.states.iter();
        all.fold((0, 0), |(a, b), s| (a + s.iterations, b + s.contact_iterations))
    }

    /// Largest imbalance of any race over the load.
    pub fn worst_residual(&self) -> f64 {
        self.states.iter().fold(0.0, |a, s| a.max(s.residual))
    }

    /// Root mean square about the mean of the sun's rotation (rad) and of its translation (m): the
    /// square root of the mean of |(x, y) − mean|².
    pub fn sun_rms(&self) -> (f64, f64) {
        let n = self.states.len() as f64;
        let mean = [0, 1, 2].map(|i| self.states.iter().map(|s| s.central[2][i]).sum::<f64>() / n);
        let square = |i: usize| {
            self.states.iter().map(|s| (s.central[2][i] - mean[i]).powi(2)).sum::<f64>() / n
        };
        (square(2).sqrt(), (square(0) + square(1)).sqrt())
    }
}
