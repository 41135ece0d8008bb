//! Static equilibrium: one mesh alone, and the whole set.

mod approach;
mod bodies;
mod equilibrium;
mod imperfection;
mod pair;
mod placed;
mod races;
mod set;
mod state;

pub use approach::{MeshAtApproach, PairAtApproach, at_approach};
pub use bodies::{Bodies, FeSettings};
pub(crate) use bodies::{FLEXIBILITY_FACTOR, missing_mesh};
pub use imperfection::{Imperfections, PitchError};
pub use pair::{PairAtPhase, PairCycle, ToothPairLoad, at_phase, pair_cycle, press};
pub(crate) use placed::Placed;
pub(crate) use races::planet_bearing;
pub use races::{CARRIER, PLANETS, RING, Races, SUN};
pub(crate) use set::mirrored;
pub use set::{SetTables, StaticSet};
pub use state::{MeshState, SetCycle, SetState};
