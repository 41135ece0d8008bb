//! JSON schemas of every `--format json`.

use schemars::{JsonSchema, Schema, schema_for};
use validation::{Comparison, Verdict};

use super::impulse_output::ImpulseOutput;
use super::mesh::MeshOutput;
use super::modes::ModesOutput;
use super::rules::RulesOutput;
use super::scene::SceneSummary;
use super::static_approach::ApproachOutput;
use super::static_pair::PairOutput;
use super::static_set::SetOutput;
use super::sweep_output::SweepOutput;
use super::validate::ControlsOutput;

/// `(file name, schema)` of each verb; the files in `schemas/` are regenerated with the snapshots.
pub fn schemas() -> Vec<(&'static str, Schema)> {
    fn of<T: JsonSchema>() -> Schema {
        schema_for!(T)
    }
    vec![
        ("validate", of::<Verdict>()),
        ("validate_controls", of::<ControlsOutput>()),
        ("modes", of::<ModesOutput>()),
        ("rules", of::<RulesOutput>()),
        ("scene_check", of::<SceneSummary>()),
        ("static_approach", of::<ApproachOutput>()),
        ("static_pair", of::<PairOutput>()),
        ("static_set", of::<SetOutput>()),
        ("impulse", of::<ImpulseOutput>()),
        ("sweep", of::<SweepOutput>()),
        ("mesh", of::<MeshOutput>()),
        ("compare", of::<Comparison>()),
    ]
}
