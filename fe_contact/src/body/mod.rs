//! Flexible bodies.

mod assembly;
mod carrier_body;
mod gear_body;

pub use assembly::{Factor, Triplets};
pub use carrier_body::CarrierBody;
pub use gear_body::{Deep, FlankPoint, GearBody};
