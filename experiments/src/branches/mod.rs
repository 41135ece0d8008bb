//! Branches of periodic motions over speed, torque, damping or a number of the scene: stable or not, through folds,
//! where sweeps jump.
//!
//! ```text
//! F(y; λ) = Φ(y; λ) − y = 0,   ∂F/∂y = DΦ − I
//! ```
//!
//! with Φ the time steps of one mesh cycle, the very steps that sweeps march, and λ the speed of the input member, the
//! torque on the sun, the factor on the damping or a number of the scene. The solutions are followed by
//! pseudo-arclength continuation ([`dynamics::continuation`]).

mod branch;
mod coexisting;
mod direction;
mod error;
mod family;
mod first;
mod follow;
mod judged_point;
mod kept;
mod parameter;
mod point;
mod search;
mod settings;

pub use branch::{Branch, BranchEnd, BranchOrigin, Branches, NotFollowed};
pub use error::BranchError;
pub use family::{PARAMETER_CHANGE, PeriodicFamily};
pub use follow::{branch, branches, branches_kept};
pub use kept::{BranchStore, KeptPart, finished};
pub use parameter::BranchParameter;
pub use point::{BranchPoint, BranchPointKind};
pub use search::Search;
pub use settings::BranchSettings;
