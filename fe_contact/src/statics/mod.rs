//! Static equilibrium: one mesh alone, and the whole set.

mod approach;
mod bodies;
mod cycle;
mod equilibrium;
mod estimate;
mod exact;
mod imperfection;
mod kinematic_rest;
mod mesh_rows;
mod nominal_mesh;
mod pair;
mod phase;
mod placed;
mod placing;
mod races;
mod reference;
mod rest;
mod set;
mod slopes;
mod state;
mod tables;
mod teeth;

pub use approach::{MeshAtApproach, PairAtApproach, at_approach};
pub use bodies::{Bodies, FeSettings};
pub(crate) use bodies::{FLEXIBILITY_FACTOR, missing_mesh};
pub use estimate::{BodyEstimate, FeEstimate, MOST_BYTES, cycle_bytes, estimate, within_memory};
pub use imperfection::{Imperfections, PitchError};
pub(crate) use kinematic_rest::LinearMesh;
pub(crate) use mesh_rows::{invariants, turned};
pub use pair::{
    PairAtPhase, PairCycle, PressureProfile, ToothPairLoad, at_phase, pair_cycle, press,
};
pub(crate) use placed::PlacedMesh;
pub use races::Races;
pub(crate) use races::planet_bearing;
pub use reference::ReferenceConfiguration;
pub use rest::KinematicRest;
pub(crate) use rest::larger;
pub use set::StaticSet;
pub(crate) use slopes::{NeighbourTables, Slopes};
pub use state::{CycleRange, MeshState, SetCycle, SetState, ThroughTorques};
pub use tables::SetTables;
pub(crate) use teeth::{PairEnd, flexibility, mesh_bodies, pair_ends};
