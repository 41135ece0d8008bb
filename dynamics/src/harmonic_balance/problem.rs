//! What is balanced: linear part, couplings, force law and forces.

use faer::c64;

use super::equations::BalanceEquations;
use super::error::BalanceError;
use super::fourier::Transform;
use crate::coupled::{Coupled, CoupledError, Coupling, CouplingForce, LinearPart};
use crate::newmark::AverageAcceleration;

/// A linear system with couplings, whose periodic motions are found by harmonic balance.
///
/// Its inputs are those of [`Coupled`]: the law numbers the couplings in the order given, and step s of the
/// cycle's S is the phase θ = 2π s/S.
#[derive(Debug, Clone)]
pub struct HarmonicBalance<L> {
    pub(super) linear: LinearPart,
    pub(super) couplings: Vec<Coupling>,
    pub(super) law: L,
    /// Steady forces on the coordinates, N.
    pub(super) steady: Vec<f64>,
    /// Forces on the coordinates by step of the cycle, without the steady ones, N.
    cycle: Vec<Vec<f64>>,
    pub(super) transform: Transform,
}

/// The mean of a law over the cycle.
struct Averaged<'a, L> {
    law: &'a L,
    steps: usize,
}

impl<L: CouplingForce> CouplingForce for Averaged<'_, L> {
    fn answer(&self, coupling: usize, _: usize, deflection: f64) -> (f64, f64) {
        let one = |step| self.law.answer(coupling, step, deflection);
        let (p, d) = (0..self.steps).map(one).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        (p / self.steps as f64, d / self.steps as f64)
    }
}

impl<L: CouplingForce> HarmonicBalance<L> {
    /// A system without external forces, with a law tabulated at `steps_per_cycle` steps.
    ///
    /// # Errors
    /// As [`Coupled::new`].
    pub fn new(
        linear: &LinearPart,
        couplings: &[Coupling],
        law: L,
        steps_per_cycle: usize,
    ) -> Result<Self, BalanceError> {
        let n = linear.mass.len();
        if steps_per_cycle == 0 {
            return Err(CoupledError::NoSteps.into());
        }
        let averaged = Averaged { law: &law, steps: steps_per_cycle };
        // Finds every fault of the input that marching would.
        at_rest(linear, couplings, averaged)?;
        Ok(Self {
            linear: linear.clone(),
            couplings: couplings.to_vec(),
            law,
            steady: vec![0.0; n],
            cycle: vec![vec![0.0; n]; steps_per_cycle],
            transform: Transform::new(steps_per_cycle),
        })
    }

    /// Sets the steady external forces on the coordinates, N.
    ///
    /// # Errors
    /// If there is not one for each coordinate.
    pub fn set_external(&mut self, force: &[f64]) -> Result<(), BalanceError> {
        self.fits("the external force", force)?;
        self.steady.copy_from_slice(force);
        Ok(())
    }

    /// Adds forces on the coordinates (N) that act at one step of every cycle.
    ///
    /// # Errors
    /// If there is not one for each coordinate.
    pub fn add_in_cycle(
        &mut self,
        step_in_cycle: usize,
        force: &[f64],
    ) -> Result<(), BalanceError> {
        self.fits("the external force", force)?;
        let steps = self.cycle.len();
        for (own, new) in self.cycle[step_in_cycle % steps].iter_mut().zip(force) {
            *own += new;
        }
        Ok(())
    }

    /// Number of coordinates.
    pub fn count(&self) -> usize {
        self.steady.len()
    }

    /// Number of couplings.
    pub fn couplings(&self) -> usize {
        self.couplings.len()
    }

    /// Steps of the cycle: the samples of a period.
    pub fn steps_per_cycle(&self) -> usize {
        self.cycle.len()
    }

    /// Most harmonics that the samples of the cycle allow: S ≥ 4H + 1.
    pub fn most_harmonics(&self) -> usize {
        (self.cycle.len() - 1) / 4
    }

    /// The equations at a fundamental frequency (rad/s) with a number of harmonics.
    ///
    /// # Errors
    /// If the frequency is not positive and finite, there are too few samples for the harmonics, or the dynamic
    /// stiffness of the linear part is singular at one of them.
    pub fn equations(
        &self,
        frequency: f64,
        harmonics: usize,
    ) -> Result<BalanceEquations<'_, L>, BalanceError> {
        BalanceEquations::new(self, frequency, harmonics, 0.0)
    }

    /// Coordinates at rest under the mean load, with the law averaged over the cycle, m.
    ///
    /// # Errors
    /// If there is no equilibrium, or there are more couplings than [`Coupled`] is compiled for.
    pub fn mean_equilibrium(&self) -> Result<Vec<f64>, BalanceError> {
        let averaged = Averaged { law: &self.law, steps: self.cycle.len() };
        let mut rest = at_rest(&self.linear, &self.couplings, averaged)?;
        let mean: Vec<f64> = (0..self.count()).map(|i| self.force_lines(i, 0)[0].re).collect();
        rest.set_external(&mean)?;
        rest.rest()?;
        Ok(rest.displacements())
    }

    /// Coefficients f_0 … f_H of the force on a coordinate, one-sided as in
    /// [`FourierSeries`](super::FourierSeries), N.
    pub(super) fn force_lines(&self, coordinate: usize, harmonics: usize) -> Vec<c64> {
        let samples: Vec<f64> = self.cycle.iter().map(|f| f[coordinate]).collect();
        let mut lines = self.transform.lines(&samples);
        lines.truncate(harmonics + 1);
        lines.iter_mut().skip(1).for_each(|f| *f *= 2.0);
        lines[0] += self.steady[coordinate];
        lines
    }

    fn fits(&self, what: &'static str, list: &[f64]) -> Result<(), BalanceError> {
        let (got, wanted) = (list.len(), self.count());
        if got == wanted { Ok(()) } else { Err(BalanceError::Size { what, got, wanted }) }
    }
}

/// The system with an averaged law, at the origin. Its step is never used: only its equilibrium is.
fn at_rest<'a, L: CouplingForce>(
    linear: &LinearPart,
    couplings: &[Coupling],
    law: Averaged<'a, L>,
) -> Result<Coupled<Averaged<'a, L>>, BalanceError> {
    let largest =
        linear.stiffness.amax() / linear.mass.iter().copied().fold(f64::INFINITY, f64::min);
    let step = if largest > 0.0 && largest.is_finite() { largest.sqrt().recip() } else { 1.0 };
    let rule = AverageAcceleration::new(step)
        .map_err(|e| BalanceError::Value { what: "the time scale", value: e.0 })?;
    Ok(Coupled::new(linear, couplings, &[], law, rule, 1)?)
}
