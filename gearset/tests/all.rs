//! Tests of geometry, phases, kinematics and rules. One program for all files, which is built faster:
//! `cargo test --release -p gearset --test all geometry` runs those whose name has the word.

mod displaced;
mod geometry;
mod kinematics;
mod rack_circles;
mod rigid_polygons;
mod rules;
mod shifted_mesh;
mod tooth_section;
