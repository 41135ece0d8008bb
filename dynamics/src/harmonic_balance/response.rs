//! Balanced motions as a family over frequency.

use nalgebra::DVector;

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

/// Periodic motions at one frequency as a family over a steady load: λ times the forces given is added to those of the
/// problem.
#[derive(Debug)]
pub struct LoadResponse<'a, L> {
    equations: BalanceEquations<'a, L>,
    force: Vec<f64>,
}

impl<'a, L: CouplingForce> LoadResponse<'a, L> {
    /// With H harmonics at a fundamental frequency (rad/s), over a force on each coordinate (N for λ = 1).
    ///
    /// # Errors
    /// As [`HarmonicBalance::equations`], or if there is not one force for each coordinate.
    pub fn new(
        problem: &'a HarmonicBalance<L>,
        frequency: f64,
        harmonics: usize,
        force: &[f64],
    ) -> Result<Self, BalanceError> {
        let (what, got, wanted) = ("the steady force", force.len(), problem.count());
        if got != wanted {
            return Err(BalanceError::Size { what, got, wanted });
        }
        Ok(Self { equations: problem.equations(frequency, harmonics)?, force: force.to_vec() })
    }

    /// The equations without the load; the motion they give for unknowns y is that of any load.
    pub fn equations(&self) -> &BalanceEquations<'a, L> {
        &self.equations
    }
}

impl<L: CouplingForce> Family for LoadResponse<'_, L> {
    type Error = BalanceError;

    fn dimension(&self) -> usize {
        self.equations.dimension()
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, BalanceError> {
        let mut found = self.equations.evaluate(y)?;
        // Only the balance of mean forces contains the load.
        found.derivative = DVector::zeros(y.len());
        for (i, force) in self.force.iter().enumerate() {
            found.residual[i] -= lambda * force;
            found.derivative[i] = -force;
        }
        Ok(found)
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
