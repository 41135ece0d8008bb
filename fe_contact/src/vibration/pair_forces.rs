//! Forces and approaches of all tooth pairs of a set, and the state of their lag.

use std::sync::Arc;

use gearset::PathDirection;
use nalgebra::DVector;

use super::frame::Frame;
use super::lag::{LagRule, PairMemory};

/// Tooth pairs of a set in the current frame.
#[derive(Debug)]
pub(super) struct PairForces {
    pub(super) lag: LagRule,
    /// State of the lag of each front mesh.
    pub(super) memory: Vec<PairMemory>,
    /// Forces of the pairs of the current frame, N.
    pub(super) forces: DVector<f64>,
    /// Approaches of the pairs, less gap offsets, m.
    pub(super) approaches: DVector<f64>,
    /// Load on the races from the second-order terms of corner gaps in the last step, n, N.
    pub(super) bent: DVector<f64>,
    /// By step in the cycle: meshes whose phase passes 0 with this step.
    pub(super) restarts: Arc<[Vec<usize>]>,
    /// Direction in which it passes.
    pub(super) direction: PathDirection,
}

impl PairForces {
    /// No forces on any of `meshes` front meshes; `races` coordinates.
    pub(super) fn new(
        lag: LagRule,
        meshes: usize,
        races: usize,
        (restarts, direction): (Arc<[Vec<usize>]>, PathDirection),
    ) -> Self {
        Self {
            lag,
            memory: vec![PairMemory::default(); meshes],
            forces: DVector::zeros(0),
            approaches: DVector::zeros(0),
            bent: DVector::zeros(races),
            restarts,
            direction,
        }
    }

    /// Enlarges the vectors if a position has more pairs than any before.
    pub(super) fn fit(&mut self, count: usize) {
        if self.forces.len() < count {
            self.forces = DVector::zeros(count);
            self.approaches = DVector::zeros(count);
        }
    }

    /// Renumbers the pairs in the lag of those meshes whose phase passes 0 with a step of the
    /// cycle.
    pub(super) fn restart(&mut self, step_in_cycle: usize) {
        for mesh in &self.restarts[step_in_cycle] {
            self.memory[*mesh].move_on(self.direction);
        }
    }

    /// Advances the lag by the forces at the end of a step.
    pub(super) fn advance(&mut self, frame: &Frame) {
        for (memory, mesh) in self.memory.iter_mut().zip(&frame.meshes) {
            let own = &self.forces.as_slice()[mesh.first..mesh.first + mesh.count];
            let slots = &frame.pattern.slots[mesh.first..mesh.first + mesh.count];
            memory.advance(&self.lag, slots.iter().copied().zip(own.iter().copied()));
        }
    }

    /// Sets the lag to its steady state under the forces `p` (N) of a frame's pairs.
    pub(super) fn rest(&mut self, frame: &Frame, p: &DVector<f64>) {
        for (memory, mesh) in self.memory.iter_mut().zip(&frame.meshes) {
            let own = &p.as_slice()[mesh.first..mesh.first + mesh.count];
            let slots = &frame.pattern.slots[mesh.first..mesh.first + mesh.count];
            memory.rest(slots.iter().copied().zip(own.iter().copied()));
        }
    }

    /// Sum of the forces of each mesh of a frame, N.
    pub(super) fn of_meshes(&self, frame: &Frame) -> impl Iterator<Item = f64> {
        frame.meshes.iter().map(|mesh| {
            self.forces.as_slice()[mesh.first..mesh.first + mesh.count].iter().sum::<f64>()
        })
    }
}
