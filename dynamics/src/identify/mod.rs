//! Modes from free decays: the Eigensystem Realisation Algorithm of Juang & Pappa (1985), with
//! several inputs and outputs, and its stabilisation chart.

mod chart;
mod decimation;
mod error;
mod hankel;
mod identification;
mod modes;
mod options;
mod realisation;
mod records;
mod selection;
mod shape;

pub use chart::{ChartOrder, Pole, Stability};
pub use error::IdentifyError;
pub use identification::{Identification, identify};
pub use modes::Mode;
pub use options::{Decimation, Method, Options, Scaling, Tolerances};
pub use shape::share_in_span;
