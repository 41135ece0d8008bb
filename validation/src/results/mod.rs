//! Results of any program as a folder of tables: read as spreadsheets and MATLAB write them, and held against
//! themselves before any check judges them.
//!
//! | file | a row is | columns |
//! |---|---|---|
//! | `results.toml` | | [`Manifest`] |
//! | `modes.csv` | a natural frequency | [`ModeRow`] |
//! | `mesh_cycle.csv` | one quantity at one position of the mesh cycle | [`CycleRow`] |
//! | `mesh_stiffness.csv` | stiffness of one mesh at one position of the mesh cycle | [`StiffnessRow`] |
//! | `steady_states.csv` | one harmonic of one quantity at one speed | [`StateRow`] |
//! | `torque_peaks.csv` | a resonant peak under one torque | [`PeakRow`] |
//! | `rules.csv` | kinds of modes that a harmonic can excite | [`RuleRow`] |
//! | `matrices/` | | [`GivenMatrix`] |
//!
//! A [`ResultsFolder`] that is read tells what its reader took for granted as [`Remark`]s, and what in it cannot be
//! true as [`Contradiction`]s; [`Template`] is a folder that is ready to be filled.

mod contradictions;
mod folder;
mod judgement;
mod known_scenes;
mod manifest;
mod matrices;
mod mode_list;
mod model;
mod rows;
pub mod table;
mod writing;

pub use contradictions::Contradiction;
pub use folder::{FolderError, ResultsFolder};
pub use judgement::{AskedSuite, JudgeError, Judgement, Questions};
pub use known_scenes::{KnownScene, KnownScenes, UnknownScene};
pub use manifest::{
    Accepted, Convention, Manifest, ManifestError, PlanetTranslations, Radius, RotationCoordinate,
    Threshold,
};
pub use matrices::{GivenMatrix, MatrixError, MatrixKind, SceneMatrices};
pub use mode_list::ModeList;
pub use rows::{
    CycleRow, ModeRow, PeakRow, RuleRow, StateRow, StiffnessRow, VectorAxis, VectorEntry,
};
pub use table::{Remark, TableError};
pub use writing::{SceneFile, Template};
