//! Contact between flanks: half-plane and FE matched, cells, forces.

pub mod cylinders;
pub mod half_plane;
pub mod hertz;
mod law;
mod maps;
mod pair;
mod table;

pub use law::MeshAnswer;
pub use maps::{ContactMap, ContactMaps, Held};
pub use pair::{Location, PairFrame, ToothFrame, candidates, members};
pub use table::{CellSettings, Matching, MeshTable, PairCells};
