//! Errors of experiments.

/// Why an experiment could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The scene lacks something the experiment needs.
    #[error("the scene has no {0}")]
    Incomplete(&'static str),
    /// The scene has no operating point, or no motion follows from it.
    #[error(transparent)]
    Kinematics(#[from] gearset::KinematicsError),
    /// An error of the model under test, passed on unchanged.
    #[error("the model: {0}")]
    Model(#[source] crate::model::ModelError),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// An eigenproblem.
    #[error(transparent)]
    Eigen(#[from] dynamics::EigenError),
    /// Settings of an impulse test.
    #[error(transparent)]
    Settings(#[from] crate::modal::SettingsError),
    /// A preload under which the set does not stay at rest, or does not return to it after a small pulse.
    #[error(
        "{torque_nm} N·m: under this torque the set does not stay at rest, or small pulses leave it in large motion: there is no state to find modes about"
    )]
    Unsteady {
        /// Torque on the sun, N m.
        torque_nm: f64,
    },
    /// Identification of modes from records.
    #[error("identification: {0}")]
    Identify(#[from] dynamics::identify::IdentifyError),
    /// A spectrum.
    #[error(transparent)]
    Spectrum(#[from] dynamics::SpectrumError),
    /// A lumped model.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
    /// A plan of a sweep.
    #[error(transparent)]
    Plan(#[from] crate::sweep::PlanError),
    /// A speed of a sweep at which no steady state could be computed.
    #[error(transparent)]
    Failed(Box<crate::sweep::FailedPoint>),
    /// A speed of a sweep at which no motion was found that repeats with the mesh cycle and attracts.
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
    /// A branch of periodic motions that could not be begun.
    #[error(transparent)]
    Branch(#[from] crate::branches::BranchError),
    /// A point of a sweep that could not be kept or read.
    #[error(transparent)]
    Store(#[from] crate::sweep::StoreError),
}
