//! Periodic motions of a linear system with couplings by harmonic balance, without a time step.
//!
//! For the system of [`Coupled`](crate::Coupled),
//!
//! ```text
//! M ẍ + C ẋ + K x + Rᵀ P = f(θ),   δ = R x − o,   P_m = F_m(θ, z_m),   z_m = δ_m + τ_m δ̇_m,   θ = ω t,
//! ```
//!
//! motions of the period of the cycle are Fourier series, x = Re Σ X_l exp(i l θ), l = 0 … H. The linear part is
//! condensed exactly, harmonic by harmonic:
//!
//! ```text
//! Z_l = K − (lω)² M + i lω C,   Δ_l = R Z_l⁻¹ (f_l − Rᵀ P_l)   (l ≥ 1),   K X_0 + Rᵀ P_0 = f_0
//! ```
//!
//! so that the coordinates' means and the deflections' harmonics are all that is solved for. The means stay as
//! coordinates since K alone may be singular where only couplings hold the system. The forces' coefficients P_l
//! are found by evaluating F at the S steps of the cycle and transforming back (alternating frequency/time:
//! Cameron & Griffin, J. Appl. Mech. 56 (1989) 149–154), and their derivative from the transform of ∂F/∂z
//! along the cycle, which is exact for the sampled equations (Krack & Gross, *Harmonic Balance for Nonlinear
//! Vibration Problems*, Springer 2019, ch. 2–3).
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
