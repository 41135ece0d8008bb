//! A family judged by somebody else.

use super::family::{Evaluation, Family, Judgement};

/// A family whose solutions are judged by a function: multipliers of a motion, say, that harmonic balance found.
#[derive(Debug, Clone)]
pub struct JudgedBy<F, J> {
    /// The family.
    pub family: F,
    /// Stability and test functions at (y, λ).
    pub judge: J,
}

impl<F, J> Family for JudgedBy<F, J>
where
    F: Family,
    J: FnMut(&mut F, &[f64], f64) -> Result<Judgement, F::Error>,
{
    type Error = F::Error;

    fn dimension(&self) -> usize {
        self.family.dimension()
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, F::Error> {
        self.family.evaluate(y, lambda)
    }

    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, F::Error> {
        (self.judge)(&mut self.family, y, lambda)
    }
}
