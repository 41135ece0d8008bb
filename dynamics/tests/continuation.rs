//! Branches against normal forms, closed forms and shooting by a Runge–Kutta method.

mod oscillators;

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use dynamics::continuation::{
    Branch, BranchPoint, ContinuationError, ContinuationOptions, Deflation, Direction, End,
    Evaluation, Family, JudgedBy, Judgement, PointKind, Scales, deflated_solution, trace,
    trace_both,
};
use dynamics::harmonic_balance::{
    BalanceError, BalanceOptions, FrequencyResponse, HarmonicBalance, LoadResponse,
};
use nalgebra::{DMatrix, DVector};
use oscillators::{Law, Oscillator, duffing, duffing_fold};

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
    Scales::uniform(1, 1.0, 1.0)
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

/// λ = y³ − y: folds at y = ±1/√3, λ = ∓2/(3√3); stable outside them.
#[test]
fn a_cusp_s_folds_are_found_both_ways_and_bounds_are_met() {
    let slope = |y: f64| 1.0 - 3.0 * y * y;
    let mut cusp =
        Scalar(move |y: f64, l: f64| [l + y - y * y * y, slope(y), 1.0], move |y, _| slope(y));
    let options = ContinuationOptions::within([-1.0, 1.5]);
    let branch = trace_both(&mut cusp, &[0.0], 0.0, &one(), &options).unwrap();
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

/// y (λ − y²) = 0 along y = 0: the pitchfork at λ = 0 is a bifurcation without a fold, and deflation finds the
/// other two solutions beyond it.
#[test]
fn a_pitchfork_is_located_and_its_branches_found_by_deflation() {
    let mut fork =
        Scalar(|y: f64, l: f64| [y * (l - y * y), l - 3.0 * y * y, y], |y, l| l - 3.0 * y * y);
    let options = ContinuationOptions::within([-1.0, 1.0]);
    let branch = trace(&mut fork, &[0.0], -1.0, Direction::Up, &one(), &options).unwrap();
    assert_eq!(branch.folds().count(), 0);
    let found: Vec<&BranchPoint> = branch.bifurcations().collect();
    assert!(found.len() == 1 && found[0].lambda.abs() < 1e-8, "{found:?}");
    assert_eq!(found[0].kind, PointKind::Bifurcation(0));
    let mut known = vec![vec![0.0]];
    for sign in [1.0, -1.0] {
        let deflation = Deflation::default();
        let next = deflated_solution(&mut fork, 0.25, &[0.1 * sign], &known, &one(), &deflation);
        known.push(next.unwrap());
    }
    known.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for (found, exact) in known.iter().zip([-0.5, 0.0, 0.5]) {
        assert!((found[0] - exact).abs() < 1e-9, "{known:?}");
    }
    // There are no more.
    let error = deflated_solution(&mut fork, 0.25, &[0.2], &known, &one(), &Deflation::default());
    assert!(matches!(error, Err(ContinuationError::NotConverged { .. })), "{error:?}");
}

fn response(
    problem: &HarmonicBalance<Law>,
    harmonics: usize,
    [from, to]: [f64; 2],
    scale: f64,
    steps: [f64; 2],
    guess: &[f64],
) -> Branch<BalanceError> {
    let mut family = FrequencyResponse::new(problem, harmonics).unwrap();
    let options = ContinuationOptions {
        steps,
        first_step: steps[1],
        most_points: 5000,
        ..ContinuationOptions::within([from.min(to), from.max(to)])
    };
    let balance = BalanceOptions {
        first_harmonics: harmonics,
        most_harmonics: harmonics,
        tail: 2.0,
        ..BalanceOptions::default()
    };
    let start = problem.solve(from, Some(guess), &balance).unwrap().unknowns;
    let scales = Scales::uniform(family.dimension(), scale, 1.0);
    let direction = if to > from { Direction::Up } else { Direction::Down };
    trace(&mut family, &start, from, direction, &scales, &options).unwrap()
}

/// With one harmonic the balance of Duffing's oscillator is its closed first-order form.
#[test]
fn both_folds_of_duffing_s_first_harmonic_are_the_closed_form() {
    let own = duffing(0.05, 0.3);
    let problem = own.balance(16);
    let branch = response(&problem, 1, [0.5, 3.0], 1e-3, [1e-6, 0.2], &[0.0]);
    assert_eq!(branch.ends[1], End::Bound);
    let folds: Vec<&BranchPoint> = branch.folds().collect();
    assert_eq!(folds.len(), 2);
    for fold in folds {
        let exact = duffing_fold(&own, 1e6, fold.y[1].hypot(fold.y[2]), fold.lambda);
        println!("first harmonic: fold at {} off by {:e}", fold.lambda, fold.lambda / exact - 1.0);
        assert!((fold.lambda / exact - 1.0).abs() < 1e-9);
    }
    let [upper, lower] = [branch.folds().next().unwrap(), branch.folds().nth(1).unwrap()];
    assert!(upper.lambda > 1.2 * lower.lambda);
}

/// A Jacobian entry off by 1 % moves the folds and costs iterations.
#[test]
fn a_wrong_jacobian_misses_the_folds() {
    struct Spoilt<'a>(FrequencyResponse<'a, Law>);
    impl Family for Spoilt<'_> {
        type Error = BalanceError;
        fn dimension(&self) -> usize {
            self.0.dimension()
        }
        fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, BalanceError> {
            let mut found = self.0.evaluate(y, lambda)?;
            found.jacobian[(1, 2)] *= 1.01;
            Ok(found)
        }
    }
    let own = duffing(0.05, 0.3);
    let problem = own.balance(16);
    let sound = response(&problem, 1, [0.5, 3.0], 1e-3, [1e-6, 0.2], &[0.0]);
    let mut spoilt = Spoilt(FrequencyResponse::new(&problem, 1).unwrap());
    let options = ContinuationOptions {
        steps: [1e-6, 0.2],
        first_step: 0.2,
        most_iterations: 40,
        wanted_iterations: 20,
        most_points: 5000,
        ..ContinuationOptions::within([0.5, 3.0])
    };
    let start = &sound.points[0].y;
    let scales = Scales::uniform(3, 1e-3, 1.0);
    let branch = trace(&mut spoilt, start, 0.5, Direction::Up, &scales, &options).unwrap();
    let iterations = |b: &Branch<BalanceError>| b.points.iter().map(|p| p.iterations).max();
    assert!(iterations(&branch) > iterations(&sound));
    // λ is stationary at a fold, so that its unknowns show the error in first order and λ in second.
    let both: Vec<_> = branch.folds().zip(sound.folds()).collect();
    assert_eq!(both.len(), 2);
    for (spoilt, sound) in both {
        let off = (spoilt.y[1] / sound.y[1] - 1.0).abs();
        println!(
            "spoilt fold off by {off:e}, in frequency {:e}",
            spoilt.lambda / sound.lambda - 1.0
        );
        assert!(off > 1e-5);
    }
}

