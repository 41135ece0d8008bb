//! Interface between a sweep and a model that is integrated in time.

use dynamics::{CarriedChange, MapDerivative};
use fe_contact::vibration::{Along, LoadedStep, VibratingSet};
use gearset::Symmetry;

use super::error::SweepError;
use super::shooting::CycleDerivative;
use crate::modal::MotionKinds;

/// Computational effort of the steps of a set so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Coordinates that are stepped, elastic ones included.
    pub coordinates: usize,
    /// Mean number of solutions for the forces of all meshes per step.
    pub solutions: f64,
}

/// A set that turns at constant nominal speed under a constant torque.
pub trait Marching {
    /// Puts the set to rest in its static equilibrium at position 0.
    ///
    /// # Errors
    /// If there is no equilibrium.
    fn rest(&mut self) -> Result<(), SweepError>;

    /// One time step.
    ///
    /// # Errors
    /// If contact cannot be solved or the motion diverges.
    fn step(&mut self) -> Result<(), SweepError>;

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad) and of the planets (ζ, η, θ) in the
    /// carrier frame, counter-clockwise.
    fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>);

    /// Force of each mesh: sun meshes, ring meshes, then, if any backside flanks touch, the force of the
    /// backside flanks of each mesh in the same order, N.
    fn mesh_forces(&self, out: &mut Vec<f64>);

    /// Whether the model has backside flanks, so that [`mesh_forces`](Self::mesh_forces) without forces of
    /// them means that none touches; `false` leaves backside contact out of the results.
    fn has_backside(&self) -> bool {
        true
    }

    /// What the kinematic rest at the present state is computed from; `None` for a model without approaches of single
    /// pairs, which has none.
    fn loaded_step(&self) -> Option<LoadedStep> {
        None
    }

    /// Kinematic rest (largest deviation of a pair's approach from its linear form) at a step since which the set has
    /// not passed that position of the cycle, and the radius of the member that the torque acts on, m; `None` as
    /// [`loaded_step`](Self::loaded_step).
    fn kinematic_rest(&self, at: &LoadedStep) -> Option<[f64; 2]> {
        let _ = at;
        None
    }

    /// Effort of the steps so far.
    fn effort(&self) -> Effort;

    /// Memory of contact tables, maps and frames, bytes; 0 of a model whose meshes follow a law.
    fn bytes(&self) -> usize {
        0
    }

    /// The state from which the next step continues, after a whole number of mesh cycles: first
    /// [`counters`](Self::counters) whole numbers, then continuous quantities.
    fn state(&mut self) -> Vec<f64>;

    /// Number of leading entries of a state that count cycles or steps.
    fn counters(&self) -> usize;

    /// Continues from a state.
    ///
    /// # Errors
    /// If the state is that of another kind of set.
    fn restore(&mut self, state: &[f64]) -> Result<(), SweepError>;

    /// The derivative of its cycles; `None` for a model that has none, whose steady states are marched.
    fn derivative(&mut self) -> Option<&mut dyn CycleDerivative> {
        None
    }

    /// Rotational, translational and planet motion of the set, on its displacements one after another; `None` of a set
    /// of fewer than three planets, whose motion has no such types.
    fn kinds(&self) -> Option<MotionKinds> {
        None
    }

    /// Displacements as [`displacements`](Self::displacements) in other coordinates of
    /// [`CycleDerivative::coordinates`]; only of a model with a derivative.
    fn displacements_of(&self, coordinates: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let _ = coordinates;
        self.displacements()
    }
}

/// An FE/contact set under a constant torque on the sun (N m, magnitude).
#[derive(Debug)]
pub(super) struct FeMarching<'s> {
    pub(super) set: VibratingSet<'s>,
    pub(super) torque_nm: f64,
    /// Frequency (rad/s) to which velocities are related.
    pub(super) rate: f64,
}

impl Marching for FeMarching<'_> {
    fn rest(&mut self) -> Result<(), SweepError> {
        Ok(self.set.rest(self.torque_nm)?)
    }

    fn step(&mut self) -> Result<(), SweepError> {
        Ok(self.set.step()?)
    }

    fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements()
    }

    fn mesh_forces(&self, out: &mut Vec<f64>) {
        self.set.mesh_forces(out);
    }

    fn loaded_step(&self) -> Option<LoadedStep> {
        Some(self.set.loaded_step())
    }

    fn kinematic_rest(&self, at: &LoadedStep) -> Option<[f64; 2]> {
        let races = self.set.races();
        Some([self.set.kinematic_rest(at), races.radii[races.loaded().0.kind()]])
    }

    fn effort(&self) -> Effort {
        let counts = self.set.counts;
        Effort {
            coordinates: self.set.races().count + self.set.elastic_unknowns(),
            solutions: counts.solutions as f64 / counts.steps.max(1) as f64,
        }
    }

    fn bytes(&self) -> usize {
        self.set.bytes().iter().sum()
    }

    fn state(&mut self) -> Vec<f64> {
        self.set.state()
    }

    fn counters(&self) -> usize {
        1
    }

    fn restore(&mut self, state: &[f64]) -> Result<(), SweepError> {
        Ok(self.set.restore(state)?)
    }

    fn derivative(&mut self) -> Option<&mut dyn CycleDerivative> {
        if self.set.has_derivative() { Some(self) } else { None }
    }

    fn kinds(&self) -> Option<MotionKinds> {
        let races = self.set.races();
        motion_kinds(&races.inertias(self.set.masses()), &races.psi)
    }

    fn displacements_of(&self, coordinates: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements_of(coordinates)
    }
}

/// Fewest planets with rotational, translational and planet motion.
const FEWEST_PLANETS: usize = 3;

/// Types of motion of a set with such inertias and angles of its planets.
pub(super) fn motion_kinds(inertias: &[[f64; 3]], psi: &[f64]) -> Option<MotionKinds> {
    (psi.len() >= FEWEST_PLANETS).then(|| MotionKinds::of_bodies(inertias, psi))
}

impl CycleDerivative for FeMarching<'_> {
    fn coordinates(&mut self) -> Vec<f64> {
        self.set.coordinates()
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError> {
        Ok(self.set.set_coordinates(y)?)
    }

    fn symmetry(&mut self) -> Result<Option<Symmetry>, SweepError> {
        Ok(self.set.symmetry()?)
    }

    fn start(&mut self) {}

    /// Frames keep every step.
    fn keep_step(&mut self) {}

    fn end(&mut self) -> Result<(), SweepError> {
        Ok(self.set.take_cycle_back()?)
    }

    fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, SweepError> {
        Ok(self.set.cycle_derivative(along, self.rate)?)
    }

    fn of_cycle_with(&mut self, change: CarriedChange<'_>) -> Result<MapDerivative, SweepError> {
        Ok(self.set.cycle_derivative_with(self.rate, change)?)
    }
}
