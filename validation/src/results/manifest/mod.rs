//! `results.toml`, and what the author of results accepts.

mod accepted;
mod convention;
mod error;
mod file;

pub use accepted::{Accepted, Threshold};
pub(super) use convention::ORDER;
pub use convention::{Convention, PlanetTranslations, Radius, RotationCoordinate};
pub use error::ManifestError;
pub use file::Manifest;
pub(super) use file::POSITIONS;
