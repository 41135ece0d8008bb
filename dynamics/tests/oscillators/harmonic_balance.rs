//! Harmonic balance against closed forms and against marching extrapolated in the step.

use std::f64::consts::TAU;

use super::oscillator::{Law, Oscillator, duffing};
use dynamics::harmonic_balance::{BalanceError, BalanceOptions, HarmonicBalance};
use dynamics::{Coupling, CouplingForce, LinearPart, c64};
use nalgebra::DMatrix;

/// Largest difference over the largest vibration.
fn off(found: &dynamics::harmonic_balance::FourierSeries, samples: &[f64]) -> f64 {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let size = samples.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
    let at = |(s, x): (usize, &f64)| (found.value(TAU * s as f64 / n) - x).abs() / size;
    samples.iter().enumerate().map(at).fold(0.0, f64::max)
}

/// X = f₁ / (k + k_c (1 + iωτ) − ω²m + iωc), whether the spring is in the linear part or a coupling.
#[test]
fn a_linear_oscillator_is_the_closed_form() {
    let law = Law::Linear { stiffness: 3e7 };
    let own = Oscillator {
        mass: 0.7,
        damping: 90.0,
        stiffness: 1e7,
        lag: 4e-6,
        law,
        steady: 500.0,
        harmonic: 200.0,
    };
    let problem = own.balance(40);
    for omega in [500.0, 7559.0, 2e4] {
        let found = problem.solve(omega, None, &BalanceOptions::default()).unwrap();
        let spring = c64::new(1.0, omega * own.lag) * 3e7;
        let z = spring + c64::new(1e7 - omega * omega * 0.7, omega * 90.0);
        let exact = c64::new(200.0, 0.0) / z;
        let x = &found.coordinates[0].lines;
        assert!((x[1] - exact).norm() < 1e-12 * exact.norm(), "{omega}: {} {exact}", x[1]);
        assert!((x[0].re - 500.0 / 4e7).abs() < 1e-12 * 500.0 / 4e7);
        assert!(
            (found.forces[0].lines[1] - exact * spring).norm() < 1e-12 * (exact * spring).norm()
        );
        assert!(x[2..].iter().all(|x| x.norm() < 1e-14 * exact.norm()));
        // The balance of forces at any phase.
        let motion = found.motion(0.9);
        let [x, v, a] = [motion.x[0], motion.v[0], motion.a[0]];
        let held = 0.7 * a + 90.0 * v + 1e7 * x + 3e7 * (x + own.lag * v);
        assert!((held - 500.0 - 200.0 * 0.9f64.cos()).abs() < 1e-9);
        assert!(found.residual < 1e-11 && found.iterations <= 3, "{found:?}");
    }
}

/// First-order backbone ω² = ω₀² + ¾ γ A²/m (Nayfeh & Mook, Nonlinear Oscillations, 1979, § 4.1): at phase resonance,
/// where the response lags 90°, to the second order in γA².
#[test]
fn duffing_s_backbone_is_reached_as_amplitude_falls() {
    let gap = |force: f64| {
        let problem = duffing(0.01, force).balance(64);
        // Bisection for the frequency at which the first harmonic lags 90°.
        let mut range = [0.9, 1.3];
        let mut start: Option<Vec<f64>> = None;
        let mut amplitude = 0.0;
        for _ in 0..40 {
            let omega = 0.5 * (range[0] + range[1]);
            let found = problem.solve(omega, None, &BalanceOptions::default()).unwrap();
            let x = found.coordinates[0].lines[1];
            if x.re > 0.0 {
                range[0] = omega
            } else {
                range[1] = omega
            }
            (start, amplitude) = (Some(found.unknowns), x.norm());
        }
        assert!(start.is_some());
        let bend = 0.75 * 1e6 * amplitude * amplitude;
        (range[0] * range[0] - 1.0 - bend, bend)
    };
    let ((large, a), (small, b)) = (gap(2e-3), gap(1e-3));
    assert!(b < 0.3 * a && small.abs() < 0.01 * b, "{large:e} {a} {small:e} {b}");
    let order = (large / small).abs().log2() / (a / b).log2();
    assert!((order - 2.0).abs() < 0.1, "{order}");
}

