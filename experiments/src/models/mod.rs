//! Models that answer: the two of this project, tables of anybody's, and spoilt ones for negative controls.

mod changed;
mod fe_contact;
mod lumped;
mod recorded;

pub use changed::Changed;
pub use fe_contact::{FeContact, ModalRoute};
pub use lumped::Lumped;
pub use recorded::{NotRecorded, Recorded, RecordedError};
