//! What `auto` answers, and why it may not.

use schemars::JsonSchema;
use serde::Serialize;

use super::settings::AutoSettings;

/// One part of an estimated error.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ErrorPart {
    /// The approximation that causes it.
    pub source: String,
    /// Its size, percent of the quantity.
    pub percent: f64,
}

impl ErrorPart {
    pub(super) fn new(source: &str, share: f64) -> Self {
        Self { source: source.into(), percent: 100.0 * share }
    }
}

/// A candidate that was not chosen.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PassedOver {
    /// Its settings.
    pub settings: AutoSettings,
    /// Its estimated error, percent; absent where the candidate gave no answer, or none to compare it with.
    pub estimated_error_percent: Option<f64>,
    /// Why it was passed over.
    pub why: String,
}

/// The settings chosen for a quantity, and the answer with them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Choice {
    /// The quantity, in words.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
    /// Wanted accuracy, percent of the value.
    pub tolerance_percent: f64,
    /// Estimated error of the value, percent: the sum of `error_parts`.
    pub estimated_error_percent: f64,
    /// What the error consists of.
    pub error_parts: Vec<ErrorPart>,
    /// Settings chosen.
    pub settings: AutoSettings,
    /// Cheaper candidates, and why each was not chosen.
    pub passed_over: Vec<PassedOver>,
}

/// Sum of the parts, percent: as if all errors had one sign.
pub(super) fn total(parts: &[ErrorPart]) -> f64 {
    parts.iter().map(|part| part.percent).sum()
}

/// Why there is no choice.
#[derive(Debug, thiserror::Error)]
pub enum AutoError {
    /// A tolerance that is none.
    #[error(
        "`dynamics.tolerance_percent` is {0}: allowed is a finite number above 0 and up to 100"
    )]
    Tolerance(f64),
    /// No candidate has the quantity: each with its reason.
    #[error("{quantity}: no settings give it: {}", listed(.passed_over))]
    NoAnswer {
        /// The quantity, in words.
        quantity: String,
        /// Every candidate that was tried.
        passed_over: Vec<PassedOver>,
    },
    /// Every candidate's estimated error is above the tolerance.
    #[error(
        "{quantity}: no settings are estimated to be within {tolerance_percent} %: {}; allow a larger tolerance, or name \
         the settings and judge them by a study", listed(.passed_over)
    )]
    NothingMeets {
        /// The quantity, in words.
        quantity: String,
        /// Wanted accuracy, percent.
        tolerance_percent: f64,
        /// Every candidate with its estimate.
        passed_over: Vec<PassedOver>,
    },
    /// The scene or the settings lack what the question needs.
    #[error("the scene has no {0}")]
    Incomplete(&'static str),
    /// The model has no answer, for this reason.
    #[error("the model: {0}")]
    Model(String),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// The lumped model in closed form.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
    /// Modes of a linearised set.
    #[error(transparent)]
    Modal(#[from] crate::modal::ModalError),
    /// Steady states.
    #[error(transparent)]
    Sweep(#[from] crate::sweep::SweepError),
}

/// Candidates with their reasons; a reason that neighbours share stands once, and alone where all share it.
fn listed(all: &[PassedOver]) -> String {
    let groups: Vec<&[PassedOver]> = all.chunk_by(|a, b| a.why == b.why).collect();
    let one = |group: &&[PassedOver]| {
        let settings: Vec<String> = group.iter().map(|p| p.settings.to_string()).collect();
        let why = group.first().map_or("", |p| p.why.as_str());
        match groups.len() {
            1 if group.len() > 1 => why.to_owned(),
            _ => format!("{}: {why}", settings.join(" and ")),
        }
    };
    groups.iter().map(one).collect::<Vec<_>>().join("; ")
}
