//! Tests of geometry, phases, kinematics, rules and the scene file. One program for all files, which is built faster:
//! `cargo test --release -p gearset --test all geometry` runs those whose name has the word.

mod displaced;
mod gear_pair;
mod geometry;
mod kinematics;
mod needs;
mod rigid_polygons;
mod rules;
mod scene_faults;
