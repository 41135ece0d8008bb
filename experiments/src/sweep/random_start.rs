//! States off rest from which a search may end on another motion that attracts.

use fastrand::Rng;

use super::error::SweepError;
use super::marching::Marching;
use super::record::Record;
use super::set_shape::SetShape;

/// Rotations count with this arm, m.
const ARM: f64 = 0.05;

/// Cycles from rest that say how large the vibration of a set is.
const CYCLES: usize = 8;

/// Largest push off rest, of that vibration.
const LARGEST: f64 = 3.0;

/// Cycles marched from the push before the search begins: shooting at once would end on whichever motion its
/// corrections meet.
const AHEAD: usize = 32;

/// A model that a random start is asked of in vain.
const LACKS: SweepError =
    SweepError::Incomplete("derivative of its steps, which random starts need");

/// Puts a set at rest, pushes it at random, by a direction and size that depend on `number` alone, and marches on from
/// there, whole cycles.
///
/// # Errors
/// If the set cannot be brought to rest or a step fails.
pub(super) fn start_at_random(
    set: &mut dyn Marching,
    shape: SetShape,
    (first_planet_rad, steps): (f64, usize),
    number: u32,
) -> Result<(), SweepError> {
    let mut random = Rng::with_seed(u64::from(number));
    let march = |set: &mut dyn Marching, cycles: usize| {
        let mut record = Record::new(shape);
        record.march(set, first_planet_rad, steps * cycles).map(|()| record)
    };
    set.rest()?;
    let size = vibration(&march(set, CYCLES)?);
    set.rest()?;
    let push = LARGEST * random.f64() * size;
    push_at_random(set, shape.planets, push, &mut random)?;
    march(set, AHEAD).map(|_| ())
}

/// Moves central bodies and planets of a set at random: the largest translation, or rotation times an arm of 0.05 m, by
/// `push`, m.
///
/// # Errors
/// If the model has no derivative, which holds its coordinates.
pub fn push_at_random(
    set: &mut dyn Marching,
    planets: usize,
    push: f64,
    random: &mut Rng,
) -> Result<(), SweepError> {
    let coordinates = |set: &mut dyn Marching| set.derivative().map(|own| own.coordinates());
    let mut y = coordinates(set).ok_or(LACKS)?;
    let leading = y.len().min(3 * (3 + planets));
    let direction: Vec<f64> =
        (0..y.len()).map(|i| if i < leading { 2.0 * random.f64() - 1.0 } else { 0.0 }).collect();
    let (central, planets) = set.displacements_of(&direction);
    let all = central.iter().chain(&planets).flat_map(|[x, y, t]| [*x, *y, ARM * t]);
    let size = all.fold(0.0f64, |a, x| a.max(x.abs()));
    y.iter_mut().zip(&direction).for_each(|(y, d)| *y += push / size * d);
    set.derivative().ok_or(LACKS)?.set_coordinates(&y)
}

/// Largest peak to peak of all translations, and rotations times an arm of 0.05 m, m.
pub fn vibration(record: &Record) -> f64 {
    let of = |channel: usize| record.range(channel) * if channel % 3 == 2 { ARM } else { 1.0 };
    (0..record.displacements()).map(of).fold(0.0, f64::max)
}
