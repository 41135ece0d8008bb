//! Errors of modal tests.

/// Why a set has no modes, or a modal test could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum ModalError {
    /// The set lacks something the comparison with a lumped model needs.
    #[error("the scene has no {0}")]
    Incomplete(&'static str),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// An eigenproblem.
    #[error(transparent)]
    Eigen(#[from] dynamics::EigenError),
    /// A lumped model.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
    /// Settings of an impulse test.
    #[error(transparent)]
    Settings(#[from] super::settings::SettingsError),
    /// A preload under which the set does not stay at rest, or does not return to it after a small pulse.
    #[error(
        "{torque_nm} N·m on the sun: under this torque the set does not stay at rest, or small pulses leave it in large motion: there is no state to find modes about"
    )]
    Unsteady {
        /// Torque on the sun, N m.
        torque_nm: f64,
    },
    /// Identification of modes from records.
    #[error("identification: {0}")]
    Identify(#[from] dynamics::identify::IdentifyError),
}
