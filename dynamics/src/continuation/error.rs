//! Errors of continuation.

/// Why a branch cannot be started, or a solution not be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ContinuationError<E: std::error::Error> {
    /// The family could not be evaluated.
    #[error("at λ = {lambda}: {cause}")]
    Family {
        /// Parameter.
        lambda: f64,
        /// What the family says.
        cause: E,
    },
    /// A list of the wrong size.
    #[error("{what} has {got} entries, the family {wanted}")]
    Size {
        /// Name of the list.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length it must have.
        wanted: usize,
    },
    /// An option out of range.
    #[error("{what} is {value}: {allowed}")]
    Option {
        /// Name of the option.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// Newton's method did not converge.
    #[error(
        "no solution at λ = {lambda} in {iterations} iterations: the last scaled correction is {correction:e}"
    )]
    NotConverged {
        /// Parameter.
        lambda: f64,
        /// Iterations.
        iterations: usize,
        /// Largest entry of the last correction, scaled.
        correction: f64,
    },
    /// The equations have no direction at a point: the bordered matrix is singular.
    #[error("the branch has no single tangent at λ = {lambda}: the bordered matrix is singular")]
    NoTangent {
        /// Parameter.
        lambda: f64,
    },
    /// The branch turns more than allowed within the least step.
    #[error("after λ = {lambda} the branch turns by {turn} rad within the least step")]
    Turn {
        /// Parameter at the last point.
        lambda: f64,
        /// Angle between the tangents, scaled; infinite if the correction led away from the branch.
        turn: f64,
    },
}
