//! Branches of solutions of F(y, λ) = 0 by pseudo-arclength continuation.
//!
//! In scaled variables u = (y/s, λ/s_λ) a point is predicted along the unit tangent t of the last one and corrected
//! by Newton's method in the hyperplane across it, so that folds, where λ turns back, are points like any other. The
//! step h follows the iterations needed and the turn between tangents. A fold is where the λ-component of the tangent
//! changes sign, any other bifurcation where a test function of the family does; both are located along the arc by a
//! bracketed secant iteration.
//!
//! Equations with kinks are followed too: where the branch turns by less than a right angle as anywhere else, where it
//! turns back along the tangent of the piece beyond (`kink.rs`).
//!
//! **What is missed.** Two sign changes of one function within a step cancel. At a branch point the tangent is not
//! unique: the branch is followed straight across, and others are reached by [`branch_off`].

mod branch;
mod error;
mod family;
mod kept_step;
mod kink;
mod locate;
mod options;
mod space;
mod trace;

pub use branch::{Branch, BranchPoint, End, PointKind};
pub use error::ContinuationError;
pub use family::{Evaluation, Family, Judgement};
pub use kept_step::{KeptStep, StepEnd, StepStore, Unkept};
pub use options::{ContinuationOptions, Scales};
pub use trace::{Direction, branch_off, trace, trace_both};
