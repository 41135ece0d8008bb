//! Tests of the lumped model against hand matrices, closed forms and independent solutions. One program for all files,
//! which is built faster:
//! `cargo test --release -p lumped --test all analytic` runs those whose name has the word.

mod analytic;
mod balanced;
mod bearing_bounds;
mod built_scenes;
mod common;
mod derivatives;
mod gear_pair;
mod hand_matrices;
mod natural_modes;
mod parametric;
mod scheme_set;
mod spacing;
mod spread;
mod time_varying;
mod torsional;
mod type_names;
mod type_tolerance;
