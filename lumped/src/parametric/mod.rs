//! Parametric instability: mesh stiffnesses that change with the mesh cycle as prescribed, without damping.
//!
//! ```text
//! M q̈ + K(t) q = 0,   K(t) = K₀ + ε Σ_i k_i w_i(f_m t) b_i b_iᵀ
//! ```
//!
//! with rectangular waves w_i of mean 0 and peak-to-peak 2, high while one more pair of teeth carries. After Lin &
//! Parker, J. Sound Vib. 249 (2002) 129–145. Two routes to the borders of stability: [`tongues`] to first order in ε,
//! and [`ParametricSet::multipliers`], exact because the stiffness is constant between switches.

mod floquet;
mod mesh_wave;
mod tongues;

pub use floquet::{ParametricSet, TongueEdges};
pub use mesh_wave::MeshWave;
pub use tongues::{Tongue, tongues};
