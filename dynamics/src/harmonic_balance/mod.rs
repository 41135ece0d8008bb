//! Periodic motions of a linear system with couplings by harmonic balance, without a time step.
//!
//! Of the system of [`Coupled`](crate::Coupled), motions of the period of the cycle are Fourier series. The linear
//! part is condensed exactly, harmonic by harmonic ([`BalanceEquations`]), so that the coordinates' means and the
//! deflections' harmonics are all that is solved for. The means stay as coordinates since K alone may be singular
//! where only couplings hold the system. The forces' coefficients P_l are found by evaluating F at the S steps of the
//! cycle and transforming back (alternating frequency/time), and their derivative from the transform of ∂F/∂z along
//! the cycle, which is exact for the sampled equations.
//!
//! **Samples.** The law is known at the S steps of its cycle and at no others, so these are the samples. At least
//! 4H + 1 are required: then no product of up to three harmonics is folded onto a harmonic that is kept. Forces
//! with kinks have no highest harmonic; what is folded back decays with S as their spectrum does, l⁻² at a change
//! of stiffness. Comparing S with 2S shows its size. Along a branch the sampled equations have kinks where a sample
//! crosses one of the force, and at light damping small folds of their own.
//!
//! **What it cannot show.** Motions of other periods (subharmonic, quasi-periodic) are not in the ansatz, and
//! stability is not judged here.

mod equations;
mod error;
mod fourier;
mod motion;
mod newton;
mod options;
mod problem;
mod solve;

pub use equations::BalanceEquations;
pub use error::BalanceError;
pub use fourier::FourierSeries;
pub use motion::BalancedMotion;
pub use options::BalanceOptions;
pub use problem::HarmonicBalance;
