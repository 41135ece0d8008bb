//! Steady state by shooting: the periodic solution of the very steps that marching takes.

use dynamics::{
    CarriedChange, MapDerivative, Multiplier, PeriodMap, ShootingError, ShootingSettings,
    floquet_vector, multipliers, shoot,
};

use fe_contact::statics::KinematicRest;
use fe_contact::vibration::Along;
use gearset::Symmetry;

use super::attraction::Attraction;
use super::critical_motion::CriticalMotion;
use super::error::SweepError;
use super::marching::Marching;
use super::record::{Record, radial};
use super::rest_samples::RestSamples;
use super::set_shape::SetShape;
use super::several_cycles::SeveralCycles;
use super::steady::SteadySettings;

/// Cycles after which shooting is given up and the motion marched: what it needs otherwise is about ten.
const MOST_CYCLES: usize = 80;

/// Cycles, or parts of a cycle, marched before the first derivative where a correction from the first of them does not
/// contract. Without any, motions in which teeth part are more often not found; more change nothing.
const SETTLING: usize = 1;

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
    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError>;

    /// The symmetry by which the set is itself after a part of a cycle, if it has one: every cycle may then end after
    /// such a part.
    ///
    /// # Errors
    /// If the set cannot be examined.
    fn symmetry(&mut self) -> Result<Option<Symmetry>, SweepError> {
        Ok(None)
    }

    /// Begins a cycle from the present state.
    fn start(&mut self);

    /// Keeps what the derivative needs of the last step.
    fn keep_step(&mut self);

    /// Ends a cycle: coordinates can then be compared with those at its start.
    ///
    /// # Errors
    /// If the bodies have no derivative.
    fn end(&mut self) -> Result<(), SweepError>;

    /// The derivative of the cycle that ended last.
    ///
    /// # Errors
    /// If the bodies have no derivative.
    fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, SweepError>;

    /// The same along [`Along::Motion`], with a change of the coordinates at the start of that cycle carried along: it
    /// is heard of the leading coordinates, those that [`Marching::displacements_of`] needs.
    ///
    /// # Errors
    /// If the bodies have no derivative, or the change is one of other coordinates.
    fn of_cycle_with(&mut self, change: CarriedChange<'_>) -> Result<MapDerivative, SweepError>;
}

/// Whole cycles of a set, or parts after which it is itself, the last one recorded.
pub(crate) struct RecordedCycles<'m> {
    set: &'m mut dyn Marching,
    first_planet_rad: f64,
    steps: usize,
    now: Record,
    /// Change of the displacements from the last cycle to the one that would follow it, step by step; empty until it is
    /// computed.
    ahead: Vec<f64>,
    /// Peak-to-peak vibration of the last cycle, by which deviations are judged.
    pub(super) sizes: [f64; 2],
    /// States of the last cycle for its kinematic rest, if that is sampled.
    rest: Option<RestSamples>,
}

impl<'m> RecordedCycles<'m> {
    /// Of a set at the start of a mesh cycle of some `steps`; none is recorded yet.
    pub(crate) fn new(
        set: &'m mut dyn Marching,
        shape: SetShape,
        first_planet_rad: f64,
        steps: usize,
    ) -> Self {
        let (now, ahead) = (Record::new(shape), Vec::new());
        Self { set, first_planet_rad, steps, now, ahead, sizes: [0.0; 2], rest: None }
    }

    /// The derivative of the last cycle.
    ///
    /// # Errors
    /// If the bodies have no derivative.
    pub(crate) fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, SweepError> {
        self.set.derivative().ok_or(LOST)?.of_cycle(along)
    }

    /// The last cycle.
    pub(crate) fn last(&self) -> &Record {
        &self.now
    }

    /// The set.
    pub(super) fn into_set(self) -> &'m mut dyn Marching {
        self.set
    }
}

/// A model that has lost its derivative.
pub(super) const LOST: SweepError = SweepError::Incomplete("derivative of the cycles");

