//! Why a coupled system cannot be, or did not move on.

use crate::error::EigenError;

/// Why a coupled system cannot be, or did not move on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CoupledError {
    /// Modes of the linear part.
    #[error("modes of the linear part: {0}")]
    Modes(#[from] EigenError),
    /// Sizes that do not go together.
    #[error("{what} has {got} entries, the system {wanted}")]
    Size {
        /// What.
        what: &'static str,
        /// Its length.
        got: usize,
        /// Length of the system.
        wanted: usize,
    },
    /// A number that is none, or a lag that is negative.
    #[error("{what} of coupling {coupling} is {value}")]
    Coupling {
        /// What.
        what: &'static str,
        /// Which coupling.
        coupling: usize,
        /// Its value.
        value: f64,
    },
    /// More couplings than steps are made for.
    #[error("{got} couplings: at most {most} are solved for")]
    TooMany {
        /// Couplings given.
        got: usize,
        /// Most allowed.
        most: usize,
    },
    /// A cycle without steps.
    #[error("a cycle of no steps")]
    NoSteps,
    /// The step's matrix is singular.
    #[error("the step's matrix is singular: a coordinate has neither inertia nor stiffness")]
    Singular,
    /// The load drives a motion that nothing holds.
    #[error("no equilibrium: the load drives a motion that neither support nor coupling holds")]
    NothingHolds,
    /// Static iterations did not end.
    #[error("no equilibrium in {iterations} iterations: {residual:e} of the load is left")]
    NoEquilibrium {
        /// Iterations.
        iterations: usize,
        /// Largest imbalance over the load.
        residual: f64,
    },
    /// Iterations of a step did not end.
    #[error(
        "at {time_s:e} s the coupled step is not solved in {iterations} iterations: coupling {coupling} is off by {residual_m:e} m"
    )]
    NotConverged {
        /// Time, s.
        time_s: f64,
        /// Iterations.
        iterations: usize,
        /// Worst coupling.
        coupling: usize,
        /// Its residual, m.
        residual_m: f64,
    },
    /// Motion left all bounds.
    #[error("the motion diverges: at {time_s:e} s coordinate {coordinate} is {value:e} m")]
    Diverged {
        /// Time, s.
        time_s: f64,
        /// Which coordinate.
        coordinate: usize,
        /// Its value, m.
        value: f64,
    },
}
