//! A loaded tooth pair in results.

use fe_contact::statics::ToothPairLoad;
use schemars::JsonSchema;
use serde::Serialize;

/// One loaded tooth pair.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct PairLoad {
    pub(super) index: i64,
    pub(super) force_n: f64,
    /// Largest cell pressure; singular at a tip corner.
    pub(super) peak_pressure_pa: f64,
}

impl PairLoad {
    pub(super) fn of(load: &ToothPairLoad) -> Self {
        let ToothPairLoad { index, force, peak_pressure } = *load;
        Self { index, force_n: force, peak_pressure_pa: peak_pressure }
    }
}
