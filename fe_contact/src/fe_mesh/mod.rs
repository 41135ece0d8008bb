//! Structured meshes of gears and carrier.

mod carrier;
mod gear_mesh;
mod outline;
mod quality;
mod sector;

pub use carrier::{FeCarrierMesh, Hold};
pub use gear_mesh::{Element, FeGearMesh, FlankEdge, RefinedTooth, hermite, rotated};
pub use outline::{Outline, Side, polar};
pub use quality::Quality;
pub use sector::{Refinement, Sector, SectorElement};
