//! Steps of a branch that are kept while it is followed, so that an interrupted one is gone on with.

use serde::{Deserialize, Serialize};

use super::branch::BranchPoint;
use super::family::Family;
use super::trace::Direction;

/// One step of a branch: what it found, and all that the next one depends on. Continuation that goes on from it takes
/// the same steps, to the last bit, as one that was not interrupted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptStep {
    /// Points in order: those located within the step, then the one that it ends at. Step 0 has the first point alone.
    pub points: Vec<BranchPoint>,
    /// Scaled unknowns and, last, the scaled parameter at its end: rounding makes them others than the plain ones
    /// divided by their scales.
    pub scaled: Vec<f64>,
    /// Sign of det [∂F/∂u; tᵀ] at its end; 0 if it is not known.
    pub orientation: f64,
    /// Length of the step that is tried next, along the scaled arc.
    pub next_step: f64,
    /// Whether the branch was far from its first point before.
    pub was_away: bool,
    /// Why the branch ends with it, if it does.
    pub end: Option<StepEnd>,
}

/// Why a branch ends with a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepEnd {
    /// At a bound of the parameter.
    Bound,
    /// At its first point.
    Closed,
}

/// Where the steps of one branch are kept, by direction and number.
pub trait StepStore<F: Family> {
    /// A step that an earlier run took.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    fn load(&mut self, towards: Direction, number: usize) -> Result<Option<KeptStep>, F::Error>;

    /// Keeps a step just taken; `family` knows what it judged on the way.
    ///
    /// # Errors
    /// If it cannot be written.
    fn save(
        &mut self,
        family: &mut F,
        towards: Direction,
        number: usize,
        step: &KeptStep,
    ) -> Result<(), F::Error>;
}

/// Keeps nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unkept;

impl<F: Family> StepStore<F> for Unkept {
    fn load(&mut self, _: Direction, _: usize) -> Result<Option<KeptStep>, F::Error> {
        Ok(None)
    }

    fn save(&mut self, _: &mut F, _: Direction, _: usize, _: &KeptStep) -> Result<(), F::Error> {
        Ok(())
    }
}
