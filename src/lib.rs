//! Verification and benchmark suite for planetary gear dynamics: the crates that do the work, under one
//! name, and with the feature `command` the `epicyclic` command.
//!
//! | module | what it holds |
//! |---|---|
//! | [`gearset`] | scene files, load cases, involute geometry, planet phasing, kinematics, excitation rules |
//! | [`dynamics`] | eigenproblems, time steps, spectra and identification; knows no gears |
//! | [`lumped`] | the lumped-parameter model of Lin and Parker |
//! | [`fe_contact`] | finite-element/contact model: meshes, contact, statics, vibration |
//! | [`experiments`] | natural modes, impulse tests, speed sweeps on either model |
//! | [`validation`] | checks against published numbers, theorems and each other |
//!
//! With `default-features = false` only these crates are built.

#[cfg(feature = "command")]
mod arguments;
#[cfg(feature = "command")]
mod commands;
#[cfg(feature = "command")]
mod error;
#[cfg(feature = "charts")]
pub mod figures;
#[cfg(feature = "command")]
mod folder;
#[cfg(feature = "command")]
mod inputs;
#[cfg(feature = "command")]
mod output;

pub use dynamics;
#[cfg(feature = "fe")]
pub use experiments;
#[cfg(feature = "fe")]
pub use fe_contact;
pub use lumped;
#[cfg(feature = "validation")]
pub use validation;

/// Scene files, and the mechanics of the set that they describe: the crates `scene` and `gearset` under one name.
pub mod gearset {
    pub use ::gearset::*;
    pub use ::scene::*;
}

#[cfg(feature = "command")]
pub use commands::{run, schemas};
#[cfg(feature = "command")]
pub use error::CommandError;

/// The README's Rust sections, which are compiled and run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExamples;

/// Those of the page about the library.
#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
pub struct LibraryExamples;
