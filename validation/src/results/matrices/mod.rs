//! Matrices of mass and stiffness: `matrices/M.mtx`, `K.mtx` or `SCENE.M.mtx`, `SCENE.K.mtx`, as Matrix Market or, with
//! the end `.csv`, as a square table of numbers without titles.

mod error;
mod folder;
mod given;
mod market;
mod square;
#[cfg(test)]
mod tests;

pub use error::MatrixError;
pub(super) use folder::matrices;
pub use given::{GivenMatrix, MatrixKind, SceneMatrices};

/// Most rows of a matrix: three for carrier, ring, sun and each of 64 planets, the most that a scene has.
const MOST_ROWS: usize = 3 * (3 + 64);

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 10_000_000;
