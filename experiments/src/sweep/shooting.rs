//! Steady state by shooting: the periodic solution of the very steps that marching takes.

use dynamics::{
    MapDerivative, Multiplier, PeriodMap, ShootingError, ShootingSettings, multipliers, shoot,
};

use super::marching::Marching;
use super::record::Record;
use super::set_shape::SetShape;
use super::steady::SteadySettings;
use crate::error::ExperimentError;

/// Cycles after which shooting is given up and the motion marched: what it needs otherwise is about ten.
const MOST_CYCLES: usize = 80;

/// Cycles marched before the first derivative: one costs about a tenth of a derivative.
const SETTLING: usize = 2;

/// Multipliers below this size are left out: such perturbations are gone after one cycle.
pub(crate) const SMALL: f64 = 1e-3;

/// The derivative of the cycles of a set.
pub trait CycleDerivative {
    /// Coordinates that determine the motion after a whole number of mesh cycles.
    fn coordinates(&mut self) -> Vec<f64>;

    /// Continues from other coordinates at the same position.
    ///
    /// # Errors
    /// If they are too few or too many, or not finite.
    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), ExperimentError>;

    /// Begins a derivative at the start of a cycle.
    ///
    /// # Errors
    /// If the bodies have none.
    fn start(&mut self) -> Result<(), ExperimentError>;

    /// Carries it over the last step.
    fn carry(&mut self);

    /// Ends a cycle, with or without a derivative: coordinates can then be compared with those at its start.
    ///
    /// # Errors
    /// If the bodies have no derivative.
    fn end(&mut self) -> Result<Option<MapDerivative>, ExperimentError>;
}

/// Whole cycles of a set, the last two recorded.
pub(crate) struct RecordedCycles<'m> {
    set: &'m mut dyn Marching,
    first_planet_rad: f64,
    steps: usize,
    now: Record,
    before: Record,
    /// Whether the last cycle followed the one before, and the next will follow the last.
    follows: [bool; 2],
}

impl<'m> RecordedCycles<'m> {
    /// Of a set at the start of a mesh cycle of some `steps`; none is recorded yet.
    pub(crate) fn new(
        set: &'m mut dyn Marching,
        shape: SetShape,
        first_planet_rad: f64,
        steps: usize,
    ) -> Self {
        let (now, before) = (Record::new(shape), Record::new(shape));
        Self { set, first_planet_rad, steps, now, before, follows: [false; 2] }
    }

    /// The last cycle.
    pub(crate) fn last(&self) -> &Record {
        &self.now
    }
}

/// A model that has lost its derivative.
const LOST: ExperimentError = ExperimentError::Incomplete("derivative of the cycles");

impl PeriodMap for RecordedCycles<'_> {
    type Error = ExperimentError;

    fn coordinates(&mut self) -> Vec<f64> {
        self.set.derivative().map(|own| own.coordinates()).unwrap_or_default()
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), ExperimentError> {
        self.follows[1] = false;
        self.set.derivative().ok_or(LOST)?.set_coordinates(y)
    }

    fn advance(&mut self, with_derivative: bool) -> Result<Option<MapDerivative>, ExperimentError> {
        std::mem::swap(&mut self.now, &mut self.before);
        self.follows = [self.follows[1], true];
        if with_derivative {
            self.set.derivative().ok_or(LOST)?.start()?;
            self.now.march_with(self.set, self.first_planet_rad, self.steps)?;
        } else {
            self.now.march(self.set, self.first_planet_rad, self.steps)?;
        }
        self.set.derivative().ok_or(LOST)?.end()
    }

    fn relative(&self, deviation: &[f64]) -> f64 {
        let (central, planets) = self.set.displacements_of(deviation);
        let mut largest = [0.0f64; 2];
        for (axis, value) in central.iter().chain(&planets).flat_map(|body| body.iter().enumerate())
        {
            let own = &mut largest[usize::from(axis == 2)];
            // NaN is kept.
            *own = if value.abs() <= *own { *own } else { value.abs() };
        }
        let sizes = self.now.sizes();
        let ratio = |kind: usize| match largest[kind] {
            0.0 => 0.0,
            deviation => deviation / sizes[kind],
        };
        let (a, b) = (ratio(0), ratio(1));
        // NaN is kept.
        if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
    }

    fn change(&self) -> f64 {
        if self.follows[0] { self.now.change_from(&self.before) } else { f64::INFINITY }
    }
}

/// A periodic solution found by shooting.
pub(crate) struct Shot {
    /// The last cycle.
    pub(super) record: Record,
    /// Energy between harmonics over the last two cycles.
    pub(super) between: f64,
    pub(super) cycles: usize,
    pub(super) derivatives: usize,
    pub(super) residual: f64,
    pub(super) multipliers: Vec<Multiplier>,
}

/// Shoots from the present state; the inner error is the reason why there is no periodic solution near it.
///
/// # Errors
/// If the spectrum of the record or the multipliers cannot be computed.
pub(crate) fn shot(
    set: &mut dyn Marching,
    shape: SetShape,
    first_planet_rad: f64,
    steps: usize,
    settings: &SteadySettings,
) -> Result<Result<Shot, ShootingError<ExperimentError>>, ExperimentError> {
    let mut cycles = RecordedCycles::new(set, shape, first_planet_rad, steps);
    let most_periods = settings.most_cycles.clamp(2, MOST_CYCLES);
    let own = ShootingSettings { tolerance: settings.tolerance, settling: SETTLING, most_periods };
    let found = match shoot(&mut cycles, &own) {
        Ok(found) => found,
        Err(why) => return Ok(Err(why)),
    };
    let mut multipliers = multipliers(&found.derivative)?;
    multipliers.retain(|m| m.size() >= SMALL);
    let RecordedCycles { now, mut before, .. } = cycles;
    before.append(now.clone());
    Ok(Ok(Shot {
        between: before.between_harmonics(2)?,
        record: now,
        cycles: found.periods,
        derivatives: found.derivatives,
        residual: found.residual,
        multipliers,
    }))
}
