//! Balanced motions as a family over frequency.

use super::equations::BalanceEquations;
use super::error::BalanceError;
use super::problem::HarmonicBalance;
use crate::continuation::{Evaluation, Family};
use crate::coupled::CouplingForce;

/// Periodic motions with a fixed number of harmonics as a family over the fundamental frequency (λ in rad/s), for
/// continuation. Unknowns are those of [`BalanceEquations`].
#[derive(Debug)]
pub struct FrequencyResponse<'a, L> {
    problem: &'a HarmonicBalance<L>,
    harmonics: usize,
}

impl<'a, L: CouplingForce> FrequencyResponse<'a, L> {
    /// With H harmonics.
    ///
    /// # Errors
    /// If the cycle has too few steps for them.
    pub fn new(problem: &'a HarmonicBalance<L>, harmonics: usize) -> Result<Self, BalanceError> {
        match harmonics <= problem.most_harmonics() {
            true => Ok(Self { problem, harmonics }),
            false => Err(BalanceError::Samples { harmonics, samples: problem.steps_per_cycle() }),
        }
    }

    /// The equations at a frequency, rad/s.
    ///
    /// # Errors
    /// As [`HarmonicBalance::equations`].
    pub fn equations(&self, frequency: f64) -> Result<BalanceEquations<'a, L>, BalanceError> {
        self.problem.equations(frequency, self.harmonics)
    }
}

impl<L: CouplingForce> Family for FrequencyResponse<'_, L> {
    type Error = BalanceError;

    fn dimension(&self) -> usize {
        self.problem.count() + 2 * self.harmonics * self.problem.couplings()
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, BalanceError> {
        self.equations(lambda)?.evaluate(y)
    }
}

impl<L: CouplingForce> BalanceEquations<'_, L> {
    /// Residual, and its derivatives by the unknowns and by the frequency.
    ///
    /// # Errors
    /// If the number of unknowns is not [`BalanceEquations::dimension`].
    pub fn evaluate(&self, y: &[f64]) -> Result<Evaluation, BalanceError> {
        self.fits(y)?;
        let answers = self.answers(y);
        Ok(Evaluation {
            residual: self.residual(y, &answers),
            jacobian: self.jacobian(&answers),
            derivative: self.by_frequency(y, &answers),
        })
    }
}
