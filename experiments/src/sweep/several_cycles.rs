//! Several mesh cycles as one period.

use dynamics::{MapDerivative, PeriodMap};
use fe_contact::vibration::Along;

use super::error::SweepError;
use super::marching::Marching;
use super::record::Record;
use super::shooting::{LOST, RecordedCycles};

/// A period of several mesh cycles, all of them recorded. Its derivative is DΦᵖ = DΦ(y_{p−1}) … DΦ(y₀).
pub(super) struct SeveralCycles<'m> {
    cycle: RecordedCycles<'m>,
    count: usize,
    whole: Record,
    derivative: Option<MapDerivative>,
}

impl<'m> SeveralCycles<'m> {
    pub(super) fn new(cycle: RecordedCycles<'m>, count: usize) -> Self {
        Self { cycle, count, whole: Record::default(), derivative: None }
    }

    /// The set, and the record of the last period.
    pub(super) fn parts(self) -> (&'m mut dyn Marching, Record) {
        (self.cycle.into_set(), self.whole)
    }
}

impl PeriodMap for SeveralCycles<'_> {
    type Error = SweepError;

    fn coordinates(&mut self) -> Vec<f64> {
        self.cycle.coordinates()
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError> {
        self.cycle.set_coordinates(y)
    }

    fn advance(&mut self) -> Result<(), SweepError> {
        self.derivative = None;
        for number in 0..self.count {
            self.cycle.advance()?;
            // A set keeps what the derivative needs of its last cycle alone.
            let next = self.cycle.of_cycle(Along::Every)?;
            self.derivative = Some(match self.derivative.take() {
                Some(first) => next.after(&first),
                None => next,
            });
            match number {
                0 => self.whole = self.cycle.last().clone(),
                _ => self.whole.append(self.cycle.last().clone()),
            }
        }
        self.cycle.sizes = self.whole.sizes();
        Ok(())
    }

    fn derivative(&mut self) -> Result<MapDerivative, SweepError> {
        self.derivative.clone().ok_or(LOST)
    }

    fn relative(&self, deviation: &[f64]) -> f64 {
        self.cycle.relative(deviation)
    }

    /// The change is that at the ends of the period.
    fn derivative_and_change(
        &mut self,
        residual: &[f64],
    ) -> Result<(MapDerivative, f64), SweepError> {
        let derivative = self.derivative()?;
        let mut next = vec![0.0; residual.len()];
        for (column, active) in derivative.columns.column_iter().zip(&derivative.active) {
            next.iter_mut().zip(column.iter()).for_each(|(x, d)| *x += d * residual[*active]);
        }
        let change = self.relative(residual).max(self.relative(&next));
        Ok((derivative, change))
    }
}
