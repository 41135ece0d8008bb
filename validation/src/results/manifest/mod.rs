//! `results.toml`, and the file of misses that an author accepts.

mod accepted;
mod error;
mod file;

pub use accepted::accepted_misses;
pub use error::ManifestError;
pub use file::{Convention, Frame, Manifest, Radius, RotationCoordinate};
pub(super) use file::{ORDER, POSITIONS};