#[test]
fn duffing_is_that_of_marching_extrapolated_in_the_step() {
    for (zeta, force, omega) in [(0.05, 0.3, 1.2), (0.05, 0.3, 0.4), (0.1, 1.0, 1.8)] {
        let own = duffing(zeta, force);
        let found = own.balance(256).solve(omega, None, &BalanceOptions::default()).unwrap();
        let x = &found.coordinates[0];
        let start = [x.value(0.0), omega * x.derivative(1, 0.0)];
        let marched = own.extrapolated(omega, 1024, 120, start);
        let difference = off(x, &marched);
        println!(
            "duffing ω {omega}: H {} iterations {} {difference:e}",
            found.harmonics, found.iterations
        );
        assert!(difference < 1e-5, "{omega}: {difference:e}");
        // The cubic spring's own contribution is not small, so that the comparison is one of nonlinear motions.
        assert!(x.lines[3].norm() > 1e-3 * x.lines[1].norm());
    }
}

/// Gap oscillator, and a pressed one-sided spring of varying stiffness that loses contact.
#[test]
fn clearance_is_that_of_marching_extrapolated_in_the_step() {
    let gap = Oscillator {
        mass: 1.0,
        damping: 0.1,
        stiffness: 0.0,
        lag: 0.0,
        law: Law::Gap { stiffness: 1.0, half: 1e-3 },
        steady: 0.3e-3,
        harmonic: 0.5e-3,
    };
    let mesh = Oscillator {
        law: Law::OneSided { stiffness: 1.0, part: 0.3, steps: 1024 },
        lag: 0.1,
        damping: 0.02,
        steady: 1e-3,
        harmonic: 0.0,
        ..gap
    };
    let options = BalanceOptions { tail: 1e-5, ..BalanceOptions::default() };
    for (name, own, omega) in [("gap", gap, 0.6), ("mesh", mesh, 0.9)] {
        // Inside its gap the mass is held by nothing: the start is outside.
        let start = [2e-3];
        let found = own.balance(1024).solve(omega, Some(&start), &options).unwrap();
        let x = &found.coordinates[0];
        let start = [x.value(0.0), omega * x.derivative(1, 0.0)];
        let marched = own.extrapolated(omega, 2048, 150, start);
        let difference = off(x, &marched);
        println!("{name}: H {} iterations {} {difference:e}", found.harmonics, found.iterations);
        assert!(difference < 1e-3, "{name}: {difference:e}");
        // Contact is lost, and made.
        let [least, greatest] = x.extremes(512);
        let limit = if name == "gap" { 1e-3 } else { 0.0 };
        assert!(least < limit && greatest > limit, "{least} {greatest}");
    }
}

/// Three coordinates, of which one is held by couplings alone, unsymmetric damping, offsets and lags.
fn chain(steps: usize) -> (LinearPart, Vec<Coupling>, Law) {
    let mut stiffness = DMatrix::zeros(3, 3);
    (stiffness[(0, 0)], stiffness[(1, 1)], stiffness[(0, 1)], stiffness[(1, 0)]) =
        (3.0, 2.0, -1.0, -1.0);
    let mut damping = DMatrix::identity(3, 3) * 0.06;
    (damping[(0, 1)], damping[(1, 0)]) = (-0.1, 0.1);
    let linear = LinearPart { mass: vec![1.0, 2.0, 0.5], damping, stiffness };
    let couplings = vec![
        Coupling { row: vec![0.0, -1.0, 1.0], offset: 2e-4, lag: 0.05 },
        Coupling { row: vec![0.3, 0.0, 1.0], offset: -1e-4, lag: 0.1 },
    ];
    (linear, couplings, Law::OneSided { stiffness: 2.0, part: 0.3, steps })
}

