//! Virtual experiments: what can be asked of a model of a planetary gear set, as functions of the model and a
//! load case.

mod error;
pub mod modal;
mod natural_mode;
pub mod sweep;
mod table_growth;
pub mod torque;

pub use error::ExperimentError;
pub use natural_mode::NaturalMode;
pub use table_growth::{Outgrown, SIZES, large_enough};
