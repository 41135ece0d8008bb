//! Why checks could not be run.

/// Why checks could not be run at all.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    /// Reference data.
    #[error(transparent)]
    Reference(#[from] crate::reference_file::ReferenceError),
    /// A scene of the catalogue.
    #[error("scene of the catalogue: {0}")]
    Scene(#[from] scene::SceneError),
    /// A scene of the catalogue lacks something a check needs.
    #[error("a scene of the catalogue has no {0}")]
    Incomplete(&'static str),
    /// A scene of the catalogue has no operating point.
    #[error(transparent)]
    Kinematics(#[from] gearset::KinematicsError),
    /// The model under test failed; its own error.
    #[error("the model: {0}")]
    Model(#[source] experiments::ModelError),
    /// A choice of checks that holds none.
    #[error("`{front}`: no check's id starts so{hint}")]
    NoSuchCheck {
        /// What ids should start with.
        front: String,
        /// `; did you mean …`, if a suite has a name like it.
        hint: String,
    },
    /// No model is given.
    #[error("no model is given: it must answer one question, such as that for natural modes")]
    NoModel,
    /// A model was given and no suite could be asked.
    #[error("{}", nothing_asked(.0))]
    NothingAsked(Vec<crate::verdict::NotAsked>),
    /// A plan of a sweep.
    #[error(transparent)]
    Plan(#[from] experiments::sweep::PlanError),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// A contact problem.
    #[error(transparent)]
    Contact(#[from] fe_contact::complementarity::ComplementarityError),
    /// An eigenproblem.
    #[error(transparent)]
    Eigen(#[from] dynamics::EigenError),
    /// Modes of a linearised set or an impulse test.
    #[error(transparent)]
    Modal(#[from] experiments::modal::ModalError),
    /// Steady states.
    #[error(transparent)]
    Sweep(#[from] experiments::sweep::SweepError),
    /// Branches of steady states.
    #[error(transparent)]
    Branch(#[from] experiments::branches::BranchError),
    /// Series over torque.
    #[error(transparent)]
    Torque(#[from] experiments::torque::TorqueError),
    /// A spectrum.
    #[error(transparent)]
    Spectrum(#[from] dynamics::SpectrumError),
    /// A lumped model.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
}

/// What each suite lacks; without one the fronts of ids chose no check.
fn nothing_asked(suites: &[crate::verdict::NotAsked]) -> String {
    let one = |s: &crate::verdict::NotAsked| format!("{} needs {}", s.suite, s.lacks);
    match suites {
        [] => "no check of these results has an id that starts so".to_owned(),
        some => format!(
            "no suite could be asked: {}",
            some.iter().map(one).collect::<Vec<_>>().join("; ")
        ),
    }
}

impl ValidationError {
    /// Whether recorded tables were asked for results that they do not contain.
    pub(crate) fn is_not_recorded(&self) -> bool {
        let source = match self {
            Self::Model(source) | Self::Torque(experiments::torque::TorqueError::Model(source)) => {
                source
            }
            _ => return false,
        };
        source.is::<experiments::models::NotRecorded>()
    }
}