#[test]
fn several_couplings_are_those_of_marching() {
    let omega = 0.8;
    let (linear, couplings, law) = chain(512);
    let load = [0.0, 0.0, 1e-3];
    let force =
        |step: usize, steps: usize| [2e-3 * (TAU * step as f64 / steps as f64).sin(), 0.0, 0.0];
    let mut problem = HarmonicBalance::new(&linear, &couplings, law, 512).unwrap();
    problem.set_external(&load).unwrap();
    for step in 0..512 {
        problem.add_in_cycle(step, &force(step, 512)).unwrap();
    }
    let options = BalanceOptions { tail: 1e-5, ..BalanceOptions::default() };
    let found = problem.solve(omega, None, &options).unwrap();
    println!("chain: H {} iterations {}", found.harmonics, found.iterations);
    let run = |steps: usize| {
        let (linear, couplings, law) = chain(steps);
        let rule = dynamics::AverageAcceleration::new(TAU / omega / steps as f64).unwrap();
        let mut set = dynamics::Coupled::new(&linear, &couplings, &[], law, rule, steps).unwrap();
        set.set_external(&load).unwrap();
        for step in 0..steps {
            set.add_in_cycle(step, &force(step, steps)).unwrap();
        }
        set.rest().unwrap();
        (0..150 * steps).for_each(|_| set.step().unwrap());
        let mut out = vec![Vec::new(); 3];
        for step in 0..steps {
            if step % (steps / 64) == 0 {
                out.iter_mut().zip(set.displacements()).for_each(|(o, x)| o.push(x));
            }
            set.step().unwrap();
        }
        out
    };
    let (coarse, fine) = (run(1024), run(2048));
    for i in 0..3 {
        let both = coarse[i].iter().zip(&fine[i]);
        let marched: Vec<f64> = both.map(|(c, f)| (4.0 * f - c) / 3.0).collect();
        let difference = off(&found.coordinates[i], &marched);
        println!("chain {i}: {difference:e}");
        assert!(difference < 1e-3, "{i}: {difference:e}");
    }
    let [least, _] = found.deflections[0].extremes(512);
    assert!(least < 0.0, "contact is not lost: {least}");
}

/// Every column of the tangent by central differences.
#[test]
fn tangents_are_those_of_finite_differences() {
    let (linear, couplings, _) = chain(32);
    let mut problem =
        HarmonicBalance::new(&linear, &couplings, Law::Cubic { gamma: 1e6 }, 32).unwrap();
    problem.set_external(&[0.0, 1e-3, 1e-3]).unwrap();
    problem.add_in_cycle(5, &[1e-3, 2e-3, 0.0]).unwrap();
    let (omega, h) = (0.9, 1e-8);
    let equations = problem.equations(omega, 5).unwrap();
    let y: Vec<f64> = (0..equations.dimension())
        .map(|i| 1e-3 * (1.0 + i as f64).sin() / (1.0 + i as f64))
        .collect();
    let (_, jacobian) = equations.evaluate(&y).unwrap();
    let scale = jacobian.amax();
    for j in 0..y.len() {
        let side = |sign: f64| {
            let mut moved = y.clone();
            moved[j] += sign * h;
            equations.evaluate(&moved).unwrap().0
        };
        let slope = (side(1.0) - side(-1.0)) / (2.0 * h);
        let difference = (slope - jacobian.column(j)).amax();
        assert!(difference < 1e-7 * scale, "column {j}: {difference:e} of {scale:e}");
    }
}

/// A law whose tangent is wrong by a factor.
struct Spoilt(Law, f64);

impl CouplingForce for Spoilt {
    fn answer(&self, coupling: usize, step: usize, z: f64) -> (f64, f64) {
        let (p, d) = self.0.answer(coupling, step, z);
        (p, self.1 * d)
    }
}

