//! What in tables cannot be true, whatever model they come from. Nothing here judges how good a model is.
//!
//! ```text
//! modes          a rotational mode is single, translational modes are pairs, planet modes of a frequency are N − 3
//!                at most; frequencies f_k and those of the lumped model F_k with f_k c = F_k of all k and one
//!                c of 10³, 10⁻³, 2π, 1/2π, 60, 1/60
//! matrices       M and K symmetric, M positive definite, no ω² of K v = ω² M v below 0, all f_k among the ω/2π
//! vectors        one of each mode, no two alike; half of ½ q̇ᵀMq̇ at least in the subspace of the type that is given
//! at rest        Σ_n F_sn r_bs = |T_s| of the sun meshes and Σ_n F_rn r_bs = |T_s| of the ring meshes, as
//!                r_br/r_bs = Z_r/Z_s = T_r/T_s; F is positive where the flanks press that the torque
//!                loads, so that both senses of T_s have one sign
//! turning        the same of the means, Σ_n A_0n cos φ_0n r_bs = |T_s|; f_m = Z_s |n_s − n_c|/60, by the scene's
//!                driven and held member of one speed n_in; |φ| ≤ 2π
//! stiffness      0 < k ≤ 10¹² N/m, and F/k ≤ r_bs with the load F = |T_s|/(N r_bs) of one planet; positions are even
//! anywhere       |x| ≤ r_bs of a displacement, |θ| ≤ 1 rad of a rotation, |F| r_bs ≤ 1000 |T_s| of a force
//! ```
//!
//! A torsional support at the sun or the ring takes a part of the torque, and F is the force of the driving flanks
//! alone: balances are not asked there, nor of states in which backside flanks press. Two planets
//! with the same numbers in every row are one planet written twice, unless their meshes have one phase.

mod absurd;
mod balance;
mod contradiction;
mod even;
mod facts;
mod frequency_factor;
mod matrices;
mod merged;
mod repeated;
mod tables;
#[cfg(test)]
mod tests;
mod vectors;

pub use contradiction::Contradiction;
pub(super) use facts::Facts;
pub(super) use matrices::matrices;
pub(super) use tables::{mesh_cycle, mesh_stiffness, modes, rules, steady_states, torque_peaks};
pub(super) use vectors::vectors;
