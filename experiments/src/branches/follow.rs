//! Follows a branch of periodic motions over speed.

use dynamics::continuation::{
    self, ContinuationError, ContinuationOptions, End, PointKind, Scales, trace_both,
};
use dynamics::{Multiplier, MultiplierKind};

use super::branch::{Branch, BranchEnd};
use super::error::BranchError;
use super::family::{Judged, PeriodicFamily};
use super::point::{BranchPoint, BranchPointKind};
use super::settings::BranchSettings;
use crate::error::ExperimentError;
use crate::sweep::{Record, Steady, SteadySettings, SweepModel, SweepPoint, shot};
use crate::table_growth::{Outgrown, large_enough};

/// Share of the middle speed of the range that counts as a unit of arc.
const SPEED_UNIT: f64 = 0.02;

/// Coordinates that vary by less than this share of the largest of their kind are scaled as if by that.
const LEAST_SHARE: f64 = 0.05;

/// Cycles marched before shooting is tried, first and again where it fails.
const SETTLING: [usize; 2] = [0, 400];

/// A change of stability this near to a fold, as a share of the speed, is the fold itself.
const SAME: f64 = 1e-5;

/// The branch of periodic motions through the one found from rest at the first speed, both ways.
///
/// # Errors
/// [`BranchError`] if the settings are out of range, the model has no derivative, or no periodic motion is found to begin with;
/// other errors if the set cannot be built. Whatever happens later ends the branch and stands in [`Branch::ends`].
pub fn branch(
    model: &dyn SweepModel,
    settings: &BranchSettings,
) -> Result<Branch, ExperimentError> {
    settings.check()?;
    model.prepare()?;
    large_enough(|size| attempt(model, settings, size))
}

fn attempt(
    model: &dyn SweepModel,
    settings: &BranchSettings,
    size: usize,
) -> Result<Branch, ExperimentError> {
    let (start, scales) = first(model, settings, size)?;
    let mut family = PeriodicFamily::new(model, size, start.len());
    let options = ContinuationOptions {
        most_points: settings.most_points,
        steps: [1e-6, settings.longest_step],
        ..ContinuationOptions::within(settings.speeds_rpm)
    };
    let found = trace_both(&mut family, &start, settings.start_rpm, &scales, &options);
    let found = found.map_err(|error| match error {
        ContinuationError::Family { cause, .. } => cause,
        other => no_start(settings, other.to_string()),
    })?;
    let mut ends = [BranchEnd::Bound, BranchEnd::Bound];
    for (own, end) in ends.iter_mut().zip(found.ends) {
        *own = match end {
            End::Start | End::Bound => BranchEnd::Bound,
            End::Closed => BranchEnd::Closed,
            End::MostPoints => BranchEnd::MostPoints,
            End::Stuck(ContinuationError::Family { cause, .. }) if cause.is_too_small() => {
                return Err(cause);
            }
            End::Stuck(why) => BranchEnd::Stuck(why.to_string()),
        };
    }
    let mut points = Vec::with_capacity(found.points.len());
    for own in &found.points {
        points.push(point(model, &family.judged, own, settings.harmonics, size)?);
    }
    drop_doubles(&mut points);
    Ok(Branch { fidelity: model.name(), points, ends })
}

fn no_start(settings: &BranchSettings, reason: String) -> ExperimentError {
    BranchError::NoStart { speed_rpm: settings.start_rpm, reason }.into()
}

