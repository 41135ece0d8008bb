//! Stability maps: a method or a set pushed until it fails, the border found from the program itself, theory beside it.

mod bisection;
mod bouncing_bar;
mod changed_group;
mod contact_cells;
mod contact_loss;
mod explicit_step;
mod guards;
mod hammering;
mod integrators;
mod lag;
mod linear_kinematics;
mod locking;
mod map;
mod mode_types;
mod parametric;
mod resolution;
mod resonance;
mod spacing;
mod transients;
mod truncated_stiffness;
mod windup;

pub use guards::{Guard, guards};
pub use map::{Border, MAPS, Map, MapCurve, MapError, StabilityMap, stability_map, stability_maps};
