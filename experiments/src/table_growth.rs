//! Tables of contact laid out anew where a load outgrows them.

use fe_contact::FeError;

use crate::error::ExperimentError;

/// How often tables may be laid out for twice the load.
pub const SIZES: usize = 5;

/// Whether a fault is that the tables are too small for the load.
pub trait Outgrown {
    /// Whether it is.
    fn is_too_small(&self) -> bool;
}

impl Outgrown for FeError {
    /// Whether it is.
    fn is_too_small(&self) -> bool {
        matches!(self, Self::GridOverflow { .. })
    }
}

impl Outgrown for ExperimentError {
    /// Whether it is.
    fn is_too_small(&self) -> bool {
        matches!(self, Self::Fe(e) if e.is_too_small())
    }
}

/// The first of growing sizes (0: as the load is, each further one for twice the load) that will do.
pub fn large_enough<T, E: Outgrown>(attempt: impl Fn(usize) -> Result<T, E>) -> Result<T, E> {
    let mut outgrown = None;
    for size in 0..SIZES {
        match attempt(size) {
            Err(error) if error.is_too_small() => outgrown = outgrown.or(Some(error)),
            // Larger tables may be impossible; what asked for them is the reason.
            Err(error) => return Err(outgrown.unwrap_or(error)),
            Ok(found) => return Ok(found),
        }
    }
    match outgrown {
        Some(error) => Err(error),
        None => attempt(0),
    }
}
