//! Why a system cannot be integrated in time.

use crate::error::EigenError;

/// Why a system or a scheme is refused, or a step has no solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IntegratorError {
    /// Matrices, loads, rows or states of different sizes.
    #[error("{what} has {got} entries a side where {wanted} are wanted")]
    Size {
        /// What is of the wrong size.
        what: &'static str,
        /// Its size.
        got: usize,
        /// The size of the system.
        wanted: usize,
    },
    /// A number that is not finite.
    #[error("{what} has an entry that is not finite")]
    NotFinite {
        /// Where it stands.
        what: &'static str,
    },
    /// A step that is not positive and finite.
    #[error("the time step is {0} s: it must be positive and finite")]
    Step(f64),
    /// A parameter of a scheme outside its range.
    #[error("{scheme}: {parameter} is {value}: allowed is {allowed}")]
    Parameter {
        /// Scheme.
        scheme: &'static str,
        /// Its parameter.
        parameter: &'static str,
        /// Value given.
        value: f64,
        /// Range.
        allowed: &'static str,
    },
    /// A matrix of the scheme that is not positive definite.
    #[error(
        "{scheme}: {matrix} is not positive definite: mass or stiffness leaves a coordinate without resistance"
    )]
    Indefinite {
        /// Scheme.
        scheme: &'static str,
        /// Matrix in words.
        matrix: &'static str,
    },
    /// An explicit step beyond its limit.
    #[error(
        "central difference is unstable: Δt·ω_max = {product:.6} is above 2 (ω_max = {omega_max:.6e} rad/s, Δt = {step:.6e} s): \
         take a step of at most {largest:.6e} s, or an implicit scheme"
    )]
    Unstable {
        /// Δt·ω_max.
        product: f64,
        /// Highest natural frequency, rad/s.
        omega_max: f64,
        /// Step, s.
        step: f64,
        /// Largest stable step, s.
        largest: f64,
    },
    /// The contact problem has no solution that the pivoting finds.
    #[error("the contact problem of {obstacles} obstacles was not solved: {why}")]
    Contact {
        /// Number of obstacles.
        obstacles: usize,
        /// Cause.
        why: &'static str,
    },
    /// Forces that depend on displacements and the step under them did not agree.
    #[error(
        "{scheme}: the forces of a step still change by {change:e} of their size after all iterations: take a smaller step"
    )]
    Unsettled {
        /// Scheme.
        scheme: &'static str,
        /// Change over the largest force.
        change: f64,
    },
    /// Natural frequencies were not found.
    #[error(transparent)]
    Eigen(#[from] EigenError),
}
