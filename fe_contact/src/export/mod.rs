//! Meshes for other programs, and as outlines for pictures.

pub mod calculix;
mod outline;
mod vtu;

pub use outline::{Drawn, DrawnElement};
pub use vtu::vtu;
