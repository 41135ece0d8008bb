//! The data set: one value per quantity, scene and kind of model, with its uncertainty and the routes that agree on it,
//! and the score of a result that is held against it.

/// Version of the data set: it changes with any value.
pub const DATA_SET_VERSION: &str = "1";

mod check;
mod class;
mod closed_form;
mod drift;
mod given;
mod package;
mod quantity;
mod row;
mod score;
mod table;

pub use check::{Alteration, altered};
pub use class::Class;
pub use closed_form::closed_forms;
pub use drift::{Drift, Moved};
pub use given::{Score, digits_of, given_rows, scores};
pub use package::{package, sha256};
pub use quantity::{QUANTITIES, Quantity};
pub use row::Row;
pub use score::correct_digits;
pub use table::{CertifiedValues, RowError, TABLES, read_rows, write_rows};
