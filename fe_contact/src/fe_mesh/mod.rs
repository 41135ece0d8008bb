//! Structured meshes of gears and carrier.

mod carrier;
mod flank_layer;
mod gear_mesh;
mod outline;
mod quality;
mod sector;

pub use carrier::{FeCarrierMesh, Hold};
pub use gear_mesh::{Element, Elements, FeGearMesh, RefinedTooth, hermite, rotated};
pub use outline::{Outline, Side, polar};
pub use quality::Quality;
pub use sector::{Refinement, Sector, SectorElement};
