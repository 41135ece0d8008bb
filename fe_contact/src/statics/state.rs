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
    /// Rotation of the member that the torque acts on, times its torque over that of the sun, rad: the sun's
    /// rotation, unless the sun is held.
    pub loaded_rotation: f64,
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
    /// r_b θ of the member that the torque acts on, by work: r_b of the sun times
    /// [`loaded_rotation`](Self::loaded_rotation), m. With the sun held and the torque on the ring it is r_b θ of
    /// the ring.
    pub fn transmission_error(&self, sun_base_radius: f64) -> f64 {
        self.loaded_rotation * sun_base_radius
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
    /// States at ascending positions of one mesh cycle, from 0; evenly spaced but where they were asked for at others.
    pub states: Vec<SetState>,
}

/// Largest difference of positions from evenly spaced ones, cycles.
const EVEN: f64 = 1e-9;

impl SetCycle {
    /// Mean over the cycle and the planets of a mesh's force over its rigid approach, F/δ, N/m.
    pub fn mean_secant_stiffness(&self, kind: MeshKind) -> f64 {
        let of_kind = |s: &&MeshState| s.kind == kind;
        let (mut sum, mut total) = (0.0, 0.0);
        for (weight, state) in self.weights().into_iter().zip(&self.states) {
            for mesh in state.meshes.iter().filter(of_kind) {
                sum += weight * mesh.secant_stiffness();
                total += weight;
            }
        }
        if total > 0.0 { sum / total } else { 0.0 }
    }

    /// Mean over the cycle, smallest and largest value of a quantity at the positions.
    pub fn range(&self, of: impl Fn(&SetState) -> f64) -> CycleRange {
        let values: Vec<f64> = self.states.iter().map(of).collect();
        CycleRange {
            mean: self.mean(&values),
            least: values.iter().fold(f64::INFINITY, |a, v| a.min(*v)),
            largest: values.iter().fold(f64::NEG_INFINITY, |a, v| a.max(*v)),
        }
    }

    /// Mean over the cycle of a value at each position.
    fn mean(&self, values: &[f64]) -> f64 {
        let weights = self.weights();
        let sum: f64 = weights.iter().zip(values).map(|(weight, value)| weight * value).sum();
        sum / weights.iter().sum::<f64>()
    }

    /// Parts of the cycle that the positions stand for: alike if they are evenly spaced, otherwise half of the way to
    /// either neighbour (trapezoidal rule).
    fn weights(&self) -> Vec<f64> {
        let x: Vec<f64> = self.states.iter().map(|s| s.position).collect();
        let n = x.len();
        let is_even = |k: usize| (x[k] - x[0] - k as f64 / n as f64).abs() < EVEN;
        match (0..n).all(is_even) {
            true => vec![1.0; n],
            false => (0..n)
                .map(|k| 0.5 * (x[(k + 1) % n] - x[(k + n - 1) % n]).rem_euclid(1.0))
                .collect(),
        }
    }

    /// Transmission error r_b θ of the loaded member, the sun unless it is held, m.
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

    /// Part of the cycle in which backside flanks of any mesh press, 0 to 1.
    pub fn backside_contact(&self) -> f64 {
        let presses = |s: &SetState| s.backside.iter().any(|mesh| mesh.force > 0.0);
        self.range(|s| f64::from(u8::from(presses(s)))).mean
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
        let of = |i: usize| self.states.iter().map(|s| s.central[2][i]).collect::<Vec<_>>();
        let square = |i: usize| {
            let (values, mean) = (of(i), self.mean(&of(i)));
            self.mean(&values.iter().map(|v| (v - mean).powi(2)).collect::<Vec<_>>())
        };
        (square(2).sqrt(), (square(0) + square(1)).sqrt())
    }
}
