//! Sets in time: bodies on the fidelities of the fidelity ladder, contact inside every step.

mod bearings;
mod body;
mod build;
mod checkpoint;
mod damping;
mod energy;
mod exact;
mod frame;
mod full_body;
mod gear;
mod lag;
mod leaning;
mod linear;
mod mesh_law;
mod modal_body;
mod packed;
mod positions;
mod prepared;
mod rest;
mod set;
mod step;
mod teeth;

pub use body::{Port, RaceMotion, VibratingBody};
pub use damping::Proportional;
pub use energy::{Energies, StepStart, StepWork};
pub use full_body::{FullBody, SharedFactors};
pub use linear::{DampedMode, LinearSet};
pub use mesh_law::{LawSettings, MeshLawSet, mesh_law};
pub use modal_body::{FixedRaceMode, ModalBody, fixed_race_modes};
pub use prepared::{Loading, Prepared};
pub use set::{Counts, Motive, VibratingSet};
