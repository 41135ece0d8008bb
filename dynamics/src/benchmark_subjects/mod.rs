//! Schemes held against one another and against theory: time integration of linear vibrating systems between rigid
//! obstacles, behind one trait. Motions of gear sets are stepped by
//! [`AverageAcceleration`](crate::AverageAcceleration) alone.
//!
//! ```text
//! M ẍ + C ẋ + K x = f + Gᵀ λ,   0 ≤ λ ⟂ g = d + G x ≥ 0
//! ```
//!
//! | scheme | source | how contact enters |
//! |---|---|---|
//! | average acceleration | Newmark, J. Eng. Mech. Div. ASCE 85 (1959) | force at the end of the step, gap ≥ 0 there |
//! | HHT-α | Hilber, Hughes & Taylor, Earthq. Eng. Struct. Dyn. 5 (1977) | the same, at the weighted instant |
//! | generalised-α | Chung & Hulbert, J. Appl. Mech. 60 (1993) | the same |
//! | Bathe composite | Bathe, Comput. Struct. 85 (2007) | gap ≥ 0 at the end of both substeps |
//! | contact-stabilised Newmark | Deuflhard, Krause & Ertel, Int. J. Numer. Meth. Eng. 73 (2008) | predictor projected, force implicit |
//! | Moreau–Jean | Acary, Z. Angew. Math. Mech. 96 (2016) | impulses with an impact law on velocities |
//! | central difference | Carpenter, Taylor & Katona, Int. J. Numer. Meth. Eng. 32 (1991) | force at the start, gap ≥ 0 at the end |
//!
//! Their spectral radius, period error and numerical damping are measured from these very steps
//! ([`amplification`]) and known in closed form ([`closed_form`]). Energy is not a matter of the spectral radius where
//! contacts open and close.
//!
//! `[eq:contact-energy-gain]` Average acceleration gains ½ (g₁ λ₀ − g₀ λ₁) in a step with contact, whatever its step.
//! Source: derived here from the trapezoidal rule and complementarity.
//! Checked by: `dynamics/tests/integrators.rs::contact_changes_the_energy_by_what_theory_says`.

mod amplification;
mod bathe;
mod central_difference;
mod characteristic;
mod complementarity;
mod contact_stabilised;
mod driven;
mod error;
mod factor;
mod generalized_alpha;
mod integrator;
mod moreau_jean;
mod obstacles;
mod scheme;
mod state;
mod system;

pub use amplification::{Amplification, amplification};
pub use characteristic::closed_form;
pub use driven::{Instant, driven_step};
pub use error::IntegratorError;
pub use integrator::{Integrator, StepForces};
pub use scheme::Scheme;
pub use state::StepState;
pub use system::{Obstacle, VibratingSystem};
