//! Rows of the tables of a results folder.

mod cycle_row;
mod mode_row;
mod named;
mod peak_row;
mod rule_row;
mod state_row;
mod stiffness_row;
mod vector_entry;

pub use cycle_row::CycleRow;
pub use mode_row::ModeRow;
pub(super) use named::SceneNames;
pub use peak_row::PeakRow;
pub use rule_row::RuleRow;
pub use state_row::StateRow;
pub use stiffness_row::StiffnessRow;
pub use vector_entry::{VectorAxis, VectorEntry};

/// Planets are numbered below this, and a frequency occurs at most so often.
const MOST: usize = 1000;