/// Periodic motions of an oscillator by shooting: unknowns x, v at phase 0; fourth-order Runge–Kutta in θ = ωt, with
/// the derivatives by start and frequency integrated along.
struct Shooting {
    own: Oscillator,
    gamma: f64,
    steps: usize,
}

impl Shooting {
    /// End of a period [x, v, ∂x/∂x₀, ∂v/∂x₀, ∂x/∂v₀, ∂v/∂v₀, ∂x/∂ω, ∂v/∂ω], and x along it.
    fn period(&self, y: &[f64], omega: f64) -> ([f64; 8], Vec<f64>) {
        let o = &self.own;
        let rate = |s: &[f64; 8], theta: f64| -> [f64; 8] {
            let (x, v) = (s[0], s[1]);
            let a = (o.harmonic * theta.cos()
                - o.damping * v
                - o.stiffness * x
                - self.gamma * x * x * x)
                / o.mass;
            let (by_x, by_v) =
                (-(o.stiffness + 3.0 * self.gamma * x * x) / o.mass, -o.damping / o.mass);
            let mut out = [v / omega, a / omega, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            for k in [2, 4, 6] {
                out[k] = s[k + 1] / omega;
                out[k + 1] = (by_x * s[k] + by_v * s[k + 1]) / omega;
            }
            out[6] -= v / (omega * omega);
            out[7] -= a / (omega * omega);
            out
        };
        let h = TAU / self.steps as f64;
        let mut s = [y[0], y[1], 1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let mut along = Vec::with_capacity(self.steps);
        for step in 0..self.steps {
            along.push(s[0]);
            let theta = step as f64 * h;
            let moved = |k: &[f64; 8], part: f64| std::array::from_fn(|i| s[i] + part * k[i]);
            let k1 = rate(&s, theta);
            let k2 = rate(&moved(&k1, 0.5 * h), theta + 0.5 * h);
            let k3 = rate(&moved(&k2, 0.5 * h), theta + 0.5 * h);
            let k4 = rate(&moved(&k3, h), theta + h);
            for i in 0..8 {
                s[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        (s, along)
    }
}

impl Family for Shooting {
    type Error = Infallible;

    fn dimension(&self) -> usize {
        2
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, Infallible> {
        let (s, _) = self.period(y, lambda);
        Ok(Evaluation {
            residual: DVector::from_vec(vec![s[0] - y[0], s[1] - y[1]]),
            jacobian: DMatrix::from_row_slice(2, 2, &[s[2] - 1.0, s[4], s[3], s[5] - 1.0]),
            derivative: DVector::from_vec(vec![s[6], s[7]]),
        })
    }

    /// Stable if both multipliers are within the unit circle; 1 − trace + det passes zero where one is +1.
    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, Infallible> {
        let (s, _) = self.period(y, lambda);
        let (trace, det) = (s[2] + s[5], s[2] * s[5] - s[3] * s[4]);
        let at_one = 1.0 - trace + det;
        let is_stable = at_one > 0.0 && 1.0 + trace + det > 0.0 && det < 1.0;
        Ok(Judgement { is_stable: Some(is_stable), tests: vec![at_one] })
    }
}

/// Greatest of a value over arc length, by a parabola through the three points about it, and λ there.
fn peak<E: std::error::Error>(branch: &Branch<E>, of: impl Fn(&BranchPoint) -> f64) -> [f64; 2] {
    let points: Vec<&BranchPoint> =
        branch.points.iter().filter(|p| p.kind == PointKind::Regular).collect();
    let values: Vec<f64> = points.iter().map(|p| of(p)).collect();
    let best = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap();
    assert!(best > 0 && best + 1 < values.len());
    let at = [best - 1, best, best + 1];
    let s = at.map(|i| points[i].arc - points[best].arc);
    let parabola = |v: [f64; 3]| {
        // Newton's divided differences.
        let first = (v[1] - v[0]) / (s[1] - s[0]);
        let second = ((v[2] - v[1]) / (s[2] - s[1]) - first) / (s[2] - s[0]);
        move |x: f64| (v[0] + (x - s[0]) * (first + (x - s[1]) * second), first, second)
    };
    let value = parabola(at.map(|i| values[i]));
    let (_, first, second) = value(0.0);
    let top = 0.5 * (s[0] + s[1]) - 0.5 * first / second;
    [parabola(at.map(|i| points[i].lambda))(top).0, value(top).0]
}

#[test]
fn folds_peaks_and_stability_of_duffing_by_two_routes() {
    let own = duffing(0.05, 0.3);
    let problem = own.balance(128);
    let branch = response(&problem, 15, [0.6, 3.0], 1e-3, [1e-6, 0.03], &[0.0]);
    assert_eq!(branch.ends[1], End::Bound);
    let mut shooting = Shooting { own, gamma: 1e6, steps: 600 };
    let options = ContinuationOptions {
        steps: [1e-6, 0.03],
        first_step: 0.03,
        most_points: 5000,
        ..ContinuationOptions::within([0.6, 3.0])
    };
    let family = FrequencyResponse::new(&problem, 15).unwrap();
    let first = &branch.points[0];
    let series = family.equations(first.lambda).unwrap().series(&first.y).unwrap();
    let x = &series[0][0];
    let start = [x.value(0.0), first.lambda * x.derivative(1, 0.0)];
    let scales = Scales { unknowns: vec![1e-3, 1e-3], parameter: 1.0 };
    let shot = trace(&mut shooting, &start, 0.6, Direction::Up, &scales, &options).unwrap();
    assert_eq!(shot.ends[1], End::Bound);
    let [ours, theirs]: [Vec<f64>; 2] =
        [branch.folds().map(|p| p.lambda).collect(), shot.folds().map(|p| p.lambda).collect()];
    assert_eq!((ours.len(), theirs.len()), (2, 2), "{ours:?} {theirs:?}");
    for (a, b) in ours.iter().zip(&theirs) {
        println!("fold {a} and {b}: {:e}", a / b - 1.0);
        assert!((a / b - 1.0).abs() < 1e-7, "{a} {b}");
    }
    // A multiplier is +1 where the branch folds, to 1e-6 in frequency, and the motion between is unstable.
    let ones: Vec<f64> = shot.bifurcations().map(|p| p.lambda).collect();
    assert_eq!(ones.len(), 2);
    for (a, b) in ones.iter().zip(&theirs) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    }
    let mut folded = 0;
    for p in &shot.points {
        match p.kind {
            PointKind::Fold => folded += 1,
            PointKind::Regular => assert_eq!(p.judgement.is_stable, Some(folded != 1)),
            PointKind::Bifurcation(_) => {}
        }
    }
    // The same stability along the balanced branch, judged by the multipliers of its motions.
    let mut judged = JudgedBy {
        family: FrequencyResponse::new(&problem, 15).unwrap(),
        judge: |family: &mut FrequencyResponse<'_, Law>, y: &[f64], omega: f64| {
            let series = family.equations(omega)?.series(y)?;
            let x = &series[0][0];
            let state = [x.value(0.0), omega * x.derivative(1, 0.0)];
            let Ok(judgement) = shooting.judge(&state, omega);
            Ok(judgement)
        },
    };
    let scales = Scales::uniform(judged.dimension(), 1e-3, 1.0);
    let again = trace(&mut judged, &first.y, 0.6, Direction::Up, &scales, &options).unwrap();
    let ones: Vec<f64> = again.bifurcations().map(|p| p.lambda).collect();
    assert_eq!(ones.len(), 2);
    for (a, b) in ones.iter().zip(&theirs) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    }
    assert!(again.points.iter().any(|p| p.judgement.is_stable == Some(false)));
    let amplitude = |p: &BranchPoint| {
        let series = family.equations(p.lambda).unwrap().series(&p.y).unwrap();
        series[0][0].extremes(256)[1]
    };
    let greatest = |p: &BranchPoint| {
        let along = shooting.period(&p.y, p.lambda).1;
        let n = along.len();
        let best = (0..n).max_by(|a, b| along[*a].total_cmp(&along[*b])).unwrap();
        let (l, m, r) = (along[(best + n - 1) % n], along[best], along[(best + 1) % n]);
        m - 0.125 * (r - l).powi(2) / (r - 2.0 * m + l)
    };
    let (a, b) = (peak(&branch, amplitude), peak(&shot, greatest));
    println!("peak {a:?} and {b:?}");
    assert!((a[0] / b[0] - 1.0).abs() < 1e-4 && (a[1] / b[1] - 1.0).abs() < 1e-4, "{a:?} {b:?}");
}

/// Three motions coexist between the folds; deflation finds the others from the least.
#[test]
fn deflation_finds_the_second_stable_motion() {
    let own = duffing(0.05, 0.3);
    let problem = own.balance(64);
    let mut family = FrequencyResponse::new(&problem, 7).unwrap();
    let omega = 1.7;
    let balance = BalanceOptions { first_harmonics: 7, tail: 1e-2, ..BalanceOptions::default() };
    let first = problem.solve(omega, None, &balance).unwrap();
    let mut known = vec![first.unknowns.clone()];
    let scales = Scales::uniform(family.dimension(), 1e-3, 1.0);
    // The start points away from the least motion by its own size.
    let start: Vec<f64> = first.unknowns.iter().map(|y| -2.0 * y + 1e-4).collect();
    for _ in 0..2 {
        let deflation = Deflation::default();
        let next = deflated_solution(&mut family, omega, &start, &known, &scales, &deflation);
        known.push(next.unwrap());
    }
    let mut shooting = Shooting { own, gamma: 1e6, steps: 600 };
    let mut motions: Vec<(f64, Option<bool>)> = known
        .iter()
        .map(|y| {
            let series = family.equations(omega).unwrap().series(y).unwrap();
            let x = &series[0][0];
            let state = [x.value(0.0), omega * x.derivative(1, 0.0)];
            (x.extremes(256)[1], shooting.judge(&state, omega).unwrap().is_stable)
        })
        .collect();
    motions.sort_by(|a, b| a.0.total_cmp(&b.0));
    println!("{motions:?}");
    assert_eq!(
        motions.iter().map(|m| m.1).collect::<Vec<_>>(),
        [Some(true), Some(false), Some(true)]
    );
}

/// A spring pressed together by a growing load until contact is never lost: beyond, the motion about the mean is that
/// of the linear spring, whatever the load.
#[test]
fn a_branch_over_load_ends_in_the_linear_motion() {
    let own = Oscillator {
        mass: 1.0,
        damping: 0.2,
        stiffness: 0.01,
        lag: 0.0,
        law: Law::OneSided { stiffness: 1.0, part: 0.0, steps: 512 },
        steady: 0.0,
        harmonic: 0.5e-3,
    };
    let (problem, omega) = (own.balance(512), 1.3);
    let mut family = LoadResponse::new(&problem, omega, 20, &[1e-3]).unwrap();
    let balance = BalanceOptions {
        first_harmonics: 20,
        most_harmonics: 20,
        tail: 2.0,
        ..BalanceOptions::default()
    };
    let pressed = Oscillator { steady: 0.3e-3, ..own }.balance(512);
    let start = pressed.solve(omega, None, &balance).unwrap().unknowns;
    let options = ContinuationOptions::within([0.3, 4.0]);
    let scales = Scales::uniform(family.dimension(), 1e-3, 1.0);
    let branch = trace(&mut family, &start, 0.3, Direction::Up, &scales, &options).unwrap();
    assert_eq!(branch.ends[1], End::Bound);
    // X = f₁ / (k − ω² + iωc), mean λ f / k, with k of both springs.
    let linear = 0.5e-3 / (1.01 - omega * omega).hypot(0.2 * omega);
    let amplitude = |p: &BranchPoint| p.y[1].hypot(p.y[2]);
    for p in branch.points.iter().filter(|p| p.lambda * 1e-3 / 1.01 > 1.01 * linear) {
        assert!((amplitude(p) / linear - 1.0).abs() < 1e-10, "{}", p.lambda);
        assert!((p.y[0] / (p.lambda * 1e-3 / 1.01) - 1.0).abs() < 1e-10);
    }
    assert!((amplitude(&branch.points[0]) / linear - 1.0).abs() > 0.05);
}

/// A mass between two springs with a gap of ±b. Freely it crosses the gap at constant speed u and turns in half a sine:
///
/// ```text
/// T = 4 b/u + 2π/ω₀,   A = b + u/ω₀;   per cycle: c ∮ẋ² dt = c u (4b + π u/ω₀)
/// ```
///
/// and the forced motion lightly damped peaks on this backbone where the force, in phase with velocity, does the work
/// that damping takes: π F V₁/ω, V₁ the velocity's first harmonic. Both hold to the second order in damping.
#[test]
fn a_gap_s_peak_is_on_its_backbone() {
    let (b, u, c) = (1e-3, 2e-3, 4e-3);
    let own = |force: f64| Oscillator {
        mass: 1.0,
        damping: c,
        stiffness: 0.0,
        lag: 0.0,
        law: Law::Gap { stiffness: 1.0, half: b },
        steady: 0.0,
        harmonic: force,
    };
    let (crossing, turning) = (b / u, 0.5 * PI);
    let quarter = crossing + turning;
    let omega = TAU / (4.0 * quarter);
    // V₁ = (4/T)·2 ∫₀^{T/4} ẋ cos ωt dt from mid-gap, by Simpson's rule on both pieces.
    let simpson = |f: &dyn Fn(f64) -> f64, a: f64, h: f64| {
        let n = 2000;
        let at = |i: usize| f(a + h * i as f64 / n as f64);
        let weight = |i: usize| if i == 0 || i == n { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        (0..=n).map(|i| weight(i) * at(i)).sum::<f64>() * h / (3.0 * n as f64)
    };
    let first = simpson(&|t| u * (omega * t).cos(), 0.0, crossing)
        + simpson(&|t| u * (t - crossing).cos() * (omega * t).cos(), crossing, turning);
    let velocity = 2.0 * first / quarter;
    let force = c * u * (4.0 * b + PI * u) * omega / (PI * velocity);
    let problem = own(force).balance(4096);
    // Only a motion in contact on both sides has a mean: the branch is followed up from the backbone at ω = 0.65.
    let large = b + b / (0.5 * PI / 0.65 - 0.5 * PI);
    let branch = response(&problem, 31, [0.65, 1.0], b, [1e-7, 0.02], &[0.0, large, 0.0]);
    let family = FrequencyResponse::new(&problem, 31).unwrap();
    let amplitude = |p: &BranchPoint| {
        let series = family.equations(p.lambda).unwrap().series(&p.y).unwrap();
        series[0][0].extremes(512)[1]
    };
    let [at, height] = peak(&branch, amplitude);
    println!("gap: peak at {at} of {height:e}, backbone {omega} {:e}", b + u);
    assert!((at / omega - 1.0).abs() < 1e-4 && (height / (b + u) - 1.0).abs() < 1e-4);
    // The jump down is at the greatest frequency. Samples that cross a kink of the force one by one fold the branch
    // of the sampled equations many times on a small scale: the greatest counts.
    let jump = branch.folds().map(|p| p.lambda).fold(0.0, f64::max);
    println!("{} points, jump at {jump}", branch.points.len());
    assert!((jump / omega - 1.0).abs() < 1e-4);
    assert_eq!(branch.ends[1], End::Bound);
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
    let error = run(&mut none, &[0.3], 0.1, &Scales::uniform(1, 0.0, 1.0), &options);
    assert!(matches!(error, ContinuationError::Option { what: "a scale", .. }));
    let error = run(&mut none, &[0.3], 0.1, &Scales::uniform(2, 1.0, 1.0), &options);
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
    let branch = trace_both(&mut fold, &[0.0], 0.0, &one(), &options).unwrap();
    assert_eq!(branch.ends, [End::Bound, End::Bound]);
    let ends = [branch.points.first().unwrap().y[0], branch.points.last().unwrap().y[0]];
    assert!((ends[0] * ends[1] + 2.0).abs() < 1e-12, "{ends:?}");
}
