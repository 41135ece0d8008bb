//! Figures of branches of periodic motions: stable parts solid, unstable ones dashed.

use experiments::branches::{Branch, BranchParameter, BranchPoint, BranchPointKind, Branches};
use experiments::sweep::{Part, Response, SteadyState};

use super::Figure;
use super::drawing::{Curve, Labels, chart};

/// Colours of stable and unstable parts, of folds and of other bifurcations.
const STABLE: &str = "#0072b2";
const UNSTABLE: &str = "#d55e00";
const FOLD: &str = "#000000";
const OTHER: &str = "#009e73";

/// A quantity with what it is called in files and on the axis.
type Quantity = (&'static str, &'static str, fn(&SteadyState, usize) -> f64);

const QUANTITIES: [Quantity; 2] = [
    ("branch_sun_rotation", "sun rotation, µrad", |state, harmonic| {
        1e6 * Response::Rotation(Part::Sun).amplitude(state, harmonic)
    }),
    ("branch_sun_translation", "sun translation, µm", |state, harmonic| {
        1e6 * Response::Translation(Part::Sun).amplitude(state, harmonic)
    }),
];

/// A quantity whose largest amplitude is below this, in µrad or µm, is not drawn.
const NOTHING: f64 = 1e-6;

/// `branch_sun_rotation` and `branch_sun_translation` over the parameter, each in the harmonic that is the strongest
/// anywhere on the branch; one that vanishes is left out.
pub fn of_branches(found: &Branches, title: &str, harmonics: usize) -> Vec<Figure> {
    let Some(first) = found.branches.first() else { return Vec::new() };
    let points = || found.branches.iter().flat_map(|b| &b.points);
    let all = QUANTITIES.iter().filter_map(|(name, axis, of)| {
        let largest = |l: usize| points().map(|p| of(&p.state, l)).fold(0.0, f64::max);
        let strongest = (1..=harmonics).max_by(|a, b| largest(*a).total_cmp(&largest(*b)))?;
        if largest(strongest) <= NOTHING {
            return None;
        }
        let spot = |p: &BranchPoint| (p.parameter, of(&p.state, strongest));
        let mut is_named = [false; 2];
        let mut curves: Vec<Curve> =
            found.branches.iter().flat_map(|b| parts(b, &spot, &mut is_named)).collect();
        let dots = |kinds: &dyn Fn(BranchPointKind) -> bool| -> Vec<(f64, f64)> {
            points().filter(|p| kinds(p.kind)).map(spot).collect()
        };
        let is_other = |k| !matches!(k, BranchPointKind::Regular | BranchPointKind::Fold);
        for (name, points, colour) in [
            ("fold", dots(&|k| k == BranchPointKind::Fold), FOLD),
            ("other bifurcation", dots(&is_other), OTHER),
        ] {
            if !points.is_empty() {
                curves.push(Curve::new(name, points).dots(4.0, colour));
            }
        }
        let labels = Labels {
            title,
            subtitle: format!("{}, harmonic {strongest} of the mesh frequency", first.fidelity),
            x: &axis_of(first.over),
            y: axis,
        };
        Some(Figure::new(*name, chart(&labels, &curves)))
    });
    all.collect()
}

/// Name and unit of what is varied.
fn axis_of(over: BranchParameter) -> String {
    match over.plain_unit() {
        "" => over.name().to_owned(),
        unit => format!("{}, {unit}", over.name()),
    }
}

/// Parts of one stability, each ending where the next begins.
/// `is_named`: whether unstable and stable parts are in the legend already.
fn parts(
    branch: &Branch,
    spot: &dyn Fn(&BranchPoint) -> (f64, f64),
    is_named: &mut [bool; 2],
) -> Vec<Curve> {
    let mut curves = Vec::new();
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (i, pair) in branch.points.windows(2).enumerate() {
        if points.is_empty() {
            points.push(spot(&pair[0]));
        }
        points.push(spot(&pair[1]));
        // A located point stands between parts: the stability of a stretch is that of its regular end.
        let of = |pair: &[BranchPoint]| match pair[1].kind {
            BranchPointKind::Regular => pair[1].is_stable,
            _ => pair[0].is_stable,
        };
        let is_stable = of(pair);
        let next = branch.points.get(i + 1..i + 3).map(of);
        if next == Some(is_stable) {
            continue;
        }
        let own = std::mem::take(&mut points);
        let was_named = std::mem::replace(&mut is_named[usize::from(is_stable)], true);
        curves.push(match (is_stable, was_named) {
            (true, false) => Curve::new("stable", own).thin(STABLE).wide(1.6),
            (true, true) => Curve::new("", own).thin(STABLE).wide(1.6),
            (false, false) => Curve::new("unstable", own).thin(UNSTABLE).dashed().wide(1.6),
            (false, true) => Curve::new("", own).thin(UNSTABLE).dashed().wide(1.6),
        });
    }
    curves
}

#[cfg(test)]
mod tests {
    use experiments::branches::{BranchEnd, BranchOrigin};
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
        let found = parts(&branch, &|p| (p.state.case.speed_rpm, 0.0), &mut [false; 2]);
        let speeds: Vec<Vec<f64>> =
            found.iter().map(|c| c.points.iter().map(|p| p.0).collect()).collect();
        assert_eq!(speeds, [vec![1.0, 2.0, 3.0], vec![3.0, 2.5, 2.0], vec![2.0, 2.5]]);
    }
}
