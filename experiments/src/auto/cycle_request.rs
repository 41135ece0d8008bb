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

/// Most doublings of the positions about the extremes of a peak to peak; two are enough for most tolerances, and cost less.
pub(super) const DOUBLINGS: u32 = 7;
const PEAK_DOUBLINGS: [u32; 3] = [0, 2, DOUBLINGS];

/// Doublings of all positions of a mean.
const MEAN_DOUBLINGS: [u32; 4] = [0, 1, 2, 3];

/// Elements along a flank, those next to it divided, and graded contact cells of a tooth pair, from coarse to fine. More cells bring
/// six to twelve elements no nearer to the truth, but FE/contact refuses 20 for some sets, because too few of them carry a load.
pub(super) const MESHES: [(u32, u32); 5] = [(6, 20), (8, 20), (8, 30), (12, 30), (16, 30)];

/// What each doubling of the positions about the extremes of a peak to peak costs, and what each mesh costs more than the coarsest, in positions:
/// gears are meshed and factored, cells of a pair are more.
const OF_DOUBLING: u32 = 3;
const OF_MESH: [u32; MESHES.len()] = [0, 10, 25, 50, 100];

/// Error of a mesh by its elements and cells: parts of the peak to peak and, by how teeth pass from element to element and from cell
/// to cell, of the deflection of a mesh; of a mean, parts of that deflection. 95 % of the development sets are within
/// (`docs/auto.md`).
const OF_PEAK: [[f64; 2]; MESHES.len()] =
    [[0.006, 7e-4], [0.004, 2.6e-4], [0.004, 2.6e-4], [0.003, 1.9e-4], [0.003, 1.2e-4]];
const OF_MEAN: [f64; MESHES.len()] = [0.01, 0.0055, 0.0055, 0.0025, 0.001];

/// Tolerance below which the coarsest mesh is not the first, percent.
pub(super) const FINER_BELOW: f64 = 3.0;

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

    /// Number of the mesh and how often the positions are doubled, of each candidate from cheap to dear.
    pub(super) fn order(&self) -> Vec<(usize, u32)> {
        let doublings: &[u32] = match self.value {
            CycleValue::PeakToPeak => &PEAK_DOUBLINGS,
            CycleValue::Mean => &MEAN_DOUBLINGS,
        };
        let positions = |doubled: u32| match self.value {
            CycleValue::PeakToPeak => POSITIONS + OF_DOUBLING * doubled,
            CycleValue::Mean => POSITIONS << doubled,
        };
        let of_mesh = |mesh| doublings.iter().map(move |doubled| (mesh, *doubled));
        let mut all: Vec<_> = (0..MESHES.len()).flat_map(of_mesh).collect();
        all.sort_by_key(|(mesh, doubled)| OF_MESH[*mesh] + positions(*doubled));
        all
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
