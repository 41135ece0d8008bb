//! Tests of the checks, and long comparisons on drawn and shipped sets. One program for all files, which is built
//! faster:
//! `cargo test --release -p epicyclic-validation --test all sweep` runs those whose name has the word.

mod certified;
mod closed_forms;
mod good_results;
mod judged_matrices;
mod judged_results;
mod judged_vectors;
mod lumped_from_fe;
mod made_scenes;
mod sweep;
mod verdict;
