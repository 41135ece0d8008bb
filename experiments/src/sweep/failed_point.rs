//! A speed of a sweep at which no steady state could be computed.

use std::sync::Arc;

use scene::LoadCase;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::SweepError;
use crate::table_growth::{Outgrown, SIZES};

/// A speed at which the march to the steady state failed, with the reason.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema, thiserror::Error)]
#[error("at {} rpm: {reason}", case.speed_rpm)]
pub struct FailedPoint {
    /// Chain of the plan that the speed belongs to.
    pub chain: String,
    /// Speed and load.
    #[serde(flatten)]
    pub case: LoadCase,
    /// Why there is no result, and what may help.
    pub reason: String,
    /// The error itself; `None` for a point read from a store, which keeps its text alone.
    #[serde(skip)]
    #[source]
    pub error: Option<Arc<SweepError>>,
}

/// Points are the same if they fail for the same reason, whether computed now or read from a store.
impl PartialEq for FailedPoint {
    fn eq(&self, other: &Self) -> bool {
        (&self.chain, &self.case, &self.reason) == (&other.chain, &other.case, &other.reason)
    }
}

impl FailedPoint {
    /// The point of a chain that an error left without result. `last`: table size of the last attempt, and why
    /// that one failed.
    pub(super) fn new(
        chain: &str,
        case: LoadCase,
        error: SweepError,
        last: (usize, String),
    ) -> Self {
        let mut reason = error.to_string();
        if error.is_too_small() {
            let (size, why) = last;
            let times = 1 << size;
            reason.push_str(&match size + 1 == SIZES {
                true => format!(
                    "; it does so on contact tables made for up to {times} times the load, too"
                ),
                false => {
                    format!("; contact tables made for {times} times the load fail too: {why}")
                }
            });
            reason.push_str(
                "; a smaller torque, more damping or a speed farther from the resonance may keep the load within \
                 the tables, and more `dynamics.steps_per_cycle` at a speed so low that a time step is longer than \
                 the natural periods",
            );
        }
        Self { chain: chain.into(), case, reason, error: Some(Arc::new(error)) }
    }
}
