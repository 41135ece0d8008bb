//! Tests of the scene file. One program for all files, which is built faster:
//! `cargo test --release -p epicyclic-scene --test all needs` runs those whose name has the word.

mod built_scenes;
mod field_sets;
mod gear_pair;
mod needs;
mod published_sets;
mod scene_faults;
mod six_numbers;
