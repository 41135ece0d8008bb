//! Errors of series over torque.

/// Why peaks or deflections have no values over torque.
#[derive(Debug, thiserror::Error)]
pub enum TorqueError {
    /// The scene has no operating point, or no motion follows from it.
    #[error(transparent)]
    Kinematics(#[from] gearset::KinematicsError),
    /// An error of the model under test, passed on unchanged.
    #[error("the model: {0}")]
    Model(#[source] crate::model::ModelError),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// A spectrum.
    #[error(transparent)]
    Spectrum(#[from] dynamics::SpectrumError),
}
