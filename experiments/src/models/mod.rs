//! Models for experiments: the two of this project, recorded results of other models, and models on changed
//! scenes for negative controls.

mod changed;
mod fe_contact;
mod lumped;
mod recorded;

pub use changed::Changed;
pub use fe_contact::{FeContact, ModalRoute};
pub use lumped::Lumped;
pub use recorded::{NotRecorded, Recorded, RecordedError};
