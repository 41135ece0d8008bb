//! The rung on which mesh forces are looked up: tables made from the cells, and the set that follows
//! them.
//!
//! What it leaves out beside the quasi-static rung: pairs of one mesh approach alike, up to the arms of
//! corners (planets and races that tilt against each other are seen at the operating pressure angle
//! only), and the lag of stiffness-proportional damping acts on the mesh as a whole, with the elastic
//! bodies' share of its flexibility.

mod build;
mod law;
mod set;
mod share;

pub use build::{LawSettings, mesh_law};
pub use set::MeshLawSet;
