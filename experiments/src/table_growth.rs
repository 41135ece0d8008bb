//! Contact tables and tables of mesh force that are made again for twice the load if a load exceeds them.

use fe_contact::FeError;

/// Number of table sizes that are tried, each for twice the load of the one before.
pub const SIZES: usize = 5;

/// An error that can mean that tables are too small for the load.
pub trait Outgrown {
    /// Whether the tables are too small for the load.
    fn is_too_small(&self) -> bool;
}

impl Outgrown for FeError {
    fn is_too_small(&self) -> bool {
        matches!(self, Self::GridOverflow { .. } | Self::TableExceeded { .. })
    }
}

/// Result of `attempt` with the smallest table size (0: for the given load, each further one for twice the
/// load) that is large enough.
pub fn large_enough<T, E: Outgrown>(attempt: impl Fn(usize) -> Result<T, E>) -> Result<T, E> {
    let mut outgrown = None;
    for size in 0..SIZES {
        match attempt(size) {
            Err(error) if error.is_too_small() => outgrown = outgrown.or(Some(error)),
            // Larger tables may fail otherwise; the error that required them is reported.
            Err(error) => return Err(outgrown.unwrap_or(error)),
            Ok(found) => return Ok(found),
        }
    }
    match outgrown {
        Some(error) => Err(error),
        None => attempt(0),
    }
}
