//! Why checks could not be run.

/// Why checks could not be run at all.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    /// Reference data.
    #[error(transparent)]
    Reference(#[from] crate::reference::ReferenceError),
    /// A scene of the catalogue.
    #[error("scene of the catalogue: {0}")]
    Scene(#[from] gearset::SceneError),
    /// A scene of the catalogue lacks something a check needs.
    #[error("a scene of the catalogue has no {0}")]
    Incomplete(&'static str),
    /// A lumped model.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
}