/// Coordinates of the periodic motion found from rest at the first speed, and scales of all unknowns.
fn first(
    model: &dyn SweepModel,
    settings: &BranchSettings,
    size: usize,
) -> Result<(Vec<f64>, Scales), ExperimentError> {
    let mut set = model.turning(&model.case().at_speed(settings.start_rpm), size)?;
    let lost = || BranchError::NoDerivative(model.name());
    let (shape, psi, steps) = (model.shape(), model.first_planet_rad(), model.steps_per_cycle());
    let mut last = String::new();
    for cycles in SETTLING {
        set.rest()?;
        if set.derivative().is_none() {
            return Err(lost().into());
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
    set.derivative().ok_or_else(lost)?.start()?;
    for _ in 0..steps {
        set.step()?;
        let own = set.derivative().ok_or_else(lost)?;
        own.carry();
        for (i, y) in own.coordinates().into_iter().enumerate() {
            (low[i], high[i]) = (low[i].min(y), high[i].max(y));
        }
    }
    let map = set.derivative().ok_or_else(lost)?.end()?.ok_or_else(lost)?;
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
    let root = (count as f64).sqrt();
    let unknowns =
        (0..count).map(|i| root * range(i).max(LEAST_SHARE * largest(map.scales[i]))).collect();
    let middle = 0.5 * (settings.speeds_rpm[0] + settings.speeds_rpm[1]);
    Ok((start, Scales { unknowns, parameter: SPEED_UNIT * middle }))
}

/// What is kept of a solution.
fn point(
    model: &dyn SweepModel,
    judged: &[Judged],
    own: &continuation::BranchPoint,
    harmonics: usize,
    size: usize,
) -> Result<BranchPoint, ExperimentError> {
    let is_own = |j: &&Judged| j.speed_rpm == own.lambda && j.y == own.y;
    let found = judged.iter().rev().find(is_own);
    let found = found.ok_or(ExperimentError::Incomplete("motion that was judged"))?;
    let case = model.case().at_speed(own.lambda);
    let steady = Steady::periodic(found.record.clone(), found.multipliers.clone(), found.residual);
    let settings = SteadySettings { harmonics, ..SteadySettings::default() };
    let SweepPoint { state, multipliers, lowest_force_n, contact_loss, backside_contact, .. } =
        SweepPoint::new(case, &steady, &settings, size)?;
    let kind = match own.kind {
        PointKind::Regular => BranchPointKind::Regular,
        PointKind::Fold => BranchPointKind::Fold,
        PointKind::Bifurcation(_) => kind(&found.multipliers),
    };
    Ok(BranchPoint {
        state,
        kind,
        is_stable: own.judgement.is_stable.unwrap_or(false),
        multipliers,
        residual: found.residual,
        arc: own.arc,
        iterations: own.iterations,
        lowest_force_n,
        contact_loss,
        backside_contact,
        grazing_margin: grazing_margin(&found.record),
    })
}

/// How stability changes, from the multiplier nearest to the unit circle.
fn kind(all: &[Multiplier]) -> BranchPointKind {
    let off = |m: &Multiplier| (m.size() - 1.0).abs();
    let nearest = all.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    match nearest.map(|m| m.kind()) {
        Some(MultiplierKind::PeriodDoubling) => BranchPointKind::PeriodDoubling,
        Some(MultiplierKind::NeimarkSacker) => BranchPointKind::NeimarkSacker,
        Some(MultiplierKind::Fold) | None => BranchPointKind::BranchPoint,
    }
}

/// Least of lowest over mean force of the meshes that never part.
fn grazing_margin(record: &Record) -> Option<f64> {
    let margin = |mesh: usize| {
        let force = record.mesh_force(mesh);
        let lowest = force.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = force.iter().sum::<f64>() / force.len().max(1) as f64;
        (lowest > 0.0).then(|| lowest / mean)
    };
    (0..record.shape().meshes()).filter_map(margin).min_by(f64::total_cmp)
}

/// Leaves out changes of stability that are the folds beside them.
fn drop_doubles(points: &mut Vec<BranchPoint>) {
    let folds: Vec<(f64, f64)> = points
        .iter()
        .filter(|p| p.kind == BranchPointKind::Fold)
        .map(|p| (p.state.case.speed_rpm, p.arc))
        .collect();
    points.retain(|p| {
        let near = |(speed, arc): &(f64, f64)| {
            (speed - p.state.case.speed_rpm).abs() <= SAME * speed && (arc - p.arc).abs() <= 0.1
        };
        p.kind != BranchPointKind::BranchPoint || !folds.iter().any(near)
    });
}
