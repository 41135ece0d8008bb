//! `results.toml`, and what the author of results accepts.

mod accepted;
mod error;
mod file;

pub use accepted::{Accepted, Threshold};
pub use error::ManifestError;
pub use file::{Convention, Frame, Manifest, Radius, RotationCoordinate};
pub(super) use file::{ORDER, POSITIONS};
