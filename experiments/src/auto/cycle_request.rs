//! What is asked of the loaded transmission error at rest, and the candidates for it from cheap to dear.

use gearset::Scene;

use super::cycle_curve::{mean, range};
use super::settings::{AutoSettings, MESHES, divided};

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

/// Most doublings of the positions, everywhere or about the extremes.
pub(super) const DOUBLINGS: u32 = 3;

/// Candidates for a mean from cheap to dear: number of the mesh, and how often the positions are doubled. A finer mesh costs
/// as much as 5, 15, 60 or 200 positions: gears are meshed and factored, cells of a pair are more.
const ORDER_OF_MEANS: [(usize, u32); 16] = [
    (0, 0),
    (1, 0),
    (2, 0),
    (0, 1),
    (1, 1),
    (2, 1),
    (0, 2),
    (1, 2),
    (3, 0),
    (2, 2),
    (3, 1),
    (3, 2),
    (0, 3),
    (1, 3),
    (2, 3),
    (3, 3),
];

/// The same for peak to peak, where each doubling about the extremes costs as much as some twenty positions.
const ORDER_OF_PEAKS: [(usize, u32); 16] = [
    (0, 0),
    (1, 0),
    (0, 1),
    (1, 1),
    (0, 2),
    (1, 2),
    (2, 0),
    (0, 3),
    (1, 3),
    (2, 1),
    (2, 2),
    (2, 3),
    (3, 0),
    (3, 1),
    (3, 2),
    (3, 3),
];

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
    pub(super) fn order(&self) -> [(usize, u32); 16] {
        match self.value {
            CycleValue::PeakToPeak => ORDER_OF_PEAKS,
            CycleValue::Mean => ORDER_OF_MEANS,
        }
    }

    /// The settings of one of them, with `base` positions that are not doubled.
    pub(super) fn settings(&self, base: u32, mesh: usize, doubled: u32) -> AutoSettings {
        let (elements, cells) = MESHES[mesh];
        let own = AutoSettings::quasi_static(elements, cells);
        match self.value {
            CycleValue::PeakToPeak if doubled > 0 => {
                own.at_positions(base).about_extremes(base << doubled)
            }
            _ => own.at_positions(base << doubled),
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
