//! The rung on which mesh forces are looked up: tables made from the cells, and the set that follows
//! them.
//!
//! A mesh's deflection is its approach on the path of contact. A pair that touches with a corner presses
//! along another normal and approaches otherwise; the tables hold that for the displacements at rest, and
//! the load it makes beside the line of action is a function of phase. What is left out beside the
//! quasi-static rung: how vibration changes the approach of corners and their side loads, and the lag of
//! stiffness-proportional damping pair by pair (it acts on the mesh as a whole, with the elastic bodies'
//! share of its flexibility). For OH-58 at 1413 N·m and 1600 rpm, where the second harmonic meets a
//! resonance, that is 0.2 % of the sun's rotation in size and 0.08 rad in phase, and up to a tenth of the
//! largest harmonic in mesh forces; in the static transmission error, 0.7 % of its range.

mod build;
mod law;
mod set;
mod share;

pub use build::{LawSettings, mesh_law};
pub use set::MeshLawSet;
