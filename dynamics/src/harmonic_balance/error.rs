//! Errors of harmonic balance.

use crate::coupled::CoupledError;

/// Why the equations of harmonic balance cannot be set up or solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BalanceError {
    /// The system itself is not valid, or has no equilibrium under its mean load.
    #[error("the system: {0}")]
    System(#[from] CoupledError),
    /// A list of the wrong size.
    #[error("{what} has {got} entries, the equations {wanted}")]
    Size {
        /// Name of the list.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length it must have.
        wanted: usize,
    },
    /// A number out of range.
    #[error("{what} is {value}: it must be positive and finite")]
    Value {
        /// Name of the quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Too few samples in a cycle for a number of harmonics.
    #[error(
        "{harmonics} harmonics need {} samples in a cycle, the law has {samples}",
        4 * harmonics + 1
    )]
    Samples {
        /// Harmonics asked for.
        harmonics: usize,
        /// Steps of the cycle.
        samples: usize,
    },
    /// The dynamic stiffness of the linear part is singular.
    #[error(
        "the dynamic stiffness at harmonic {harmonic} of {frequency} rad/s is singular: an undamped resonance of the linear part, or a coordinate without inertia and stiffness"
    )]
    Singular {
        /// Which harmonic.
        harmonic: usize,
        /// Fundamental frequency, rad/s.
        frequency: f64,
    },
    /// Newton's method did not converge, at the added damping to which continuation got.
    #[error(
        "no balance of {harmonics} harmonics at {frequency} rad/s in {iterations} iterations: the last correction is {correction:e} of the deflection, with a damping of {added_damping} 1/s added to the system's own"
    )]
    NotConverged {
        /// Harmonics.
        harmonics: usize,
        /// Fundamental frequency, rad/s.
        frequency: f64,
        /// Newton iterations spent.
        iterations: usize,
        /// Largest entry of the last correction over the largest deflection.
        correction: f64,
        /// Mass-proportional damping that continuation added when it stopped, 1/s.
        added_damping: f64,
    },
    /// The spectrum does not decay within the harmonics allowed.
    #[error(
        "the highest of {harmonics} harmonics still reach {tail:e} of the largest, more than the {tolerance:e} asked for"
    )]
    Tail {
        /// Harmonics of the last solution.
        harmonics: usize,
        /// Amplitude of its highest harmonics over the largest.
        tail: f64,
        /// Tail asked for.
        tolerance: f64,
    },
}
