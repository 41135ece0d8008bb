//! Numerics that know no gears: eigenproblems of vibrating systems and their subspaces.

mod error;
mod gyroscopic;
mod subspace;
mod symmetric;

pub use error::EigenError;
pub use gyroscopic::{GyroscopicMode, gyroscopic_modes};
pub use subspace::{Direction, group_equal, orthonormal_basis, split};
pub use symmetric::{SymmetricModes, generalized_symmetric};
