//! Tests of bodies, contact, statics and vibration. One program for all files, which is built faster:
//! `cargo test --release -p fe_contact --test all hertz` runs those whose name has the word.

mod built_scenes;
#[cfg(feature = "interior_point")]
mod complementarity;
mod elements;
mod estimate;
mod fidelity;
mod gyroscopic;
mod hertz;
mod mesh_law;
mod relief;
mod sector_ring;
#[cfg(feature = "interior_point")]
mod statics;
mod vibration;
