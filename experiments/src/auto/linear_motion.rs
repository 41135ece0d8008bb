//! A steady motion of a quasi-static set, linearised at every step of its mesh cycle.

use std::f64::consts::TAU;

use dynamics::{HillEquations, HillError, PeriodicSystem, PeriodicTerm};
use fe_contact::vibration::{LinearSet, VibratingSet};
use nalgebra::{Complex, DMatrix, DVector};

use super::step_frequency::force;
use crate::error::ExperimentError;

/// Harmonics by which changes of a motion are computed, at most: those that are asked for are coupled to higher ones, and twice as many
/// bring some development sets nearer and others not (`docs/auto.md`).
pub(super) const HARMONICS: usize = 12;

/// One step of a cycle.
#[derive(Debug)]
pub(super) struct StepOfCycle {
    displacements: DVector<f64>,
    pub(super) tangent: LinearSet,
}

impl StepOfCycle {
    /// The present step of a turning set.
    ///
    /// # Errors
    /// If the set cannot be linearised.
    pub(super) fn of(set: &VibratingSet<'_>) -> Result<Self, ExperimentError> {
        let displacements = DVector::from_column_slice(&set.motion().x);
        Ok(Self { displacements, tangent: set.tangent()? })
    }
}

/// What the change of the races' coordinates by small forces is in a steady motion,
///
/// ```text
/// M δẍ + C δẋ + K(t) δx = f(t)
/// ```
///
/// with the stiffness of the pairs that touch at each step ([`HillEquations`]) and the mean damping of the cycle.
#[derive(Debug)]
pub(super) struct LinearMotion {
    /// X_0 … X_H of the motion, m.
    lines: Vec<DVector<Complex<f64>>>,
    mass: DMatrix<f64>,
    /// Mean of C over the cycle, the lag of the contacts included.
    damping: DMatrix<f64>,
    equations: HillEquations,
    /// Mesh frequency, rad/s.
    omega: f64,
    steps: usize,
}

/// What acts in a linearised motion besides inertia, damping and stiffness of its steps.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Further<'a> {
    /// Dynamic stiffness by harmonic from 0.
    pub(super) dynamic: &'a [DMatrix<Complex<f64>>],
    /// Periodic terms.
    pub(super) terms: &'a [PeriodicTerm<'a>],
}

impl LinearMotion {
    /// Of the steps 1 to s of a cycle of the mesh frequency `mesh_hz`.
    ///
    /// # Errors
    /// If there are no steps.
    pub(super) fn new(cycle: &[StepOfCycle], mesh_hz: f64) -> Result<Self, ExperimentError> {
        Self::with_terms(cycle, mesh_hz, &Further::default())
    }

    /// The same with what acts besides inertia, damping and stiffness.
    ///
    /// # Errors
    /// If there are no steps.
    pub(super) fn with_terms(
        cycle: &[StepOfCycle],
        mesh_hz: f64,
        further: &Further<'_>,
    ) -> Result<Self, ExperimentError> {
        let first = cycle.first().ok_or(ExperimentError::Incomplete("steps of a cycle"))?;
        let (steps, omega) = (cycle.len(), TAU * mesh_hz);
        let mass = first.tangent.mass.clone();
        let mut damping = DMatrix::zeros(mass.nrows(), mass.ncols());
        for step in cycle {
            damping += step.tangent.slow_damping() / steps as f64;
        }
        let stiffness: Vec<_> = cycle.iter().map(|step| step.tangent.stiffness()).collect();
        let harmonics = HARMONICS.min((steps - 1) / 2);
        let system = PeriodicSystem {
            mass: &mass,
            damping: &damping,
            stiffness: &stiffness,
            omega,
            dynamic: further.dynamic,
            terms: further.terms,
        };
        let equations = HillEquations::new(&system, harmonics).map_err(unsolved)?;
        let displacements: Vec<_> = cycle.iter().map(|step| step.displacements.clone()).collect();
        let lines = (0..=harmonics).map(|l| line(&displacements, l)).collect();
        Ok(Self { lines, mass, damping, equations, omega, steps })
    }

    /// X_0 … X_H of the races' coordinates in the motion, m.
    pub(super) fn lines(&self) -> &[DVector<Complex<f64>>] {
        &self.lines
    }

    /// Change of the lines of the races' coordinates by forces of lines F_0, F_1, …
    ///
    /// # Errors
    /// If the linearised motion is at a resonance without damping.
    pub(super) fn changed_by(
        &self,
        forces: &[DVector<Complex<f64>>],
    ) -> Result<Vec<DVector<Complex<f64>>>, ExperimentError> {
        self.equations.response(forces).map_err(unsolved)
    }

    /// Forces that the frequency of the time steps leaves in the equations of continuous time, lines from 0, N.
    pub(super) fn step_forces(&self) -> Vec<DVector<Complex<f64>>> {
        let h = TAU / (self.omega * self.steps as f64);
        let of = |(l, own): (usize, &DVector<Complex<f64>>)| {
            force((&self.mass, &self.damping), own, (l as f64 * self.omega, h))
        };
        self.lines.iter().enumerate().map(of).collect()
    }
}

fn unsolved(error: HillError) -> ExperimentError {
    ExperimentError::Model(error.to_string().into())
}

/// X_l = 2/s Σ_k x_k exp(−2πi l k/s) of samples k = 1 … s; X_0 the mean.
pub(super) fn line(samples: &[DVector<f64>], l: usize) -> DVector<Complex<f64>> {
    let steps = samples.len();
    let factor = if l == 0 { 1.0 } else { 2.0 } / steps as f64;
    let size = samples.first().map_or(0, DVector::len);
    let mut sum = DVector::zeros(size);
    for (k, x) in samples.iter().enumerate() {
        let turned = Complex::cis(-TAU * (l * (k + 1) % steps) as f64 / steps as f64) * factor;
        sum.zip_apply(x, |sum: &mut Complex<f64>, x| *sum += turned * x);
    }
    sum
}
