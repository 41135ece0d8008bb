//! Static equilibrium: one mesh alone, and the whole set.

mod approach;
mod bodies;
mod imperfection;
mod pair;
mod races;
mod set;

pub use approach::{MeshAtApproach, PairAtApproach, at_approach};
pub use bodies::{Bodies, FeSettings};
pub use imperfection::{Imperfections, PitchError};
pub use pair::{PairAtPhase, PairCycle, ToothPairLoad, at_phase, pair_cycle, press};
pub use races::{CARRIER, PLANETS, RING, Races, SUN};
pub use set::{MeshState, SetCycle, SetState, StaticSet};
