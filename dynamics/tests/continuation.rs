//! Branches of normal forms with known folds and bifurcations, and what cannot be followed.

use std::convert::Infallible;
use std::f64::consts::TAU;

use dynamics::continuation::{
    BranchPoint, ContinuationError, ContinuationOptions, Direction, End, Evaluation, Family,
    Judgement, PointKind, Scales, Unkept, branch_off, trace, trace_both,
};
use nalgebra::{DMatrix, DVector};

/// f(y, λ) of one unknown with its derivatives, and a test function.
struct Scalar<F, T>(F, T);

impl<F: Fn(f64, f64) -> [f64; 3], T: Fn(f64, f64) -> f64> Family for Scalar<F, T> {
    type Error = Infallible;

    fn dimension(&self) -> usize {
        1
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, Infallible> {
        let [f, by_y, by_lambda] = (self.0)(y[0], lambda);
        Ok(Evaluation {
            residual: DVector::from_element(1, f),
            jacobian: DMatrix::from_element(1, 1, by_y),
            derivative: DVector::from_element(1, by_lambda),
        })
    }

    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, Infallible> {
        let test = (self.1)(y[0], lambda);
        Ok(Judgement { is_stable: Some(test < 0.0), tests: vec![test] })
    }
}

fn one() -> Scales {
    Scales { unknowns: vec![1.0], parameter: 1.0 }
}

#[test]
fn a_circle_closes_and_has_two_folds() {
    let mut circle = Scalar(|y: f64, l: f64| [y * y + l * l - 1.0, 2.0 * y, 2.0 * l], |_, _| -1.0);
    let options = ContinuationOptions::within([-2.0, 2.0]);
    let branch = trace(&mut circle, &[0.8], 0.6, Direction::Up, &one(), &options).unwrap();
    assert_eq!(branch.ends, [End::Start, End::Closed]);
    let folds: Vec<f64> = branch.folds().map(|p| p.lambda).collect();
    assert_eq!(folds.len(), 2);
    assert!((folds[0] - 1.0).abs() < 1e-12 && (folds[1] + 1.0).abs() < 1e-12, "{folds:?}");
    assert!(branch.folds().all(|p| p.y[0].abs() < 1e-4));
    assert!(branch.points.iter().all(|p| p.judgement.is_stable == Some(true)));
    // Points are on the circle and in order along it, folds among them.
    for pair in branch.points.windows(2) {
        assert!((pair[1].y[0].hypot(pair[1].lambda) - 1.0).abs() < 1e-12);
        assert!(pair[1].arc > pair[0].arc);
    }
    let whole = branch.points.last().unwrap().arc;
    assert!(whole > 0.98 * TAU && whole < TAU + 0.5, "{whole}");
}

/// λ = 0.05 (y³ − 3a²y)/(2a³), a = 0.03: folds at λ = ∓0.05. The tangents before the first and beyond the second are
/// parallel, and the sense of the branch is the same again: only the chord tells that a long step would skip both.
#[test]
fn two_folds_near_each_other_are_not_skipped() {
    let a: f64 = 0.03;
    let k = 0.05 / (2.0 * a * a * a);
    let slope = move |y: f64| 3.0 * k * (y * y - a * a);
    let f = move |y: f64, l: f64| [k * (y * y * y - 3.0 * a * a * y) - l, slope(y), -1.0];
    for first_step in [0.01, 0.05, 0.13, 0.2, 0.34, 0.5] {
        let mut narrow = Scalar(f, move |y, _| -slope(y));
        let options =
            ContinuationOptions { first_step, ..ContinuationOptions::within([-1.0, 1.0]) };
        let branch = trace(&mut narrow, &[0.2], 1.0, Direction::Down, &one(), &options).unwrap();
        let folds: Vec<f64> = branch.folds().map(|p| p.lambda).collect();
        assert_eq!(folds.len(), 2, "first step {first_step}");
        assert!((folds[0] + 0.05).abs() < 1e-9 && (folds[1] - 0.05).abs() < 1e-9, "{folds:?}");
        assert_eq!(branch.ends[1], End::Bound);
    }
}

/// Rounding of F above the tolerance of corrections, as over very many time steps: steps stay long.
#[test]
fn rounding_does_not_shorten_steps() {
    let rough = |y: f64, l: f64| {
        let slope = l.cosh().powi(-2);
        [y - l.tanh() + 5e-10 * (1e12 * (y + 1.7 * l)).sin(), 1.0, -slope]
    };
    let mut rough = Scalar(rough, |_, _| -1.0);
    let options = ContinuationOptions::within([-2.0, 2.0]);
    let branch =
        trace(&mut rough, &[(-2f64).tanh()], -2.0, Direction::Up, &one(), &options).unwrap();
    assert_eq!(branch.ends[1], End::Bound);
    assert!(branch.points.len() < 40, "{}", branch.points.len());
    assert!(branch.points.iter().all(|p| (p.y[0] - p.lambda.tanh()).abs() < 1e-8));
}

/// Two branches side by side, w = 0 and w = δ with w = y − A tanh(kλ). Beyond a bend the long step along the tangent
/// ends nearer to the other branch, of the other sign of ∂F/∂w: steps are shortened until the branch followed is the
/// one started on.
#[test]
fn a_step_that_leads_to_a_neighbouring_branch_is_shortened() {
    let (a, k, delta) = (0.5, 6.0, 0.02);
    let w = move |y: f64, l: f64| y - a * (k * l).tanh();
    let slope = move |l: f64| -a * k / (k * l).cosh().powi(2);
    let f = move |y: f64, l: f64| {
        let w = w(y, l);
        [w * (w - delta), 2.0 * w - delta, (2.0 * w - delta) * slope(l)]
    };
    let mut pair = Scalar(f, |_, _| -1.0);
    // The first step ends at w > δ: of the two roots Newton's method then finds δ.
    let options = ContinuationOptions {
        first_step: 0.3,
        steps: [1e-6, 0.3],
        most_turn: 1.5,
        ..ContinuationOptions::within([0.0, 1.0])
    };
    let start = a * (k * 0.05).tanh();
    let branch = trace(&mut pair, &[start], 0.05, Direction::Up, &one(), &options).unwrap();
    assert_eq!(branch.ends[1], End::Bound);
    assert!(branch.points.len() > 2);
    for point in &branch.points {
        assert!(w(point.y[0], point.lambda).abs() < 1e-9, "{point:?}");
    }
}

/// λ = y³ − y: folds at y = ±1/√3, λ = ∓2/(3√3); stable outside them.
#[test]
fn a_cusp_s_folds_are_found_both_ways_and_bounds_are_met() {
    let slope = |y: f64| 1.0 - 3.0 * y * y;
    let mut cusp =
        Scalar(move |y: f64, l: f64| [l + y - y * y * y, slope(y), 1.0], move |y, _| slope(y));
    let options = ContinuationOptions::within([-1.0, 1.5]);
    let branch = trace_both(&mut cusp, (&[0.0], 0.0), &one(), &options, &mut Unkept).unwrap();
    assert_eq!(branch.ends, [End::Bound, End::Bound]);
    let ends = [branch.points.first().unwrap().lambda, branch.points.last().unwrap().lambda];
    // From the middle λ falls towards y > 0, turns, and rises to the upper bound.
    assert!(
        ends.iter().any(|l| (l - 1.5).abs() < 1e-12)
            && ends.iter().any(|l| (l + 1.0).abs() < 1e-12)
    );
    let mut folds: Vec<f64> = branch.folds().map(|p| p.lambda).collect();
    folds.sort_by(f64::total_cmp);
    let exact = 2.0 / (3.0 * 3f64.sqrt());
    assert!(
        folds.len() == 2 && (folds[0] + exact).abs() < 1e-12 && (folds[1] - exact).abs() < 1e-12
    );
    // The slope as a test function finds the same points, located by its own sign.
    let tested: Vec<&BranchPoint> = branch.bifurcations().collect();
    assert!(tested.len() == 2 && tested.iter().all(|p| (p.lambda.abs() - exact).abs() < 1e-12));
    for p in branch.points.iter().filter(|p| p.kind == PointKind::Regular) {
        assert_eq!(p.judgement.is_stable, Some(p.y[0].abs() > 1.0 / 3f64.sqrt()));
    }
}

/// y (λ − y²) = 0 along y = 0: the pitchfork at λ = 0 is a bifurcation without a fold.
#[test]
fn a_pitchfork_is_located() {
    let mut fork =
        Scalar(|y: f64, l: f64| [y * (l - y * y), l - 3.0 * y * y, y], |y, l| l - 3.0 * y * y);
    let options = ContinuationOptions::within([-1.0, 1.0]);
    let branch = trace(&mut fork, &[0.0], -1.0, Direction::Up, &one(), &options).unwrap();
    assert_eq!(branch.folds().count(), 0);
    let found: Vec<&BranchPoint> = branch.bifurcations().collect();
    assert!(found.len() == 1 && found[0].lambda.abs() < 1e-8, "{found:?}");
    assert_eq!(found[0].kind, PointKind::Bifurcation(0));
}

#[test]
fn what_cannot_be_followed_is_named() {
    let mut none = Scalar(|y: f64, l: f64| [y * y + l * l + 1.0, 2.0 * y, 2.0 * l], |_, _| 1.0);
    let options = ContinuationOptions::within([-2.0, 2.0]);
    let run = |family: &mut Scalar<_, _>, y: &[f64], l, scales: &Scales, options: &_| {
        trace(family, y, l, Direction::Up, scales, options).unwrap_err()
    };
    let error = run(&mut none, &[0.3], 0.1, &one(), &options);
    assert!(matches!(error, ContinuationError::NotConverged { .. }), "{error}");
    let error = run(&mut none, &[0.3, 0.1], 0.1, &one(), &options);
    assert!(matches!(error, ContinuationError::Size { got: 2, wanted: 1, .. }));
    let error = run(&mut none, &[0.3], 3.0, &one(), &options);
    assert!(matches!(error, ContinuationError::Option { .. }), "{error}");
    let error = run(&mut none, &[0.3], 0.1, &Scales { unknowns: vec![0.0], ..one() }, &options);
    assert!(matches!(error, ContinuationError::Option { what: "a scale", .. }));
    let error = run(&mut none, &[0.3], 0.1, &Scales { unknowns: vec![1.0; 2], ..one() }, &options);
    assert!(matches!(error, ContinuationError::Size { .. }));
    let upside_down = ContinuationOptions::within([1.0, -1.0]);
    let error = run(&mut none, &[0.3], 0.1, &one(), &upside_down);
    assert!(matches!(error, ContinuationError::Option { .. }));
    // A branch that ends in nothing keeps its points: y = √λ stops at a pole of its derivative.
    let mut log = Scalar(|y: f64, l: f64| [y - l.ln(), 1.0, -1.0 / l], |_, _| 1.0);
    let branch = trace(&mut log, &[0.0], 1.0, Direction::Down, &one(), &options).unwrap();
    assert!(branch.points.len() > 10 && branch.points.iter().all(|p| p.lambda > 0.0));
    // A start at a fold is a start.
    let mut fold = Scalar(|y: f64, l: f64| [y * y + l, 2.0 * y, 1.0], |_, _| 1.0);
    let branch = trace_both(&mut fold, (&[0.0], 0.0), &one(), &options, &mut Unkept).unwrap();
    assert_eq!(branch.ends, [End::Bound, End::Bound]);
    let ends = [branch.points.first().unwrap().y[0], branch.points.last().unwrap().y[0]];
    assert!((ends[0] * ends[1] + 2.0).abs() < 1e-12, "{ends:?}");
}

/// |y| + λ − 1 = 0 in coordinates scaled so that both halves are almost parallel: the branch turns back at the kink
/// (0, 1) by more than a right angle.
#[test]
fn a_branch_goes_on_beyond_a_kink_at_which_it_turns_back() {
    for slope in [0.3, 1.0, 3.0, 30.0] {
        let mut tent = Scalar(
            |y: f64, l: f64| [slope * y.abs() + l - 1.0, slope * y.signum(), 1.0],
            |_, _| -1.0,
        );
        let options = ContinuationOptions::within([-2.0, 2.0]);
        let branch =
            trace_both(&mut tent, (&[0.5 / slope], 0.5), &one(), &options, &mut Unkept).unwrap();
        assert_eq!(branch.ends, [End::Bound, End::Bound], "{slope}");
        let ends = [0, branch.points.len() - 1].map(|i| &branch.points[i]);
        assert!(ends.iter().all(|p| (p.lambda + 2.0).abs() < 1e-12));
        assert!((ends[0].y[0] * ends[1].y[0] + 9.0 / slope / slope).abs() < 1e-9, "{slope}");
        let folds: Vec<f64> = branch.folds().map(|p| p.lambda).collect();
        println!("{slope}: {} points, folds {folds:?}", branch.points.len());
        assert_eq!(folds.len(), 1);
        assert!((folds[0] - 1.0).abs() < 1e-5, "{folds:?}");
    }
}

/// y (λ − y²) = 0: at λ = 0 the branch y = 0 loses its stability, and y = ±√λ branch off.
#[test]
fn both_sides_of_a_pitchfork_are_followed_off_its_branch_point() {
    let mut fork = Scalar(|y: f64, l: f64| [y * (l - y * y), l - 3.0 * y * y, y], |_, l| l);
    let options = ContinuationOptions::within([-1.0, 1.0]);
    let trunk = trace_both(&mut fork, (&[0.0], -0.5), &one(), &options, &mut Unkept).unwrap();
    let found: Vec<BranchPoint> = trunk.bifurcations().cloned().collect();
    assert_eq!(found.len(), 1);
    for side in [1.0, -1.0] {
        let branch =
            branch_off(&mut fork, (&found[0], &[side]), &one(), &options, &mut Unkept).unwrap();
        assert_eq!(branch.ends, [End::Start, End::Bound]);
        assert!(branch.points.len() > 3);
        for p in &branch.points {
            assert!((p.y[0] - side * p.lambda.sqrt()).abs() < 1e-9 && p.lambda > 0.0);
        }
        assert!((branch.points[branch.points.len() - 1].lambda - 1.0).abs() < 1e-12);
    }
    // Along the branch itself there is no direction off it; and sizes are checked.
    let error =
        branch_off(&mut fork, (&found[0], &[0.0]), &one(), &options, &mut Unkept).unwrap_err();
    assert!(matches!(error, ContinuationError::NoTangent { .. }), "{error}");
    let error =
        branch_off(&mut fork, (&found[0], &[1.0, 2.0]), &one(), &options, &mut Unkept).unwrap_err();
    assert!(matches!(error, ContinuationError::Size { .. }), "{error}");
}
