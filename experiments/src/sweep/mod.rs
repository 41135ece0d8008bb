//! Speed sweeps: steady states of a turning set by marching, their harmonics, as fixed plans.

mod coexisting;
mod damped_model;
mod extrapolation;
mod failed_point;
mod judge;
mod marching;
mod mesh_law_model;
mod naturals;
mod peaks;
mod plan;
mod point;
mod record;
mod run;
mod set_shape;
mod shooting;
mod state;
mod steady;
mod sweep_model;

pub use damped_model::DampedModel;
pub use failed_point::FailedPoint;
pub use judge::{Assigned, Content, assigned, contents, peak_speeds};
pub use marching::{Effort, Marching};
pub use mesh_law_model::{LUMPED, MeshLawModel};
pub use naturals::naturals;
pub use peaks::{Peak, Response, peaks, top_of_three};
pub use plan::{Chain, Direction, Plan, PlanError, even_speeds};
pub use point::{SweepPoint, TableRow};
pub use record::Record;
pub use run::{Kept, Memory, PointStore, StoreError, Sweep, run};
pub use set_shape::SetShape;
pub use shooting::CycleDerivative;
pub(crate) use shooting::{RecordedCycles, SMALL, shot};
pub use state::{Coordinate, Line, Part, SteadyState};
pub use steady::{MOST_REPEATS, Steady, SteadyMethod, SteadySettings, left_of_transient, steady};
pub use sweep_model::{FeModel, HEADROOM, SweepModel, fidelity_name};
