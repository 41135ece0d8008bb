//! Reading one of the files that the program holds: of `reference/`, `kept/` or `checks/`.

/// Why the reference data could not be used.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// A file of `reference/`, `kept/` or `checks/` is not what the code expects.
    #[error("{file} cannot be read: {cause}")]
    Unreadable {
        /// File name.
        file: &'static str,
        /// What the TOML reader said.
        #[source]
        cause: Box<toml::de::Error>,
    },
    /// A file of `kept/` is not what this program writes.
    #[error("{file} cannot be read: {cause}")]
    UnreadableJson {
        /// File name.
        file: &'static str,
        /// What the JSON reader said.
        #[source]
        cause: Box<serde_json::Error>,
    },
    /// A check or control that is declared nowhere.
    #[error("checks/registry.toml declares no check or control `{0}`")]
    Undeclared(String),
    /// A check that is judged by a band of parameters which is not kept.
    #[error("kept/parameter_bands.toml has no band for `{0}`")]
    NoBand(String),
}

/// Text of a file of the data crate; one that is missing is found when this crate is compiled.
macro_rules! embedded {
    ($path:expr) => {
        const { epicyclic_data::text($path).expect("a file of the data crate") }
    };
}

pub(crate) use embedded;

/// The contents of a file.
pub(crate) fn parse<T: serde::de::DeserializeOwned>(
    file: &'static str,
    text: &str,
) -> Result<T, ReferenceError> {
    toml::from_str(text)
        .map_err(|cause| ReferenceError::Unreadable { file, cause: Box::new(cause) })
}
