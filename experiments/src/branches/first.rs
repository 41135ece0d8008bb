//! The motion that a branch begins with.

use dynamics::continuation::Scales;
use fe_contact::vibration::Along;

use super::error::BranchError;
use super::settings::BranchSettings;
use crate::sweep::{Record, SteadySettings, SweepModel, shot};

/// Coordinates that vary by less than this share of the largest of their kind are scaled as if by that.
const LEAST_SHARE: f64 = 0.05;

/// Cycles marched before shooting is tried, first and again where it fails.
const SETTLING: [usize; 2] = [0, 400];

pub(super) fn no_start(settings: &BranchSettings, reason: String) -> BranchError {
    BranchError::NoStart { over: settings.over, start: settings.start, reason }
}

/// Coordinates of the periodic motion found from rest at the first value, and scales of all unknowns.
pub(super) fn first(
    model: &dyn SweepModel,
    settings: &BranchSettings,
    size: usize,
) -> Result<(Vec<f64>, Scales), BranchError> {
    let mut set = settings.over.set(model, settings.start, size)?;
    let lost = || BranchError::NoDerivative(model.name());
    let (shape, psi, steps) = (model.shape(), model.first_planet_rad(), model.steps_per_cycle());
    let mut last = String::new();
    for cycles in SETTLING {
        set.rest()?;
        if set.derivative().is_none() {
            return Err(lost());
        }
        let mut record = Record::new(shape);
        record.march(set.as_mut(), psi, steps * cycles)?;
        match shot(set.as_mut(), shape, psi, steps, &SteadySettings::default())? {
            Ok(_) => {
                last.clear();
                break;
            }
            Err(why) => last = why.to_string(),
        }
    }
    if !last.is_empty() {
        return Err(no_start(settings, last));
    }
    let start = set.derivative().ok_or_else(lost)?.coordinates();
    // Peak-to-peak values over one more cycle; the derivative has the kinds of the coordinates.
    let (mut low, mut high) = (start.clone(), start.clone());
    set.derivative().ok_or_else(lost)?.start();
    for _ in 0..steps {
        set.step()?;
        let own = set.derivative().ok_or_else(lost)?;
        own.keep_step();
        for (i, y) in own.coordinates().into_iter().enumerate() {
            (low[i], high[i]) = (low[i].min(y), high[i].max(y));
        }
    }
    let own = set.derivative().ok_or_else(lost)?;
    own.end()?;
    let map = own.of_cycle(Along::Every)?;
    let range = |i: usize| high[i] - low[i];
    let count = start.len();
    // Beside a displacement's size, for kinds of coordinates that do not vary.
    let all = (0..count).map(|i| range(i) / map.scales[i]).fold(0.0, f64::max);
    if !(all > 0.0 && all.is_finite()) {
        return Err(no_start(settings, "the set does not vibrate there".into()));
    }
    let largest = |kind: f64| {
        let own = (0..count).filter(|i| map.scales[*i] == kind).map(range);
        own.fold(LEAST_SHARE * all * kind, f64::max)
    };
    let root = settings.over.vibration_share() * (count as f64).sqrt();
    let unknowns =
        (0..count).map(|i| root * range(i).max(LEAST_SHARE * largest(map.scales[i]))).collect();
    let middle = 0.5 * (settings.range[0] + settings.range[1]);
    Ok((start, Scales { unknowns, parameter: settings.over.share() * middle.abs() }))
}
