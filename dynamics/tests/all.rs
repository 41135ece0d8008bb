//! Tests of the numerics on systems whose solutions are known. One program for all files, which is built faster:
//! `cargo test --release -p epicyclic-dynamics --test all continuation` runs those whose name has the word.

mod bouncing_bar;
mod continuation;
mod coupled;
mod explicit_limit;
mod identify;
mod integrators;
mod kept_steps;
mod mathieu;
mod oscillators;
mod periodic;
mod synthetic;
