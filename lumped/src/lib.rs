#![doc = include_str!("../README.md")]
//!
//! Source of the equations: Lin & Parker (1999), J. Vib. Acoust. 121, 316–321. Coordinates and signs are defined in
//! [`springs`](Spring) and checked in the tests against matrices derived by hand. A gear pair is a sun and one planet,
//! each on a bearing of its own.

mod analytic;
mod balanced;
mod coordinates;
mod energy;
mod error;
mod gyroscopic;
mod kinds;
mod model;
mod modes;
mod parametric;
mod participation;
mod relative_rotation;
mod scheme_set;
mod sensitivity;
mod spacing_tolerance;
mod springs;
mod time_varying;
mod torsional;
mod type_name;
mod type_tolerance;

/// The crate whose matrices and vectors stand in signatures.
pub use nalgebra;

pub use analytic::{AnalyticCycle, AnalyticRest, AnalyticSet, StatedError};
pub use balanced::BalancedSet;
pub use coordinates::Coordinates;
pub use energy::{EnergyShare, kinetic_energy, strain_energy};
pub use error::LumpedError;
pub use gyroscopic::{SpeedMode, SpeedModes, campbell};
pub use kinds::ModeType;
pub use model::LumpedModel;
pub use modes::{ModeGroup, NaturalModes};
pub use parametric::{MeshWave, ParametricSet, Tongue, TongueEdges, tongues};
pub use participation::Participation;
pub use scheme_set::{LAW_STEPS_A_STEP, SchemeSet};
pub use sensitivity::{Parameter, Sensitivity, sensitivities};
pub use spacing_tolerance::SpacingChange;
pub use springs::{Spring, SpringId};
pub use time_varying::{MeshLawCouplings, TimeVarying};
pub use type_name::{NamedModes, type_name};
pub use type_tolerance::{TypeTolerance, tolerances_to, type_warnings};
