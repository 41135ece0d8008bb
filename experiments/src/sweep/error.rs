//! Errors of sweeps.

use super::failed_point::FailedPoint;
use super::plan::PlanError;
use super::run::StoreError;
use crate::table_growth::Outgrown;

/// Why a model cannot be set up or stepped, or a sweep has no result.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The scene or the model lacks something that is needed.
    #[error("the scene has no {0}")]
    Incomplete(&'static str),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// An eigenproblem.
    #[error(transparent)]
    Eigen(#[from] dynamics::EigenError),
    /// A spectrum.
    #[error(transparent)]
    Spectrum(#[from] dynamics::SpectrumError),
    /// A lumped model.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
    /// A plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A speed at which no steady state could be computed.
    #[error(transparent)]
    Failed(Box<FailedPoint>),
    /// A speed at which no motion was found that repeats with the mesh cycle and attracts.
    #[error(
        "at {rpm} rpm no motion was found that repeats with the mesh cycle and attracts: {found}"
    )]
    NoSteadyState {
        /// Speed of the input member, rpm.
        rpm: f64,
        /// What was found.
        found: String,
    },
    /// A speed so low that the vibrations of the set need more steps than are taken.
    #[error(
        "the vibrations of the set need {steps} steps in a mesh cycle at this speed, and at most {most} are taken: a higher speed, more damping, or `dynamics.steps_per_cycle` = {steps} computes it"
    )]
    TooFewSteps {
        /// Steps needed.
        steps: usize,
        /// Most that are taken.
        most: usize,
    },
    /// A torque whose sense is not that of the torque a model was made for.
    #[error(
        "{torque_nm} N·m on the sun: the model was made under {own_nm} N·m, and a torque in the other sense presses the other flanks"
    )]
    OtherFlanks {
        /// Torque asked for, N m.
        torque_nm: f64,
        /// Torque of the model, N m.
        own_nm: f64,
    },
    /// A value of a varied scene key that the scene does not allow.
    #[error("{key} = {value:?}: {reason}")]
    KeyValue {
        /// Its path.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What the reader of scenes says.
        reason: String,
    },
    /// A point that could not be kept or read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl Outgrown for SweepError {
    fn is_too_small(&self) -> bool {
        matches!(self, Self::Fe(e) if e.is_too_small())
    }
}
