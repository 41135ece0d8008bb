//! Points of a branch from the solutions that were judged along it.

use dynamics::continuation::{self, PointKind};
use dynamics::{Multiplier, MultiplierKind};

use super::family::{Judged, PERIOD_DOUBLING, STABILITY};
use super::point::{BranchPoint, BranchPointKind};
use super::settings::BranchSettings;
use crate::sweep::{Steady, SteadySettings, SweepError, SweepModel, SweepPoint};

/// Located points this near to each other, as a share of the parameter, are one.
const SAME: f64 = 1e-5;

/// The same in arc length; at a fold the parameter is stationary.
const SAME_ARC: f64 = 0.1;

/// A multiplier that crosses the unit circle continuously is located nearer to it than this.
const CRITICAL: f64 = 1e-4;

/// What is kept of a solution.
pub(super) fn point(
    model: &dyn SweepModel,
    judged: &[Judged],
    own: &continuation::BranchPoint,
    settings: &BranchSettings,
    repeats_after: usize,
    size: usize,
) -> Result<BranchPoint, SweepError> {
    let is_own = |j: &&Judged| j.lambda == own.lambda && j.y == own.y;
    let found = judged.iter().rev().find(is_own);
    let found = found.ok_or(SweepError::Incomplete("motion that was judged"))?;
    let (case, damping_factor) = settings.over.at(&model.case(), own.lambda);
    let steady = Steady::periodic(
        found.record.clone(),
        repeats_after,
        found.multipliers.clone(),
        found.critical.clone(),
        found.residual,
    )?;
    let settings = SteadySettings { harmonics: settings.harmonics, ..SteadySettings::default() };
    let SweepPoint {
        state,
        multipliers,
        critical,
        between,
        lowest_force_n,
        contact_loss,
        backside_contact,
        grazing_margin,
        ..
    } = SweepPoint::new(case, &steady, &settings, size)?;
    let kind = match own.kind {
        PointKind::Regular => BranchPointKind::Regular,
        PointKind::Fold => BranchPointKind::Fold,
        PointKind::Bifurcation(test) => kind(test, &found.multipliers),
    };
    Ok(BranchPoint {
        state,
        parameter: own.lambda,
        damping_factor,
        kind,
        is_stable: own.judgement.is_stable.unwrap_or(false),
        multipliers,
        critical,
        residual: found.residual,
        between,
        arc: own.arc,
        iterations: own.iterations,
        lowest_force_n,
        contact_loss,
        backside_contact,
        grazing_margin,
    })
}

/// What a located sign change of a test function is. Where no multiplier is on the unit circle they jump across it.
fn kind(test: usize, all: &[Multiplier]) -> BranchPointKind {
    let critical = |off: &dyn Fn(&Multiplier) -> f64| {
        let nearest = all.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.filter(|m| off(m) < CRITICAL)
    };
    let found = match test {
        STABILITY => critical(&|m| (m.size() - 1.0).abs()).map(|m| match m.kind() {
            MultiplierKind::PeriodDoubling => BranchPointKind::PeriodDoubling,
            MultiplierKind::NeimarkSacker => BranchPointKind::NeimarkSacker,
            MultiplierKind::Fold => BranchPointKind::BranchPoint,
        }),
        PERIOD_DOUBLING => {
            critical(&|m| (m.re + 1.0).hypot(m.im)).map(|_| BranchPointKind::PeriodDoubling)
        }
        _ => critical(&|m| (m.re - 1.0).hypot(m.im)).map(|_| BranchPointKind::BranchPoint),
    };
    found.unwrap_or(BranchPointKind::Kink)
}

/// Keeps one point of those that several test functions locate at one place: a fold is also a zero of 1 − μ and a
/// change of stability, and at a kink all functions may jump.
pub(super) fn drop_doubles(points: &mut Vec<(BranchPoint, continuation::BranchPoint)>) {
    let located: Vec<(usize, f64, f64, BranchPointKind)> = points
        .iter()
        .enumerate()
        .filter(|(_, (p, _))| p.kind != BranchPointKind::Regular)
        .map(|(i, (p, _))| (i, p.parameter, p.arc, p.kind))
        .collect();
    let mut index = 0;
    points.retain(|(p, _)| {
        index += 1;
        let own = index - 1;
        let is_doubled = |(other, parameter, arc, kind): &(usize, f64, f64, BranchPointKind)| {
            let is_near = (parameter - p.parameter).abs() <= SAME * parameter.abs()
                && (arc - p.arc).abs() <= SAME_ARC;
            let comes_first = match (*kind, p.kind) {
                (a, b) if a == b => *other < own,
                (BranchPointKind::Fold, b) => {
                    matches!(b, BranchPointKind::BranchPoint | BranchPointKind::Kink)
                }
                (a, BranchPointKind::Kink) => a != BranchPointKind::Kink,
                _ => false,
            };
            is_near && comes_first
        };
        p.kind == BranchPointKind::Regular || !located.iter().any(is_doubled)
    });
}
