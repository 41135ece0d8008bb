#![doc = include_str!("../README.md")]

pub mod benchmark_subjects;
mod bundles;
pub mod continuation;
mod convergence;
mod coupled;
mod error;
mod factored;
mod gyroscopic;
pub mod harmonic_balance;
pub mod identify;
mod lowest_modes;
mod matrix;
mod newmark;
mod number;
mod periodic;
mod rotating_frame;
mod spectrum;
pub mod stability;
mod state_space;
mod subspace;
mod symmetric;
mod wide;

pub use bundles::{Bundle, Bundles, InBundles, MOST as MOST_IN_BUNDLE, in_bundles};
pub use convergence::{Extrapolated, error_by_distances, extrapolate};
pub use coupled::{
    Coupled, CoupledDerivative, CoupledError, CoupledState, Coupling, CouplingForce, CyclePart,
    LinearPart, PassedSteps, Renumbering,
};
pub use error::{EigenError, SpectrumError};
pub use factored::{FactoredModes, SpringRow, factored_modes};
pub use faer::c64;
pub use gyroscopic::{GyroscopicMode, gyroscopic_modes};
/// The crate whose matrices and vectors stand in signatures.
pub use nalgebra;

pub use lowest_modes::{LowMode, ModalOperator, lowest_modes};
pub use newmark::{AverageAcceleration, Motion, StepError};
pub use number::Number;
pub use periodic::{
    CarriedChange, Correction, MapDerivative, Multiplier, MultiplierKind, PeriodMap,
    PeriodicSolution, ShootingError, ShootingSettings, floquet_vector, multipliers, shoot,
};
pub use rotating_frame::RotatingFrame;
pub use spectrum::{Spectrum, Window, spectrum};
pub use state_space::{StateMode, state_modes};
pub use subspace::{IMPURE, SubspaceDirection, group_equal, orthonormal_basis, split};
pub use symmetric::{SymmetricModes, generalized_symmetric};
pub use wide::{Computation, Simd, wide};
