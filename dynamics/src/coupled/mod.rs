//! A linear system with a few scalar nonlinear couplings, in time.
//!
//! The forces F_m of [`Coupled`] do not fall with deflection; that of a one-sided coupling is zero up to first
//! contact. To first order in the lag τ_m the force is F + τ F' δ̇: damping in proportion to the coupling's
//! stiffness. It ends with contact, makes no force tensile, and dissipates energy since F does not fall.
//!
//! With Newmark's average acceleration a step is linear except for the couplings, so that only the deflections are
//! solved for iteratively (`newton.rs`). Y is constant. In the modes of (K, M) A is diagonal if C is
//! proportional, so that a step costs little more than the evaluation of the forces F_m.

mod condensed;
mod coupling;
mod derivative;
mod error;
mod gradients;
mod linear;
mod newton;
mod renumbering;
mod rest;
mod state;
mod system;

pub use coupling::{Coupling, CouplingForce};
pub use derivative::{CoupledDerivative, PassedSteps};
pub use error::CoupledError;
pub use linear::LinearPart;
pub use renumbering::{CyclePart, Renumbering};
pub use system::{Coupled, CoupledState};
