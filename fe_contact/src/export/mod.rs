//! Meshes for other programs and for the eye.

pub mod calculix;
mod outline;
mod svg;
mod vtu;

pub use outline::{Drawn, DrawnElement};
pub use svg::{Placed, picture};
pub use vtu::vtu;
