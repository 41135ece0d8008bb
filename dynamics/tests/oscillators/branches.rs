//! Branches of oscillators by harmonic balance against closed forms and against shooting by a Runge–Kutta method.

use std::f64::consts::{PI, TAU};

use super::families::{FrequencyResponse, JudgedBy, LoadResponse};
use super::oscillator::{Law, Oscillator, duffing, duffing_fold};
use super::shooting::Shooting;
use dynamics::continuation::{
    Branch, BranchPoint, ContinuationOptions, Direction, End, Evaluation, Family, PointKind,
    Scales, trace,
};
use dynamics::harmonic_balance::{BalanceError, BalanceOptions, HarmonicBalance};

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
    let scales = Scales { unknowns: vec![scale; family.dimension()], parameter: 1.0 };
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
    let scales = Scales { unknowns: vec![1e-3; 3], parameter: 1.0 };
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
    let scales = Scales { unknowns: vec![1e-3; judged.dimension()], parameter: 1.0 };
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
    let scales = Scales { unknowns: vec![1e-3; family.dimension()], parameter: 1.0 };
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
