#![doc = include_str!("../README.md")]

pub mod auto;
mod bodies_cache;
pub mod branches;
mod mesh_cycle;
mod mesh_stiffness;
pub mod modal;
mod model;
pub mod models;
mod natural_mode;
mod scene_keys;
pub mod stability;
pub mod study;
pub mod sweep;
mod table_growth;
pub mod torque;

pub use bodies_cache::BodiesCache;
pub use mesh_cycle::{MeshCycle, RestState, SunRms};
pub use mesh_stiffness::MeshStiffness;
pub use model::{
    MeshStiffnessModel, ModalModel, ModelError, NextSpeeds, SpeedRequest, StaticModel,
    SteadyStateModel, TorquePeakModel,
};
pub use natural_mode::{DistinctMode, NaturalMode, distinct, frequencies_of};
pub use table_growth::{Outgrown, SIZES, large_enough};
