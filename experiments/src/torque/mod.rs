//! Torque: resonant peaks followed from torque to torque.

mod follow;
mod series;

pub use follow::{Followed, follow, static_growth};
pub use series::{Series, lowest_series};
