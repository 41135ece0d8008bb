//! Errors of branches.

/// Why a branch of periodic motions could not be begun.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BranchError {
    /// The model has no derivative of its cycles.
    #[error(
        "{0}: the model has no derivative of its time steps, without which no branch can be followed"
    )]
    NoDerivative(String),
    /// No periodic motion was found to begin with.
    #[error("no periodic motion at {speed_rpm} rpm to begin with: {reason}")]
    NoStart {
        /// Speed of the input member, rpm.
        speed_rpm: f64,
        /// What shooting or continuation say.
        reason: String,
    },
    /// Speeds that bound nothing, or a start outside.
    #[error("speeds from {from:?} to {to:?} rpm, starting at {start:?} rpm: {allowed}")]
    Speeds {
        /// Least speed, rpm.
        from: f64,
        /// Greatest speed, rpm.
        to: f64,
        /// Speed of the first point, rpm.
        start: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// Too few points.
    #[error("{0} points: a branch needs at least 2")]
    Points(usize),
}
