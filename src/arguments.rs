//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Verification and benchmark suite for planetary gear dynamics (2-D, spur, single stage).
#[derive(Debug, Parser)]
#[command(version, about, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
}

#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Judge the models against published tables and theorems.
    Validate(Validate),
    /// Natural frequencies and mode types of a scene's lumped model.
    Modes(Modes),
    /// Which mesh harmonics excite which kinds of modes, and how strongly.
    Rules(Rules),
    /// Write or explain a scene file.
    #[command(subcommand)]
    Scene(SceneVerb),
    /// Hold somebody's natural frequencies against a scene's lumped model.
    Compare(Compare),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table for people.
    Text,
    /// Stable keys for programs; schemas in `schemas/`.
    Json,
}

#[derive(Debug, Args)]
pub struct Validate {
    /// Also write the verdict and the mode tables to this folder (Markdown, JSON, SVG).
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// How much to run; until there are slow checks the two are the same.
    #[arg(long, value_enum, default_value_t = Profile::Quick)]
    pub profile: Profile,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Profile {
    /// Minutes.
    Quick,
    /// Everything.
    Full,
}

#[derive(Debug, Args)]
pub struct Modes {
    /// Scene file.
    pub scene: PathBuf,
    /// Also list where each mode's energy is and what its frequency depends on.
    #[arg(long)]
    pub details: bool,
    /// Frequencies with gyroscopic terms at these carrier speeds, rpm (Campbell data).
    #[arg(long, value_name = "RPM,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub carrier_speeds_rpm: Vec<f64>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub struct Rules {
    /// Scene file.
    pub scene: PathBuf,
    /// Highest harmonic of mesh frequency.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub harmonics: u32,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Subcommand)]
pub enum SceneVerb {
    /// Write a commented scene file to start from.
    New {
        /// File to write; `-` for standard output. An existing file is never overwritten.
        path: PathBuf,
        /// What the scene describes.
        #[arg(long, value_enum, default_value_t = Kind::Planetary)]
        kind: Kind,
    },
    /// Read a scene, report every fault, explain what it says.
    Check {
        /// Scene file.
        scene: PathBuf,
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// A whole planetary set.
    Planetary,
    /// One mesh alone.
    GearPair,
}

#[derive(Debug, Args)]
pub struct Compare {
    /// CSV file with a `frequency_hz` column and, optionally, `mode_type` and `multiplicity`.
    pub modes: PathBuf,
    /// Scene the frequencies belong to.
    #[arg(long)]
    pub scene: PathBuf,
    /// Largest difference that counts as agreement, percent.
    #[arg(long, default_value_t = 1.0, value_parser = tolerance)]
    pub tolerance_percent: f64,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if f64::is_finite(x) && x > 0.0 && x <= 100.0 => Ok(x),
        _ => Err("a number above 0, at most 100".into()),
    }
}
