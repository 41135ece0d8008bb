//! Errors of coupled systems.

use crate::error::EigenError;

/// Why a coupled system cannot be set up, put to rest or stepped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CoupledError {
    /// The modes of the linear part cannot be computed.
    #[error("modes of the linear part: {0}")]
    Modes(#[from] EigenError),
    /// A list or matrix of the wrong size.
    #[error("{what} has {got} entries, the system {wanted}")]
    Size {
        /// Name of the list or matrix.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length it must have.
        wanted: usize,
    },
    /// A number that is not finite, or a negative lag.
    #[error("{what} of coupling {coupling} is {value}")]
    Coupling {
        /// Name of the quantity.
        what: &'static str,
        /// Which coupling.
        coupling: usize,
        /// Its value.
        value: f64,
    },
    /// More couplings than the solver is compiled for.
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
    /// The static iteration did not converge.
    #[error("no equilibrium in {iterations} iterations: {residual:e} of the load is left")]
    NoEquilibrium {
        /// Iterations.
        iterations: usize,
        /// Largest imbalance over the load.
        residual: f64,
    },
    /// The iteration of a time step did not converge.
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
    /// A displacement above its bound, or not a number.
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
