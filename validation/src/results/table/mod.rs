//! Tables as spreadsheets, MATLAB and Python write them.
//!
//! A first line of titles is required; it decides what separates the columns: a tab or `;`, whichever comes first, else
//! a comma. Columns may stand in any order and in any case, `Frequency [kHz]` is `frequency_khz`, and a unit in the
//! title is converted to the unit of the column. Where the separator is not a comma, decimal commas are read. A
//! byte-order mark, blank lines, lines that begin with `#` and the line `sep=;` of Excel are skipped.

mod cell;
mod column;
mod error;
mod header;
mod number;
mod reader;
mod remark;
#[cfg(test)]
mod tests;
mod unit;

pub use cell::Cell;
pub use column::{Column, Content};
pub use error::TableError;
pub(super) use header::separator;
pub(super) use number::number;
pub use reader::{Row, Table};
pub use remark::Remark;
pub use unit::{Dimension, Quantity};
