//! Figures of branches of periodic motions: stable parts solid, unstable ones dashed.

use experiments::branches::{Branch, BranchParameter, BranchPoint, BranchPointKind, Branches};
use experiments::sweep::{Part, Response};

use super::Figure;
use super::drawing::{Pen, Series, Symbol, chart};

/// Stable and unstable parts, with names and pens.
const STABILITIES: [(bool, &str, Pen); 2] = [
    (true, "stable", Pen::new("#0072b2", 1.6)),
    (false, "unstable", Pen::new("#d55e00", 1.6).dashed()),
];

/// A quantity whose largest amplitude is below this, in µrad or µm, is not drawn.
const NOTHING: f64 = 1e-6;

/// `branch_sun_rotation` and `branch_sun_translation` over the parameter, each in the harmonic that is the strongest
/// anywhere on the branch; one that vanishes is left out.
pub fn of_branches(found: &Branches, title: &str, harmonics: usize) -> Vec<Figure> {
    let quantities = [
        ("branch_sun_rotation", "sun rotation, µrad", Response::Rotation(Part::SUN)),
        ("branch_sun_translation", "sun translation, µm", Response::Translation(Part::SUN)),
    ];
    let figures = quantities.into_iter().filter_map(|(name, axis, response)| {
        let first = found.branches.first()?;
        let strongest = strongest(found, response, harmonics)?;
        let spot = |p: &BranchPoint| (p.parameter, 1e6 * response.amplitude(&p.state, strongest));
        let caption = format!("{}, harmonic {strongest} of the mesh frequency", first.fidelity);
        let axes = [&*axis_of(first.over), axis];
        Some(Figure::new(name, chart([title, &caption], axes, series(found, &spot))))
    });
    figures.collect()
}

/// The harmonic with the largest amplitude on any branch, if there is more than nothing.
fn strongest(found: &Branches, response: Response, harmonics: usize) -> Option<usize> {
    let points = || found.branches.iter().flat_map(|b| &b.points);
    let largest =
        |l: usize| points().map(|p| 1e6 * response.amplitude(&p.state, l)).fold(0.0, f64::max);
    let strongest = (1..=harmonics).max_by(|a, b| largest(*a).total_cmp(&largest(*b)))?;
    (largest(strongest) > NOTHING).then_some(strongest)
}

/// Parts by stability, then folds and other bifurcations.
fn series(found: &Branches, spot: &dyn Fn(&BranchPoint) -> (f64, f64)) -> Vec<Series> {
    let parts: Vec<_> = found.branches.iter().flat_map(|b| parts(b, spot)).collect();
    let mut series = Vec::new();
    for (stability, name, pen) in STABILITIES {
        let alike = parts.iter().filter(|(is_stable, _)| *is_stable == stability);
        series.extend(alike.enumerate().map(|(i, (_, points))| {
            Series::new(if i == 0 { name } else { "" }, pen, points.iter().copied())
        }));
    }
    let points = || found.branches.iter().flat_map(|b| &b.points);
    let is_fold = |p: &&BranchPoint| p.kind == BranchPointKind::Fold;
    let is_other = |p: &&BranchPoint| !is_fold(p) && p.kind != BranchPointKind::Regular;
    let disc = |colour| Symbol::Disc(4.0, colour);
    series.push(Series::new("fold", disc("#000000"), points().filter(is_fold).map(spot)));
    let others = points().filter(is_other).map(spot);
    series.push(Series::new("other bifurcation", disc("#009e73"), others));
    series.retain(|s| !s.points.is_empty());
    series
}

/// Name and unit of what is varied.
fn axis_of(over: BranchParameter) -> String {
    match over.plain_unit() {
        "" => over.name().to_owned(),
        unit => format!("{}, {unit}", over.name()),
    }
}

/// Points of each part of one stability, which ends where the next begins, with whether it is stable.
fn parts(
    branch: &Branch,
    spot: &dyn Fn(&BranchPoint) -> (f64, f64),
) -> Vec<(bool, Vec<(f64, f64)>)> {
    // A located point stands between parts: the stability of a stretch is that of its regular end.
    let stability = |pair: &[BranchPoint]| match pair[1].kind {
        BranchPointKind::Regular => pair[1].is_stable,
        _ => pair[0].is_stable,
    };
    let stretches: Vec<&[BranchPoint]> = branch.points.windows(2).collect();
    let alike = stretches.chunk_by(|a, b| stability(a) == stability(b));
    let part = |stretches: &[&[BranchPoint]]| {
        let ends = stretches.iter().map(|pair| spot(&pair[1]));
        let points = std::iter::once(spot(&stretches[0][0])).chain(ends).collect();
        (stability(stretches[0]), points)
    };
    alike.map(part).collect()
}

#[cfg(test)]
mod tests {
    use experiments::branches::{BranchEnd, BranchOrigin};
    use experiments::sweep::SteadyState;
    use scene::LoadCase;

    use super::*;

    #[test]
    fn parts_end_where_stability_changes() {
        let point = |rpm: f64, kind, is_stable| BranchPoint {
            state: SteadyState { case: LoadCase::turning(50.0, rpm, rpm), lines: Vec::new() },
            parameter: rpm,
            damping_factor: 1.0,
            kind,
            is_stable,
            multipliers: Vec::new(),
            critical: None,
            between: None,
            residual: 0.0,
            arc: rpm,
            iterations: 3,
            lowest_force_n: 0.0,
            contact_loss: 0.0,
            backside_contact: None,
            grazing_margin: None,
        };
        use BranchPointKind::{Fold, Regular};
        let points = vec![
            point(1.0, Regular, true),
            point(2.0, Regular, true),
            point(3.0, Fold, false),
            point(2.5, Regular, false),
            point(2.0, Fold, true),
            point(2.5, Regular, true),
        ];
        let ends = [BranchEnd::Bound, BranchEnd::Bound];
        let (over, origin) = (BranchParameter::Speed, BranchOrigin::Start(1.0));
        let fidelity = "mesh-law".into();
        let branch = Branch { fidelity, over, origin, repeats_after: 1, points, ends };
        let found = parts(&branch, &|p| (p.state.case.speed_rpm, 0.0));
        let speeds: Vec<Vec<f64>> =
            found.iter().map(|(_, points)| points.iter().map(|p| p.0).collect()).collect();
        assert_eq!(speeds, [vec![1.0, 2.0, 3.0], vec![3.0, 2.5, 2.0], vec![2.0, 2.5]]);
    }
}
