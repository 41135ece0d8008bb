//! Stability maps: a method or a set pushed until it fails, the border found from the program itself, theory beside it.

mod bouncing_bar;
mod explicit_step;
mod integrators;
mod map;
mod mode_types;
mod parametric;

pub use map::{Border, MapCurve, MapError, MapName, StabilityMap, stability_map};
