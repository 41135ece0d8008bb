//! JSON schemas of every `--format json` and of scene files.

use schemars::{JsonSchema, Schema, schema_for};
use validation::{Comparison, Verdict};

use super::branches::BranchesOutput;
use super::impulse::ImpulseOutput;
use super::mesh::MeshOutput;
use super::modes::ModesOutput;
use super::results::ResultsSummary;
use super::rules::RulesOutput;
use super::scene::SceneSummary;
use super::snapshot::DriftOutput;
use super::stability::{GuardList, StabilityList, StabilityOutput};
use super::statics::{ApproachOutput, PairOutput, SetOutput};
use super::study::StudyOutput;
use super::sweep::SweepOutput;
use super::validate::{ControlsOutput, RecordedOutput};

/// `(file name, schema)` of each verb's output, and of a scene file; the files in `schemas/` are regenerated with the
/// snapshots.
pub fn schemas() -> Vec<(&'static str, Schema)> {
    fn of<T: JsonSchema>() -> Schema {
        schema_for!(T)
    }
    // The schema of a scene is always an object.
    let scene = Schema::try_from(scene::scene_schema()).unwrap_or_default();
    vec![
        ("scene", scene),
        ("validate", of::<Verdict>()),
        ("validate_recorded", of::<RecordedOutput>()),
        ("validate_controls", of::<ControlsOutput>()),
        ("modes", of::<ModesOutput>()),
        ("rules", of::<RulesOutput>()),
        ("scene_check", of::<SceneSummary>()),
        ("static_approach", of::<ApproachOutput>()),
        ("static_pair", of::<PairOutput>()),
        ("static_set", of::<SetOutput>()),
        ("impulse", of::<ImpulseOutput>()),
        ("sweep", of::<SweepOutput>()),
        ("branches", of::<BranchesOutput>()),
        ("stability", of::<StabilityOutput>()),
        ("stability_list", of::<StabilityList>()),
        ("stability_guards", of::<GuardList>()),
        ("study", of::<StudyOutput>()),
        ("mesh", of::<MeshOutput>()),
        ("results_check", of::<ResultsSummary>()),
        ("snapshot_check", of::<DriftOutput>()),
        ("compare", of::<Comparison>()),
    ]
}
