//! Plane quadrilaterals: shape functions, stiffness, mass.

mod matrices;
mod shape;

pub use matrices::{DistortedElement, ElementMatrices, matrices};
pub use shape::{Edge, MOST, Shape, Values};
