//! `dataset` and `snapshot`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::Format;

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct DataSet {
    /// Folder to write; refused if it is there and not empty.
    #[arg(value_name = "DIR", required = true)]
    pub folder: Option<PathBuf>,
    #[command(subcommand)]
    pub verb: Option<DataSetVerb>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum DataSetVerb {
    /// Say what in a folder with the data set was altered: hashes, columns, units, ranges, values; exit code 1 if any.
    Check {
        /// The folder.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
}

#[derive(Debug, Args)]
pub(crate) struct Snapshot {
    /// Results folder (docs/results.md).
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,
    /// Compare the results with their baseline instead of storing them; exit code 1 if a value moved.
    #[arg(long)]
    pub check: bool,
    /// File of the baseline; by default RESULTS.baseline.csv beside the folder.
    #[arg(long, value_name = "FILE")]
    pub baseline: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text, requires = "check")]
    pub format: Format,
}
