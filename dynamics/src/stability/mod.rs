//! Methods pushed until they fail: systems with known solutions, on which the borders are drawn.

mod bouncing_bar;
mod explicit_step;
mod hammering;

pub use bouncing_bar::{Bounces, BouncingBar};
pub use explicit_step::explicit_limit;
pub use hammering::{Hammering, HammeringPair};
