//! What a study gives. Everything that depends on a clock is in fields called `time`; the rest is the same in every
//! run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cost::Quartiles;
use super::efficiency::Doubt;
use super::experiment::Work;
use super::quantity::{QuantityKind, WorkKind};
use super::study_file::CostKind;

/// A study that has been run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StudyResult {
    /// Title of the study.
    pub title: String,
    /// Title of its scene.
    pub scene: String,
    /// Torque on the sun, N m.
    pub sun_torque_nm: f64,
    /// Scene keys common to all settings and routes, as `key = value`.
    pub keys: Vec<String>,
    /// Wanted accuracy, percent.
    pub tolerance_percent: f64,
    /// Which part of the time is the cost.
    pub cost: CostKind,
    /// Rounds in which every setting was run.
    pub rounds: usize,
    /// Settings.
    pub settings: Vec<SettingResult>,
    /// Quantities with their truth and their rows, one row for each setting in the same order.
    pub quantities: Vec<QuantityResult>,
    /// The yardstick.
    pub time: StudyTime,
}

/// A setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SettingResult {
    /// Name.
    pub name: String,
    /// Group or series, one colour in the figure.
    pub group: String,
    /// What it chooses, as `key = value`.
    pub choices: Vec<String>,
}

/// The yardstick: one mesh cycle of the lumped model of the scene, 140 steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StudyTime {
    /// Time of one mesh cycle of the lumped model, s.
    pub yardstick_s: Quartiles,
    /// Median of the last third of the run over that of the first third.
    pub yardstick_drift: f64,
}

/// A route to the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RouteResult {
    /// Name.
    pub name: String,
    /// What it says, in the unit of the quantity.
    pub value: f64,
    /// Its own uncertainty, in the unit of the quantity; 0 of a setting alone.
    pub uncertainty: f64,
    /// Observed order of convergence; absent where none was observed.
    pub order: Option<f64>,
    /// Values of its sequence, coarse to fine.
    pub values: Vec<f64>,
}

/// The truth of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TruthResult {
    /// Value by the first route, in the unit of the quantity.
    pub value: f64,
    /// U: the larger of the first route's own uncertainty and its distance to any other.
    pub uncertainty: f64,
    /// The same in percent of the value.
    pub uncertainty_percent: f64,
    /// All routes.
    pub routes: Vec<RouteResult>,
}

/// A quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuantityResult {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: QuantityKind,
    /// Unit of values.
    pub unit: String,
    /// Counted work that stands beside time.
    pub work: WorkKind,
    /// Truth.
    pub truth: TruthResult,
    /// One row for each setting.
    pub rows: Vec<Row>,
    /// What the numbers do not say by themselves: errors that cross zero, ranks that U leaves open, settings without
    /// answer.
    pub notes: Vec<String>,
    /// The setting of least counted work whose guarded error and U together are within the tolerance; absent if none
    /// is.
    pub answer_by_work: Option<String>,
    /// Costs.
    pub time: QuantityTime,
}

/// A setting and a quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Row {
    /// Name of the setting.
    pub setting: String,
    /// Why there is no value; absent if there is one.
    pub refusal: Option<String>,
    /// Value in the unit of the quantity.
    pub value: Option<f64>,
    /// 100 (value − truth)/|truth|.
    pub error_percent: Option<f64>,
    /// Largest |error| of this setting and the finer ones of its series, percent: what it is ranked by.
    pub guarded_percent: Option<f64>,
    /// Why a small error may be luck.
    pub doubt: Option<Doubt>,
    /// Whether |error| is below U.
    pub is_within_uncertainty: bool,
    /// Rank by guarded error, 1 the most accurate.
    pub rank: Option<usize>,
    /// Least and greatest rank as the truth moves from −U to +U.
    pub ranks: Option<[usize; 2]>,
    /// Whether no setting takes both less counted work and is more accurate.
    pub is_efficient_by_work: bool,
    /// Counted work of the experiment.
    pub work: Work,
    /// Cost.
    pub time: RowTime,
}

/// Costs of a setting, in mesh cycles of the lumped model; absent without value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RowTime {
    /// Gears and contact tables.
    pub set_up_cycles: Option<Quartiles>,
    /// The experiment.
    pub solution_cycles: Option<Quartiles>,
    /// Cost as the study defines it.
    pub cost_cycles: Option<Quartiles>,
    /// Whether no setting is both cheaper and more accurate.
    pub is_efficient: bool,
    /// Whether that changes as the truth moves from −U to +U, or as costs move within their quartiles.
    pub is_efficiency_uncertain: bool,
}

/// What times say of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuantityTime {
    /// The cheapest setting whose guarded error and U together are within the tolerance.
    pub answer: Option<String>,
    /// Its cost, mesh cycles of the lumped model.
    pub answer_cycles: Option<Quartiles>,
    /// Settings that are as accurate and whose costs cannot be told from its own.
    pub equally_cheap: Vec<String>,
}
