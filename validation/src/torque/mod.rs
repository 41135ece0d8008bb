//! Torque: resonant peaks followed from torque to torque, and what is said of their growth.

mod follow;
mod series;
mod statements;

pub use follow::{Followed, follow, static_growth};
pub use series::{Series, lowest_series};
pub use statements::{Statement, judge};
