//! Flexible bodies.

mod accelerated;
mod assembly;
mod carrier_body;
mod condensed_sector;
mod gear_body;
mod matrices;
mod responses;
mod sector_ring;
mod whole_gear;

pub use accelerated::{Accelerated, ToothForce};
pub use assembly::{Factor, Sparse, Triplets};
pub use carrier_body::CarrierBody;
pub use gear_body::{Deep, FlankPoint, GearBody};
pub use matrices::BodyMatrices;
pub(crate) use matrices::number_unknowns;
pub(crate) use responses::kept_teeth;
