//! Numerics that know no gears: eigenproblems of vibrating systems and their subspaces, time steps,
//! spectra of records, and the modes identified from them.

mod coupled;
mod error;
mod gyroscopic;
pub mod identify;
mod lowest_modes;
mod newmark;
mod spectrum;
mod state_space;
mod subspace;
mod symmetric;

pub use coupled::{Coupled, CoupledError, CoupledState, Coupling, CouplingLaw, LinearPart};
pub use error::{EigenError, SpectrumError};
pub use faer::c64;
pub use gyroscopic::{GyroscopicMode, gyroscopic_modes};
pub use lowest_modes::{LowMode, ModalOperator, lowest_modes};
pub use newmark::{AverageAcceleration, Motion, StepError};
pub use spectrum::{Spectrum, Window, spectrum};
pub use state_space::{StateMode, state_modes};
pub use subspace::{Direction, group_equal, orthonormal_basis, split};
pub use symmetric::{SymmetricModes, generalized_symmetric};
