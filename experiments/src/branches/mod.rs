//! Branches of periodic motions over speed: stable or not, through folds, where sweeps jump.
//!
//! ```text
//! F(y; n) = Φ(y; n) − y = 0,   ∂F/∂y = DΦ − I
//! ```
//!
//! with Φ the time steps of one mesh cycle at speed n of the input member, the very steps that sweeps march. The
//! solutions are followed by pseudo-arclength continuation ([`dynamics::continuation`]).

mod branch;
mod error;
mod family;
mod follow;
mod point;
mod settings;

pub use branch::{Branch, BranchEnd};
pub use error::BranchError;
pub use family::PeriodicFamily;
pub use follow::branch;
pub use point::{BranchPoint, BranchPointKind, BranchRow};
pub use settings::BranchSettings;
