//! Folds and bifurcations between two points of a branch.

use super::branch::PointKind;
use super::error::ContinuationError;
use super::family::{Family, Judgement};
use super::space::{Corrected, Space, Stop, dot, norm};

/// Most evaluations of a test function for one point.
const MOST_TRIES: usize = 60;

/// Share of the bracket by which a try that fails is moved.
const BESIDE: f64 = 1e-4;

/// A point and what the family says of it.
pub(super) struct Judged {
    pub(super) at: Corrected,
    pub(super) judgement: Judgement,
}

/// Value of the function whose sign change makes a point of this kind.
pub(super) fn value(kind: PointKind, point: &Judged) -> f64 {
    match kind {
        PointKind::Fold => point.at.tangent.last().copied().unwrap_or(f64::NAN),
        PointKind::Bifurcation(i) => point.judgement.tests.get(i).copied().unwrap_or(f64::NAN),
        PointKind::Regular => f64::NAN,
    }
}

/// Kinds of points between two neighbours, from the signs at both.
pub(super) fn crossed(from: &Judged, to: &Judged) -> Vec<PointKind> {
    let tests = from.judgement.tests.len().min(to.judgement.tests.len());
    let kinds = (0..tests).map(PointKind::Bifurcation);
    let all = std::iter::once(PointKind::Fold).chain(kinds);
    all.filter(|kind| value(*kind, from) * value(*kind, to) < 0.0).collect()
}

/// Locates a point of a kind between two neighbours: regula falsi with the Illinois rule in the arc from the first,
/// with a bisection wherever it reduces the bracket by less than half in three tries.
///
/// Returns the point and its distance along the tangent of `from`.
pub(super) fn locate<F: Family>(
    space: &mut Space<'_, F>,
    (from, to): (&Judged, &Judged),
    kind: PointKind,
    share: f64,
    stop: Stop,
) -> Result<(Judged, f64), ContinuationError<F::Error>> {
    let t = &from.at.tangent;
    let whole: Vec<f64> = to.at.u.iter().zip(&from.at.u).map(|(b, a)| b - a).collect();
    let (mut a, mut b) = ((0.0, value(kind, from)), (dot(&whole, t), value(kind, to)));
    let ends = [a, b];
    let mut best: Option<(Judged, f64)> = None;
    let mut width = (b.0 - a.0).abs();
    for attempt in 1..=MOST_TRIES {
        let mut h = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        if attempt % 3 == 0 {
            let now = (b.0 - a.0).abs();
            if now > 0.5 * width {
                h = 0.5 * (a.0 + b.0);
            }
            width = now;
        }
        if !h.is_finite() {
            h = 0.5 * (a.0 + b.0);
        }
        // From a linear blend of both neighbours, in the hyperplane at distance h. At a branch point itself the
        // matrix is singular: then from close by.
        let blend = |h: f64| -> Vec<f64> {
            let part = h / ends[1].0;
            from.at.u.iter().zip(&whole).map(|(u, w)| u + part * w).collect()
        };
        let at = match space.correct(&blend(h), t, stop) {
            Ok(at) => at,
            Err(_) => {
                h += BESIDE * (b.0 - a.0);
                space.correct(&blend(h), t, stop)?
            }
        };
        let (y, lambda) = space.plain(&at.u);
        let judged = match kind {
            PointKind::Fold => Judgement::default(),
            _ => space
                .family
                .judge(&y, lambda)
                .map_err(|cause| ContinuationError::Family { lambda, cause })?,
        };
        let judged = Judged { at, judgement: judged };
        let found = value(kind, &judged);
        // λ is stationary at a fold: the change along the arc says more.
        let moved = best.as_ref().map_or(f64::INFINITY, |(_, last)| (h - last).abs());
        let is_there = moved <= share * norm(&judged.at.u).max(1.0);
        best = Some((judged, h));
        if found == 0.0 || is_there {
            break;
        }
        if found * b.1 < 0.0 {
            a = b;
        } else {
            // Illinois: the value at the end that stays is halved.
            a.1 *= 0.5;
        }
        b = (h, found);
    }
    let (mut point, h) = best.ok_or(ContinuationError::NotConverged {
        lambda: space.lambda(&from.at.u),
        iterations: MOST_TRIES,
        correction: f64::NAN,
    })?;
    if kind == PointKind::Fold {
        let (y, lambda) = space.plain(&point.at.u);
        point.judgement = space
            .family
            .judge(&y, lambda)
            .map_err(|cause| ContinuationError::Family { lambda, cause })?;
    }
    Ok((point, h))
}
