//! Flexible bodies.

mod assembly;
mod carrier_body;
mod gear_body;
mod matrices;

pub use assembly::{Factor, Sparse, Triplets};
pub use carrier_body::CarrierBody;
pub(crate) use gear_body::kept_teeth;
pub use gear_body::{Deep, FlankPoint, GearBody};
pub use matrices::BodyMatrices;
pub(crate) use matrices::number_unknowns;
