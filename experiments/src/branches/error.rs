//! Errors of branches.

use super::parameter::BranchParameter;
use crate::sweep::SweepError;
use crate::table_growth::Outgrown;

/// Why a branch of periodic motions could not be begun or followed.
#[derive(Debug, thiserror::Error)]
pub enum BranchError {
    /// The model has no derivative of its cycles.
    #[error(
        "{0}: the model has no derivative of its time steps, without which no branch can be followed"
    )]
    NoDerivative(String),
    /// No periodic motion was found to begin with.
    #[error("no periodic motion to begin with at {start}{}: {reason}", .over.unit())]
    NoStart {
        /// What is varied.
        over: BranchParameter,
        /// Its value at the first point.
        start: f64,
        /// What shooting or continuation say.
        reason: String,
    },
    /// Values that bound nothing, or a start outside.
    #[error("{} from {from:?} to {to:?}{}, starting at {start:?}: {allowed}", .over.name(), .over.unit())]
    Range {
        /// What is varied.
        over: BranchParameter,
        /// Least value.
        from: f64,
        /// Greatest value.
        to: f64,
        /// Value at the first point.
        start: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A scene key on which the motion does not depend.
    #[error(
        "{key}: the motion of the model {model} is the same from {from:?} to {to:?}: the key has no effect there"
    )]
    NoEffect {
        /// Its path.
        key: &'static str,
        /// Name of the model.
        model: String,
        /// Least value.
        from: f64,
        /// Greatest value.
        to: f64,
    },
    /// Too few points.
    #[error("{0} points: a branch needs at least 2")]
    Points(usize),
    /// The model could not be set up or stepped, or a part could not be kept or read.
    #[error(transparent)]
    Sweep(#[from] SweepError),
}

impl Outgrown for BranchError {
    fn is_too_small(&self) -> bool {
        matches!(self, Self::Sweep(e) if e.is_too_small())
    }
}
