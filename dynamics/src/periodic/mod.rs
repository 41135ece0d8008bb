//! Periodic solutions by shooting on a map of one period, and their Floquet multipliers.
//!
//! ```text
//! y(T) = Φ(y(0)),   Φ(y*) = y*,   (I − DΦ) Δy = Φ(y) − y
//! ```
//!
//! The map is that of time stepping itself, so that a solution has the step's accuracy and repeats as a march
//! does. DΦ is the product of the derivatives of the steps.

mod derivative;
mod map;
mod multipliers;
mod shooting;

pub use derivative::{CarriedChange, Correction, MapDerivative};
pub use map::PeriodMap;
pub use multipliers::{Multiplier, MultiplierKind, floquet_vector, multipliers};
pub use shooting::{PeriodicSolution, ShootingError, ShootingSettings, shoot};
