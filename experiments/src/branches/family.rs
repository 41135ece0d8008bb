//! Periodic motions of a set as a family of equations over speed.

use dynamics::continuation::{Evaluation, Family, Judgement};
use dynamics::{Multiplier, PeriodMap, multipliers};
use nalgebra::{DMatrix, DVector};

use crate::error::ExperimentError;
use crate::sweep::{Marching, Record, RecordedCycles, SMALL, SweepModel};

/// Share of the speed by which it is changed to either side for the derivative in speed.
const SPEED_CHANGE: f64 = 1e-6;

/// F(y; n) = Φ(y; n) − y: y the coordinates at the start of a mesh cycle (as
/// [`CycleDerivative::coordinates`](crate::sweep::CycleDerivative::coordinates)), n the speed of the input member
/// in rpm. ∂F/∂y is the derivative of the steps, ∂F/∂n a central difference.
pub struct PeriodicFamily<'m> {
    model: &'m dyn SweepModel,
    size: usize,
    dimension: usize,
    /// Solutions that were judged.
    pub(super) judged: Vec<Judged>,
}

/// A periodic motion with its last cycle.
pub(super) struct Judged {
    pub(super) y: Vec<f64>,
    pub(super) speed_rpm: f64,
    pub(super) multipliers: Vec<Multiplier>,
    pub(super) residual: f64,
    pub(super) record: Record,
}

impl<'m> PeriodicFamily<'m> {
    /// Of a model whose coordinates number `dimension`; `size` as in [`SweepModel::turning`].
    pub fn new(model: &'m dyn SweepModel, size: usize, dimension: usize) -> Self {
        Self { model, size, dimension, judged: Vec::new() }
    }

    fn set(&self, speed_rpm: f64) -> Result<Box<dyn Marching + '_>, ExperimentError> {
        let mut set = self.model.turning(&self.model.case().at_speed(speed_rpm), self.size)?;
        // The load belongs to the set, not to its coordinates.
        set.rest()?;
        Ok(set)
    }

    fn cycles<'s>(&self, set: &'s mut dyn Marching) -> RecordedCycles<'s> {
        let (shape, steps) = (self.model.shape(), self.model.steps_per_cycle());
        RecordedCycles::new(set, shape, self.model.first_planet_rad(), steps)
    }

    /// Φ(y; n).
    fn end(&self, y: &[f64], speed_rpm: f64) -> Result<Vec<f64>, ExperimentError> {
        let mut set = self.set(speed_rpm)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        cycles.advance(false)?;
        Ok(cycles.coordinates())
    }
}

impl Family for PeriodicFamily<'_> {
    type Error = ExperimentError;

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn evaluate(&mut self, y: &[f64], speed_rpm: f64) -> Result<Evaluation, ExperimentError> {
        let mut set = self.set(speed_rpm)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        let map = cycles.advance(true)?.ok_or(LOST)?;
        let end = cycles.coordinates();
        let n = y.len();
        let mut jacobian = -DMatrix::<f64>::identity(n, n);
        for (k, active) in map.active.iter().enumerate() {
            let mut column = jacobian.column_mut(*active);
            column += map.columns.column(k);
        }
        let change = SPEED_CHANGE * speed_rpm;
        let above = DVector::from_vec(self.end(y, speed_rpm + change)?);
        let below = DVector::from_vec(self.end(y, speed_rpm - change)?);
        Ok(Evaluation {
            residual: DVector::from_vec(end) - DVector::from_column_slice(y),
            jacobian,
            derivative: (above - below) / (2.0 * change),
        })
    }

    /// Stable if all multipliers are smaller than 1. One test function: the size of the largest less 1.
    fn judge(&mut self, y: &[f64], speed_rpm: f64) -> Result<Judgement, ExperimentError> {
        let mut set = self.set(speed_rpm)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        let map = cycles.advance(true)?.ok_or(LOST)?;
        let off: Vec<f64> = cycles.coordinates().iter().zip(y).map(|(e, s)| e - s).collect();
        let residual = cycles.relative(&off);
        let record = cycles.into_record();
        drop(set);
        let mut found = multipliers(&map)?;
        found.retain(|m| m.size() >= SMALL);
        let largest = found.first().map_or(0.0, |m| m.size());
        let y = y.to_vec();
        self.judged.push(Judged { y, speed_rpm, multipliers: found, residual, record });
        Ok(Judgement { is_stable: Some(largest < 1.0), tests: vec![largest - 1.0] })
    }
}

/// A model that has lost its derivative.
const LOST: ExperimentError = ExperimentError::Incomplete("derivative of the cycles");
