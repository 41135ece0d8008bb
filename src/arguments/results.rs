//! `results`.

use std::path::PathBuf;

use clap::Subcommand;
use validation::ModelKind;

use super::{Format, model_kinds};

#[derive(Debug, Subcommand)]
pub(crate) enum Results {
    /// Write a results folder ready to be filled: scenes, tables without values, results.toml.
    New {
        /// Id of a shipped scene (`oh58_4p`), a scene file, or `all` scenes that suites ask about.
        scene: String,
        /// Folder to write; refused if it is there and not empty.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// What kind of model the results will come from: tables that suites of this kind ask for are written.
        #[arg(long = "as", value_name = "KIND", default_value = "lumped",
              value_parser = model_kinds())]
        kind: ModelKind,
    },
    /// Say what a results folder holds, what contradicts itself, what it can be asked, and what further suites need.
    Check {
        /// Results folder (docs/results.md).
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// What kind of model the results come from, instead of what results.toml says.
        #[arg(long = "as", value_name = "KIND", value_parser = model_kinds())]
        kind: Option<ModelKind>,
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
}