impl PeriodMap for RecordedCycles<'_> {
    type Error = SweepError;

    fn coordinates(&mut self) -> Vec<f64> {
        self.set.derivative().map(|own| own.coordinates()).unwrap_or_default()
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError> {
        self.set.derivative().ok_or(LOST)?.set_coordinates(y)
    }

    fn advance(&mut self) -> Result<(), SweepError> {
        self.set.derivative().ok_or(LOST)?.start();
        if let Some(rest) = &mut self.rest {
            rest.clear();
        }
        let rest = &mut self.rest;
        self.now.march_and(self.set, self.first_planet_rad, self.steps, &mut |set, step| {
            if let Some(derivative) = set.derivative() {
                derivative.keep_step();
            }
            if let Some(rest) = rest {
                rest.take(set, step);
            }
        })?;
        self.sizes = self.now.sizes();
        self.set.derivative().ok_or(LOST)?.end()
    }

    fn derivative(&mut self) -> Result<MapDerivative, SweepError> {
        self.of_cycle(Along::Motion)
    }

    fn rough_derivative(&mut self) -> Result<MapDerivative, SweepError> {
        self.of_cycle(Along::MotionRoughly)
    }

    fn relative(&self, deviation: &[f64]) -> f64 {
        let (central, planets) = self.set.displacements_of(deviation);
        let all = central.iter().chain(&planets).flatten();
        self.relative_to_vibration(all.copied().enumerate())
    }

    fn derivative_and_change(
        &mut self,
        residual: &[f64],
    ) -> Result<(MapDerivative, f64), SweepError> {
        let mut leading: Vec<Vec<f64>> = Vec::with_capacity(self.steps);
        let hear = &mut |x: &[f64]| leading.push(x.to_vec());
        let change = CarriedChange { start: residual, hear };
        let derivative = self.set.derivative().ok_or(LOST)?.of_cycle_with(change)?;
        self.ahead.clear();
        for x in leading {
            let (central, planets) = self.set.displacements_of(&x);
            self.ahead.extend(radial(central, self.first_planet_rad).iter().flatten());
            self.ahead.extend(planets.iter().flatten());
        }
        let change = self.relative_to_vibration(self.ahead.iter().copied().enumerate());
        Ok((derivative, change))
    }
}

impl RecordedCycles<'_> {
    /// The larger of the ratios of deviations and vibration of translations and of rotations; every third number, the
    /// last of each body, is a rotation.
    fn relative_to_vibration(&self, deviations: impl Iterator<Item = (usize, f64)>) -> f64 {
        let mut largest = [0.0f64; 2];
        for (i, value) in deviations {
            let own = &mut largest[usize::from(i % 3 == 2)];
            // NaN is kept.
            *own = if value.abs() <= *own { *own } else { value.abs() };
        }
        let ratio = |kind: usize| match largest[kind] {
            0.0 => 0.0,
            deviation => deviation / self.sizes[kind],
        };
        let (a, b) = (ratio(0), ratio(1));
        // NaN is kept.
        if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
    }
}

/// A periodic solution found by shooting.
pub(crate) struct Shot {
    /// The last cycle; of a motion that repeats after several, their mean.
    pub(super) record: Record,
    /// Those several cycles.
    pub(super) whole: Option<Record>,
    /// Mesh cycles after which the motion repeats.
    pub(super) repeats_after: usize,
    /// Energy between harmonics over the last cycle and the one that follows it, if requested.
    pub(super) between: Option<f64>,
    /// Whole cycles that the periods marched amount to.
    pub(super) cycles: usize,
    /// Kinematic rest over the last cycle; `None` if the model has none.
    pub(super) rest: Option<KinematicRest>,
    pub(super) derivatives: usize,
    pub(super) residual: f64,
    pub(super) attraction: Attraction,
    pub(super) multipliers: Vec<Multiplier>,
    pub(super) critical: Option<CriticalMotion>,
    /// Of a motion that repels: the change of the coordinates that grows fastest, in size the peak-to-peak vibration.
    pub(super) growing: Option<Vec<f64>>,
    /// Largest change of the displacements from where shooting began, relative to the peak-to-peak vibration.
    pub(super) distance: f64,
}

/// Why there is no periodic solution near a state, where nothing else is wrong.
pub(crate) type NotFound = ShootingError<SweepError>;

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
) -> Result<Result<Shot, NotFound>, SweepError> {
    let symmetry = match set.derivative() {
        Some(own) if !settings.whole_cycles => own.symmetry()?,
        _ => None,
    };
    let parts = symmetry.map_or(1, |own| own.parts);
    let mut cycles = RecordedCycles::new(set, shape, first_planet_rad, steps / parts);
    cycles.rest = Some(RestSamples::new(steps));
    let start = cycles.coordinates();
    let found = match shoot(&mut cycles, &settings.shooting(parts)) {
        Ok(found) => found,
        Err(why) => return Ok(Err(why)),
    };
    let of_part = multipliers(&found.derivative)?;
    let distance = distance(&mut cycles, &start);
    let growing = growing(&cycles, &found.derivative, &of_part)?;
    let RecordedCycles { now, ahead, set, rest, .. } = cycles;
    let critical = CriticalMotion::of(&*set, &found.derivative, &of_part, parts)?;
    let mut multipliers = of_whole_cycle(of_part, parts);
    let attraction = Attraction::by(&multipliers);
    multipliers.retain(|m| m.size() >= SMALL);
    let whole = |part: Record| match &symmetry {
        Some(own) => part.of_whole_cycle(own),
        None => part,
    };
    let next = (settings.between_cycles > 0).then(|| whole(now.changed_by(&ahead)));
    let record = whole(now);
    let between = match next {
        None => None,
        Some(next) => {
            let mut both = record.clone();
            both.append(next);
            Some(both.between_harmonics(2)?)
        }
    };
    Ok(Ok(Shot {
        between,
        rest: rest.and_then(|rest| rest.rest(&*set, &record)),
        record,
        whole: None,
        repeats_after: 1,
        cycles: found.periods.div_ceil(parts),
        derivatives: found.derivatives,
        residual: found.residual,
        attraction,
        multipliers,
        critical,
        growing,
        distance,
    }))
}

