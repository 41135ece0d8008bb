//! Studies: quantities of interest, one truth for each, many settings; error against cost.
//!
//! A study file names a scene, the quantities, the routes to their truth and the settings to be compared. Every
//! setting is run in several rounds, and each run is timed between two runs of a yardstick (mesh cycles of the lumped
//! model of the same scene), so that a cost is a ratio of times a fraction of a second apart. Counted work, which
//! depends on no clock, stands beside it.

mod answers;
#[cfg(test)]
mod controls;
mod cost;
mod efficiency;
mod error;
mod experiment;
mod key_types;
mod quantity;
mod result;
mod run;
mod setting;
mod study_file;
mod truth;
mod yardstick;

pub use cost::{CpuTime, Quartiles, Stopwatch, Timings, interleaved, quartiles};
pub use efficiency::{Candidate, Doubt, Judged, judge};
pub use error::StudyError;
pub use experiment::Work;
pub use quantity::{QuantityKind, WorkKind};
pub use result::{
    QuantityResult, QuantityTime, RouteResult, Row, RowTime, SettingResult, StudyResult, StudyTime,
    TruthResult,
};
pub use run::{run_study, run_study_with};
pub use setting::{ContactSolver, StudyIntegrator, StudyModel};
pub use study_file::StudyFile;
