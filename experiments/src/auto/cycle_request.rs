//! What is asked of the loaded transmission error at rest, and the candidates for it from cheap to dear.

use gearset::Scene;

use super::cycle_curve::{mean, range};
use super::settings::{AutoSettings, divided};

/// What is read from the transmission error r_b θ of the sun over a mesh cycle at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleValue {
    /// Its largest less its smallest value.
    PeakToPeak,
    /// Its mean.
    Mean,
}

/// The transmission error under a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleRequest {
    /// What is read from it.
    pub value: CycleValue,
    /// Wanted accuracy, percent.
    pub tolerance_percent: f64,
}

impl std::fmt::Display for CycleRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self.value {
            CycleValue::PeakToPeak => "peak-to-peak transmission error of the sun at rest",
            CycleValue::Mean => "mean transmission error of the sun at rest",
        })
    }
}

/// Even positions of a candidate, those about the extremes apart; of a mean the fewest, others have two, four and eight times as
/// many, so that those of fewer are among those of more.
pub(super) const POSITIONS: u32 = 60;

/// Most doublings of the positions about the extremes; everywhere at most three.
pub(super) const DOUBLINGS: u32 = 5;

/// Elements along a flank, those next to it divided, and graded contact cells of a tooth pair, from coarse to fine.
pub(super) const MESHES: [(u32, u32); 5] = [(6, 20), (8, 20), (8, 30), (12, 40), (16, 60)];

/// Candidates for a mean from cheap to dear: number of the mesh, and how often the positions are doubled.
const ORDER_OF_MEANS: [(usize, u32); 20] = [
    (0, 0),
    (1, 0),
    (2, 0),
    (0, 1),
    (1, 1),
    (3, 0),
    (2, 1),
    (0, 2),
    (3, 1),
    (1, 2),
    (4, 0),
    (2, 2),
    (4, 1),
    (3, 2),
    (0, 3),
    (1, 3),
    (2, 3),
    (4, 2),
    (3, 3),
    (4, 3),
];

/// The same for peak to peak, where each doubling about the extremes costs as much as some five positions, and a finer mesh as much as 15, 30, 75 or
/// 200: gears are meshed and factored, cells of a pair are more.
const ORDER_OF_PEAKS: [(usize, u32); 30] = [
    (0, 0),
    (0, 1),
    (0, 2),
    (0, 3),
    (1, 0),
    (0, 4),
    (1, 1),
    (0, 5),
    (1, 2),
    (2, 0),
    (1, 3),
    (2, 1),
    (1, 4),
    (2, 2),
    (1, 5),
    (2, 3),
    (2, 4),
    (2, 5),
    (3, 0),
    (3, 1),
    (3, 2),
    (3, 3),
    (3, 4),
    (3, 5),
    (4, 0),
    (4, 1),
    (4, 2),
    (4, 3),
    (4, 4),
    (4, 5),
];

/// Error of a mesh by its elements and cells: parts of the peak to peak and, by how teeth pass from element to element and from cell
/// to cell, of the deflection of a mesh; of a mean, parts of that deflection. 95 % of the development sets are within
/// (`docs/auto.md`).
const OF_PEAK: [[f64; 2]; 5] =
    [[0.006, 1e-3], [0.004, 4.5e-4], [0.004, 3e-4], [0.004, 2.5e-4], [0.003, 2e-4]];
const OF_MEAN: [f64; 5] = [0.01, 0.0055, 0.0055, 0.0025, 0.001];

/// Tolerance below which the coarsest mesh is not the first, percent.
const FINER_BELOW: f64 = 3.0;

impl CycleRequest {
    /// All candidates for a scene, from cheap to dear.
    pub fn candidates(&self, scene: &Scene) -> Vec<AutoSettings> {
        let base = divided(scene, POSITIONS);
        let order = self.order();
        let of_mesh = order.iter().map(|(mesh, doubled)| self.settings(base, *mesh, *doubled));
        // The closed forms' peak to peak has no estimate of its error.
        let lumped = (self.value == CycleValue::Mean).then_some(AutoSettings::LUMPED);
        lumped.into_iter().chain(of_mesh).collect()
    }

    /// Number of the mesh and how often the positions are doubled, of each candidate.
    pub(super) fn order(&self) -> &'static [(usize, u32)] {
        match self.value {
            CycleValue::PeakToPeak => &ORDER_OF_PEAKS,
            CycleValue::Mean => &ORDER_OF_MEANS,
        }
    }

    /// The settings of one of them, with `base` positions that are not doubled.
    pub(super) fn settings(&self, base: u32, mesh: usize, doubled: u32) -> AutoSettings {
        let (elements, cells) = MESHES[mesh];
        let own = AutoSettings::quasi_static(elements, cells);
        let own = own.with_divided_layer().with_graded_cells_at_rest();
        match self.value {
            CycleValue::PeakToPeak if doubled > 0 => {
                own.at_positions(base).about_extremes(base << doubled)
            }
            _ => own.at_positions(base << doubled),
        }
    }

    /// First mesh that is run.
    pub(super) fn first_mesh(&self) -> usize {
        usize::from(self.tolerance_percent < FINER_BELOW)
    }

    /// Part of elements and cells of a mesh in a value (m), where a mesh of teeth yields by `deflection` (m).
    pub(super) fn error_of_mesh(&self, mesh: usize, deflection: f64, value: f64) -> f64 {
        match self.value {
            CycleValue::PeakToPeak => {
                let [of_value, of_deflection] = OF_PEAK[mesh];
                of_value + of_deflection * deflection / value
            }
            CycleValue::Mean => OF_MEAN[mesh] * deflection / value,
        }
    }

    /// The value of a curve, m.
    pub(super) fn of(&self, points: &[[f64; 2]]) -> f64 {
        match self.value {
            CycleValue::PeakToPeak => range(points),
            CycleValue::Mean => mean(points),
        }
    }
}
