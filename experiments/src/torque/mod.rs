//! Torque: resonant peaks followed from torque to torque.

mod error;
mod follow;
mod peak;
mod series;

pub use error::TorqueError;
pub use follow::{Followed, follow, static_growth};
pub use peak::TorquePeak;
pub use series::{Series, lowest_series};
