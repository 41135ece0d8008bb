//! The command and the facade from outside, in one binary: linking it takes longer than most tests.
//!
//! `cargo test --release --test all snapshots` runs the tests of one module.

mod branch_input;
mod branches_command;
mod closed_forms;
mod command;
mod compare_command;
mod dataset_command;
mod field_sets;
mod figures;
mod harness;
mod help;
mod impulse_command;
mod machines;
mod mutated_results;
mod mutated_scenes;
mod progress;
mod random;
mod readings;
mod recorded_report;
mod refusals;
mod results_command;
mod scene_check;
mod scene_schema;
mod snapshots;
mod stability_command;
mod study_command;
mod sweep_command;
mod writing;
