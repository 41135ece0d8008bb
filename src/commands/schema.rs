//! JSON schemas of every `--format json`.

use schemars::{JsonSchema, Schema, schema_for};
use validation::{Comparison, Verdict};

use super::modes::ModesOutput;
use super::rules::RulesOutput;
use super::scene::SceneSummary;

/// `(file name, schema)` of each verb; the files in `schemas/` are regenerated with the snapshots.
pub fn schemas() -> Vec<(&'static str, Schema)> {
    fn of<T: JsonSchema>() -> Schema {
        schema_for!(T)
    }
    vec![
        ("validate", of::<Verdict>()),
        ("modes", of::<ModesOutput>()),
        ("rules", of::<RulesOutput>()),
        ("scene_check", of::<SceneSummary>()),
        ("compare", of::<Comparison>()),
    ]
}
