//! Figures of the verdict's report, of a mesh cycle at rest, of impulse tests, of speed sweeps, of branches, of
//! stability maps and of studies, one module per figure; all are saved as SVG and PNG.

mod branches;
mod campbell;
mod cost;
mod drawing;
mod error_cost;
mod fidelities;
mod frequency_band;
mod harmonics;
mod impulse;
mod meshes;
mod mode_shapes;
mod multipliers;
mod pair_cycle;
mod set_cycle;
mod spectrum;
mod stabilisation;
mod stability;
mod study;
mod sweep;
mod torque_map;
mod torque_peaks;
mod waterfall;

pub use branches::of_branches;
pub use campbell::campbell;
pub use cost::cost;
pub use drawing::{FigureError, Picture};
pub use fidelities::fidelities;
pub use impulse::{ModalTest, of_impulse_test};
pub use meshes::meshes;
pub use pair_cycle::of_pair_cycle;
pub use set_cycle::of_set_cycles;
pub use stability::of_map;
pub use study::of_study;
pub use sweep::{SweepContext, of_sweep};
pub use torque_map::torque_map;
pub use torque_peaks::torque_peaks;

use std::path::Path;

/// A picture and what its files are called.
pub struct Figure {
    /// Name of the files without ending.
    pub name: String,
    /// What is drawn.
    pub picture: Picture,
}

impl Figure {
    fn new(name: impl Into<String>, picture: Picture) -> Self {
        Self { name: name.into(), picture }
    }
}

/// Each value once, in order of first appearance.
fn distinct<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for value in values {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    found
}

/// The characters of a text that PNG files show as `?`, because their font lacks them; each once.
pub fn lacking(text: &str) -> Vec<char> {
    drawing::missing(text)
}

/// Writes figures into a folder, which is made if need be.
///
/// # Errors
/// At the first file that cannot be written.
pub fn save(figures: &[Figure], folder: &Path) -> Result<(), FigureError> {
    figures.iter().try_for_each(|figure| figure.picture.save(folder, &figure.name))
}