/// The same for a motion that repeats after some mesh cycles, 2 or more.
///
/// # Errors
/// As [`shot`].
pub(super) fn shot_over(
    set: &mut dyn Marching,
    shape: SetShape,
    first_planet_rad: f64,
    steps: usize,
    (settings, count): (&SteadySettings, usize),
) -> Result<Result<Shot, NotFound>, SweepError> {
    let cycle = RecordedCycles::new(set, shape, first_planet_rad, steps);
    let mut cycles = SeveralCycles::new(cycle, count);
    let start = cycles.coordinates();
    let found = match shoot(&mut cycles, &settings.shooting(1)) {
        Ok(found) => found,
        Err(why) => return Ok(Err(why)),
    };
    let mut multipliers = multipliers(&found.derivative)?;
    let distance = distance(&mut cycles, &start);
    let growing = growing(&cycles, &found.derivative, &multipliers)?;
    let (set, whole) = cycles.parts();
    let critical = CriticalMotion::of(&*set, &found.derivative, &multipliers, 1)?;
    let attraction = Attraction::by(&multipliers);
    multipliers.retain(|m| m.size() >= SMALL);
    Ok(Ok(Shot {
        between: Some(whole.between_harmonics(count)?),
        rest: None,
        record: whole.mean_cycle(count),
        whole: Some(whole),
        repeats_after: count,
        cycles: found.periods * count,
        derivatives: found.derivatives * count,
        residual: found.residual,
        attraction,
        multipliers,
        critical,
        growing,
        distance,
    }))
}

impl SteadySettings {
    /// Settings of shooting over periods of which `parts` make a mesh cycle.
    fn shooting(&self, parts: usize) -> ShootingSettings {
        let most_periods = parts * self.most_cycles.clamp(2, MOST_CYCLES);
        ShootingSettings { tolerance: self.tolerance, settling: SETTLING, most_periods }
    }
}

/// Largest change of the displacements from a start, relative to the peak-to-peak vibration.
fn distance<M: PeriodMap>(cycles: &mut M, start: &[f64]) -> f64 {
    let change: Vec<f64> = cycles.coordinates().iter().zip(start).map(|(y, s)| y - s).collect();
    cycles.relative(&change)
}

/// The change of the coordinates that grows fastest about a motion, in size the peak-to-peak vibration; `None` if
/// none grows.
///
/// # Errors
/// If the eigenvector is not found.
fn growing<M: PeriodMap>(
    cycles: &M,
    derivative: &MapDerivative,
    multipliers: &[Multiplier],
) -> Result<Option<Vec<f64>>, SweepError> {
    let largest = multipliers.first().filter(|_| Attraction::by(multipliers) == Attraction::Repels);
    let Some(largest) = largest else { return Ok(None) };
    let [vector, _] = floquet_vector(derivative, *largest)?;
    let size = cycles.relative(&vector);
    Ok(Some(vector.into_iter().map(|v| v / size).collect()))
}

/// Multipliers of a whole cycle from those of one of its equal parts: the map of a cycle is the p-th power of that of a
/// part.
fn of_whole_cycle(of_part: Vec<Multiplier>, parts: usize) -> Vec<Multiplier> {
    let of_cycle = |m: Multiplier| (1..parts).fold(m, |power, _| power.times(m));
    of_part.into_iter().map(of_cycle).collect()
}

/// Multipliers of the `count` cycles that begin at the present state, all of them, and the change of the
/// coordinates that grows fastest if one does, in size the peak-to-peak vibration; `None` for a model without
/// derivative.
///
/// # Errors
/// If a step fails or the multipliers cannot be computed.
pub(super) fn multipliers_ahead(
    set: &mut dyn Marching,
    shape: SetShape,
    first_planet_rad: f64,
    (steps, count): (usize, usize),
) -> Result<Option<Ahead>, SweepError> {
    if set.derivative().is_none() {
        return Ok(None);
    }
    let cycle = RecordedCycles::new(set, shape, first_planet_rad, steps);
    let mut cycles = SeveralCycles::new(cycle, count);
    cycles.advance()?;
    let derivative = cycles.derivative()?;
    let multipliers = multipliers(&derivative)?;
    let growing = growing(&cycles, &derivative, &multipliers)?;
    let (set, _) = cycles.parts();
    let critical = CriticalMotion::of(&*set, &derivative, &multipliers, 1)?;
    Ok(Some(Ahead { multipliers, critical, growing }))
}

/// What the derivative of the cycles ahead says.
pub(super) struct Ahead {
    pub(super) multipliers: Vec<Multiplier>,
    pub(super) critical: Option<CriticalMotion>,
    pub(super) growing: Option<Vec<f64>>,
}
