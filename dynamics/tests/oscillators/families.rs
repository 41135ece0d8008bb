//! Balanced motions as families over frequency and load, and a family judged by somebody else.

use dynamics::CouplingForce;
use dynamics::continuation::{Evaluation, Family, Judgement};
use dynamics::harmonic_balance::{BalanceEquations, BalanceError, HarmonicBalance};
use nalgebra::DVector;

/// Periodic motions with a fixed number of harmonics as a family over the fundamental frequency (λ in rad/s), for
/// continuation. Unknowns are those of [`BalanceEquations`].
#[derive(Debug)]
pub(crate) struct FrequencyResponse<'a, L> {
    problem: &'a HarmonicBalance<L>,
    harmonics: usize,
}

impl<'a, L: CouplingForce> FrequencyResponse<'a, L> {
    /// With H harmonics.
    ///
    /// # Errors
    /// If the cycle has too few steps for them.
    pub(crate) fn new(
        problem: &'a HarmonicBalance<L>,
        harmonics: usize,
    ) -> Result<Self, BalanceError> {
        match harmonics <= problem.most_harmonics() {
            true => Ok(Self { problem, harmonics }),
            false => Err(BalanceError::Samples { harmonics, samples: problem.steps_per_cycle() }),
        }
    }

    /// The equations at a frequency, rad/s.
    ///
    /// # Errors
    /// As [`HarmonicBalance::equations`].
    pub(crate) fn equations(
        &self,
        frequency: f64,
    ) -> Result<BalanceEquations<'a, L>, BalanceError> {
        self.problem.equations(frequency, self.harmonics)
    }
}

impl<L: CouplingForce> Family for FrequencyResponse<'_, L> {
    type Error = BalanceError;

    fn dimension(&self) -> usize {
        self.problem.count() + 2 * self.harmonics * self.problem.couplings()
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, BalanceError> {
        let (residual, jacobian) = self.equations(lambda)?.evaluate(y)?;
        let step = 1e-6 * lambda;
        let beside = |sign: f64| self.equations(lambda + sign * step)?.evaluate(y);
        let derivative = (beside(1.0)?.0 - beside(-1.0)?.0) / (2.0 * step);
        Ok(Evaluation { residual, jacobian, derivative })
    }
}

/// Periodic motions at one frequency as a family over a steady load: λ times the forces given is added to those of the
/// problem.
#[derive(Debug)]
pub(crate) struct LoadResponse<'a, L> {
    equations: BalanceEquations<'a, L>,
    force: Vec<f64>,
}

impl<'a, L: CouplingForce> LoadResponse<'a, L> {
    /// With H harmonics at a fundamental frequency (rad/s), over a force on each coordinate (N for λ = 1).
    ///
    /// # Errors
    /// As [`HarmonicBalance::equations`], or if there is not one force for each coordinate.
    pub(crate) fn new(
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
}

impl<L: CouplingForce> Family for LoadResponse<'_, L> {
    type Error = BalanceError;

    fn dimension(&self) -> usize {
        self.equations.dimension()
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, BalanceError> {
        let (mut residual, jacobian) = self.equations.evaluate(y)?;
        // Only the balance of mean forces contains the load.
        let mut derivative = DVector::zeros(y.len());
        for (i, force) in self.force.iter().enumerate() {
            residual[i] -= lambda * force;
            derivative[i] = -force;
        }
        Ok(Evaluation { residual, jacobian, derivative })
    }
}

/// A family whose solutions are judged by a function: multipliers of a motion, say, that harmonic balance found.
#[derive(Debug, Clone)]
pub(crate) struct JudgedBy<F, J> {
    /// The family.
    pub(crate) family: F,
    /// Stability and test functions at (y, λ).
    pub(crate) judge: J,
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
