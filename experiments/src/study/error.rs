//! Why a study cannot be run.

use std::path::PathBuf;

use scene::SceneError;

use crate::model::ModelError;

/// Why a study cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Not TOML, an unknown key, or a value of the wrong type; the message names the key, the line and what is allowed.
    #[error("{0}")]
    Syntax(String),
    /// A key whose value cannot be used.
    #[error("`{key}` is {value}: allowed: {allowed}")]
    Key {
        /// Key with its table.
        key: String,
        /// What the file holds there, or "absent".
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// A load of a size that no model can bear.
    #[error("`{key}` is {reason}")]
    Load {
        /// Key with its table.
        key: String,
        /// Its value, what is allowed, and why.
        reason: String,
    },
    /// A file that the study names and that cannot be read.
    #[error("`{key}`: `{}` cannot be read: {cause}", path.display())]
    File {
        /// Key that names it.
        key: String,
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        #[source]
        cause: std::io::Error,
    },
    /// The scene of a setting is not valid.
    #[error("the scene of {of}: {source}")]
    Scene {
        /// Setting, route to the truth or yardstick.
        of: String,
        /// Its faults.
        #[source]
        source: SceneError,
    },
    /// The yardstick (mesh cycles of the lumped model of the study's scene) cannot be marched.
    #[error("the yardstick, mesh cycles of the lumped model of the scene, cannot be marched: {0}")]
    Yardstick(#[source] ModelError),
    /// A route to the truth gives no value.
    #[error("truth `{route}` of quantity `{quantity}`: {reason}")]
    Truth {
        /// The route.
        route: String,
        /// The quantity.
        quantity: String,
        /// Why.
        reason: String,
    },
    /// A setting whose answers differ between rounds.
    #[error(
        "setting `{setting}` gave {first:e} and then {then:e} for `{quantity}`: a study compares settings that give one \
         answer"
    )]
    Unrepeatable {
        /// The setting.
        setting: String,
        /// The quantity.
        quantity: String,
        /// In the first round.
        first: f64,
        /// In a later one.
        then: f64,
    },
    /// The thread on which a study runs cannot be made.
    #[error("no thread for the study: {0}")]
    Thread(String),
}

impl StudyError {
    pub(super) fn key(
        key: impl Into<String>,
        value: impl ToString,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Key { key: key.into(), value: value.to_string(), allowed: allowed.into() }
    }
}
