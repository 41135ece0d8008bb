//! Results of any program as a folder of tables: read as spreadsheets and MATLAB write them.

mod known_scenes;
mod manifest;
mod manifest_error;
mod nearest;
pub mod table;

pub use known_scenes::{KnownScene, KnownScenes, UnknownScene};
pub use manifest::{Convention, Frame, Kind, Manifest, Radius, RotationCoordinate};
pub use manifest_error::ManifestError;
pub use table::{Remark, TableError};
