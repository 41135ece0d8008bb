//! The fidelity on which mesh forces are looked up: tables made from the cells, and the set that follows
//! them.
//!
//! A mesh's deflection is its approach on the path of contact, about the mean configuration under the torque
//! the law is made for. A pair that touches with a corner presses along another normal and approaches
//! otherwise, and flanks deformed by the load have slopes; the load that makes beside the line of action is a
//! function of phase, with the forces of the equilibrium there. What is left out beside the quasi-static fidelity:
//! how vibration changes these side loads, and the lag of stiffness-proportional damping pair by pair (it acts
//! on the mesh as a whole, with the elastic bodies' share of its flexibility). For OH-58 at 1413 N·m and
//! 1600 rpm, where the second harmonic meets a resonance, that is 5 to 7 % of the sun's rotation, about half
//! from each; at rest, 0.7 % of the range of the transmission error.

mod build;
mod deflected_mesh;
mod law;
mod set;
mod share;

pub use build::{MeshLawSettings, mesh_law};
pub use set::MeshLawSet;
