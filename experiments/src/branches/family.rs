//! Periodic motions of a set as a family of equations over speed, torque, damping or a number of the scene.

use dynamics::continuation::{Evaluation, Family, Judgement};
use dynamics::{MapDerivative, Multiplier, PeriodMap, multipliers};
use fe_contact::vibration::Along;
use nalgebra::{DMatrix, DVector};

use super::parameter::BranchParameter;
use crate::sweep::{
    CriticalMotion, Marching, Record, RecordedCycles, SMALL, SweepError, SweepModel,
};

/// Share of the parameter by which it is changed to either side for the derivative in it.
pub const PARAMETER_CHANGE: f64 = 1e-6;

/// F(y; λ) = Φᵖ(y; λ) − y for motions that repeat after p mesh cycles: y the coordinates at the start of a mesh cycle
/// (as [`CycleDerivative::coordinates`](crate::sweep::CycleDerivative::coordinates)), λ the speed of the input member
/// in rpm, the torque on the sun in N·m, the factor on the damping or a number of the scene. ∂F/∂y is the derivative of
/// the steps, ∂F/∂λ a central difference over λ (1 ± [`PARAMETER_CHANGE`]).
pub struct PeriodicFamily<'m> {
    model: &'m dyn SweepModel,
    over: BranchParameter,
    /// Share of the parameter for its differences.
    change: f64,
    /// Mesh cycles after which the motions repeat.
    repeats_after: usize,
    size: usize,
    dimension: usize,
    /// Solutions that were judged.
    pub(super) judged: Vec<Judged>,
}

/// Number of the test function that is zero where stability changes.
pub(super) const STABILITY: usize = 0;

/// Number of that which is zero at a period doubling; the last one is at folds and branch points.
pub(super) const PERIOD_DOUBLING: usize = 1;

/// A periodic motion with one period of it.
pub(super) struct Judged {
    pub(super) y: Vec<f64>,
    pub(super) lambda: f64,
    pub(super) multipliers: Vec<Multiplier>,
    pub(super) critical: Option<CriticalMotion>,
    pub(super) residual: f64,
    pub(super) record: Record,
}

impl<'m> PeriodicFamily<'m> {
    /// Motions that repeat with the mesh cycle, of a model whose coordinates number `dimension`; `size` as in
    /// [`SweepModel::turning`].
    pub fn new(
        model: &'m dyn SweepModel,
        over: BranchParameter,
        size: usize,
        dimension: usize,
    ) -> Self {
        let change = PARAMETER_CHANGE;
        Self { model, over, change, repeats_after: 1, size, dimension, judged: Vec::new() }
    }

    /// The same with another share of the parameter for its differences.
    pub fn with_change(self, change: f64) -> Self {
        Self { change, ..self }
    }

    /// The same for motions that repeat after some mesh cycles.
    pub fn repeating_after(self, cycles: usize) -> Self {
        Self { repeats_after: cycles, ..self }
    }

    /// DΦᵖ(y; λ).
    ///
    /// # Errors
    /// If the set cannot be built or stepped.
    pub fn map_derivative(&self, y: &[f64], lambda: f64) -> Result<MapDerivative, SweepError> {
        let mut set = self.set(lambda)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        self.advance(&mut cycles, &mut |_| ())
    }

    /// One period with its derivative; `each` hears of every mesh cycle.
    fn advance(
        &self,
        cycles: &mut RecordedCycles<'_>,
        each: &mut dyn FnMut(&Record),
    ) -> Result<MapDerivative, SweepError> {
        cycles.advance()?;
        let mut whole = cycles.of_cycle(Along::Every)?;
        each(cycles.last());
        for _ in 1..self.repeats_after {
            cycles.advance()?;
            whole = cycles.of_cycle(Along::Every)?.after(&whole);
            each(cycles.last());
        }
        Ok(whole)
    }

    fn set(&self, lambda: f64) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.over.set(self.model, lambda, self.size)
    }

    /// Whether the motion from y has ended at the same place after a period at two values of the parameter.
    pub(super) fn is_same(&self, y: &[f64], [a, b]: [f64; 2]) -> Result<bool, SweepError> {
        Ok(self.end(y, a)? == self.end(y, b)?)
    }

    fn cycles<'s>(&self, set: &'s mut dyn Marching) -> RecordedCycles<'s> {
        let (shape, steps) = (self.model.shape(), self.model.steps_per_cycle());
        RecordedCycles::new(set, shape, self.model.first_planet_rad(), steps)
    }

    /// Φᵖ(y; λ).
    fn end(&self, y: &[f64], lambda: f64) -> Result<Vec<f64>, SweepError> {
        let mut set = self.set(lambda)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        for _ in 0..self.repeats_after {
            cycles.advance()?;
        }
        Ok(cycles.coordinates())
    }
}

impl Family for PeriodicFamily<'_> {
    type Error = SweepError;

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, SweepError> {
        let mut set = self.set(lambda)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        let map = self.advance(&mut cycles, &mut |_| ())?;
        let end = cycles.coordinates();
        let n = y.len();
        let mut jacobian = -DMatrix::<f64>::identity(n, n);
        for (k, active) in map.active.iter().enumerate() {
            let mut column = jacobian.column_mut(*active);
            column += map.columns.column(k);
        }
        let change = self.change * lambda.abs();
        let above = DVector::from_vec(self.end(y, lambda + change)?);
        let below = DVector::from_vec(self.end(y, lambda - change)?);
        Ok(Evaluation {
            residual: DVector::from_vec(end) - DVector::from_column_slice(y),
            jacobian,
            derivative: (above - below) / (2.0 * change),
        })
    }

    /// Stable if all multipliers are smaller than 1. Test functions: the size of the largest less 1; Π (1 + μ), zero
    /// at a period doubling; Π (1 − μ), zero at a fold or branch point.
    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, SweepError> {
        let mut record: Option<Record> = None;
        let mut set = self.set(lambda)?;
        let mut cycles = self.cycles(set.as_mut());
        cycles.set_coordinates(y)?;
        let map = self.advance(&mut cycles, &mut |last| match &mut record {
            None => record = Some(last.clone()),
            Some(whole) => whole.append(last.clone()),
        })?;
        let record = record.ok_or(LOST)?;
        let off: Vec<f64> = cycles.coordinates().iter().zip(y).map(|(e, s)| e - s).collect();
        let residual = cycles.relative(&off);
        let all = multipliers(&map)?;
        let critical = CriticalMotion::of(set.as_ref(), &map, &all, 1)?;
        drop(set);
        let tests = vec![
            all.first().map_or(0.0, |m| m.size()) - 1.0,
            product(&all, 1.0),
            product(&all, -1.0),
        ];
        let is_stable = Some(tests[0] < 0.0);
        let multipliers = all.into_iter().filter(|m| m.size() >= SMALL).collect();
        let y = y.to_vec();
        self.judged.push(Judged { y, lambda, multipliers, critical, residual, record });
        Ok(Judgement { is_stable, tests })
    }
}

/// Π (1 + s μ), real as complex multipliers are pairs.
fn product(all: &[Multiplier], s: f64) -> f64 {
    let (mut re, mut im) = (1.0, 0.0);
    for m in all {
        let (a, b) = (1.0 + s * m.re, s * m.im);
        (re, im) = (re * a - im * b, re * b + im * a);
    }
    re
}

/// A model that has lost its derivative.
const LOST: SweepError = SweepError::Incomplete("derivative of the cycles");
