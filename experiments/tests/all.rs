//! Tests of the experiments on both models. One program for all files, which is built faster:
//! `cargo test --release -p epicyclic-experiments --test all shooting` runs those whose name has the word.

mod amplitudes;
mod attraction;
mod auto;
mod balanced_law;
mod branches;
mod branches_over_keys;
mod branches_over_load;
mod contact_cells;
mod crossings;
mod direction;
mod elastic_inertia;
mod gear_pair;
mod gear_pair_modes;
mod inertia_guard;
mod numbering;
mod outgrown_tables;
mod pair_fidelities;
mod phasor_strengths;
mod prescribed_stiffness;
mod shipped;
mod shooting;
mod subharmonic;
mod tongue;