/// Corrections fall quadratically; with a tangent off by 1 % they fall linearly.
#[test]
fn a_wrong_tangent_loses_quadratic_convergence() {
    let own = duffing(0.05, 0.3);
    let run = |factor: f64| {
        let law = Spoilt(own.law, factor);
        let mut problem = HarmonicBalance::new(&own.linear(), &own.couplings(), law, 128).unwrap();
        for step in 0..128 {
            let force = own.harmonic * (TAU * step as f64 / 128.0).cos();
            problem.add_in_cycle(step, &[force]).unwrap();
        }
        let options = BalanceOptions { first_harmonics: 20, ..BalanceOptions::default() };
        problem.solve(0.8, None, &options).unwrap().corrections
    };
    let (sound, spoilt) = (run(1.0), run(1.01));
    println!("sound {sound:?}\nspoilt {spoilt:?}");
    let ends_quadratically = |c: &[f64]| {
        let fine: Vec<f64> = c.iter().copied().filter(|c| *c < 1e-2).collect();
        fine.windows(2).filter(|w| w[0] > 1e-7).all(|w| w[1] < 10.0 * w[0] * w[0])
    };
    assert!(ends_quadratically(&sound));
    assert!(!ends_quadratically(&spoilt));
    assert!(spoilt.len() > sound.len());
}

#[test]
fn a_forgotten_lag_shows() {
    let own = Oscillator { lag: 0.2, ..duffing(0.02, 0.3) };
    let solve = |own: &Oscillator| {
        let found = own.balance(256).solve(1.2, None, &BalanceOptions::default()).unwrap();
        found.coordinates[0].clone()
    };
    let with = solve(&own);
    let start = [with.value(0.0), 1.2 * with.derivative(1, 0.0)];
    let marched = own.extrapolated(1.2, 1024, 200, start);
    assert!(off(&with, &marched) < 1e-5, "{:e}", off(&with, &marched));
    let without = solve(&Oscillator { lag: 0.0, ..own });
    assert!(off(&without, &marched) > 0.01);
}

#[test]
fn what_cannot_be_balanced_is_named() {
    let own = duffing(0.05, 0.3);
    let problem = own.balance(33);
    let options = BalanceOptions::default();
    let bad =
        |omega: f64, options: &BalanceOptions| problem.solve(omega, None, options).unwrap_err();
    assert!(matches!(bad(0.0, &options), BalanceError::Value { .. }));
    assert!(matches!(bad(f64::NAN, &options), BalanceError::Value { .. }));
    let many = BalanceOptions { first_harmonics: 9, ..options };
    assert_eq!(bad(1.0, &many), BalanceError::Samples { harmonics: 9, samples: 33 });
    let strict = BalanceOptions { tail: 1e-13, ..options };
    assert!(matches!(bad(0.3, &strict), BalanceError::Tail { harmonics: 8, .. }));
    let none = BalanceOptions { tail: 0.0, ..options };
    assert!(matches!(bad(1.0, &none), BalanceError::Value { .. }));
    let few = BalanceOptions { most_iterations: 1, ..options };
    assert!(matches!(bad(1.2, &few), BalanceError::NotConverged { .. }));
    let equations = problem.equations(1.0, 2).unwrap();
    assert!(matches!(equations.series(&[0.0]), Err(BalanceError::Size { wanted: 5, .. })));
    // An undamped resonance of the linear part.
    let undamped = Oscillator { damping: 0.0, ..own };
    let error = undamped.balance(33).solve(1.0, None, &options).unwrap_err();
    assert_eq!(error, BalanceError::Singular { harmonic: 1, frequency: 1.0 });
    // A load that nothing holds.
    let loose = Oscillator { stiffness: 0.0, steady: -1.0, ..own };
    let loose = Oscillator { law: Law::OneSided { stiffness: 1.0, part: 0.0, steps: 33 }, ..loose };
    let error = loose.balance(33).solve(1.0, None, &options).unwrap_err();
    assert!(matches!(error, BalanceError::System(_)), "{error}");
}
