//! What stands in one cell.

/// A cell that was read as its column demands.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Nothing, in a column that allows it.
    Empty,
    /// Text or one of the allowed words.
    Text(String),
    /// A finite number in the unit of the column.
    Number(f64),
    /// A whole number.
    Count(usize),
}
