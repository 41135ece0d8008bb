//! Contact between flanks: matching of half-plane and FE, contact cells, forces.

mod answer;
mod cells;
pub mod cylinders;
pub mod half_plane;
pub mod hertz;
mod maps;
mod pair;
mod rooms;
mod seen;
mod table;

pub use answer::MeshAnswer;
pub use maps::{ContactMap, ContactMaps, Held, SharedMaps};
pub use pair::{Location, PairFrame, ToothFrame, candidates, members};
pub use table::{CellSettings, Matching, MeshTable, PairCells};
