//! Coupled systems in time against closed forms: order of convergence, energy, linear limit, loss of contact.

use dynamics::{AverageAcceleration, Coupled, CoupledError, Coupling, CouplingForce, LinearPart};
use nalgebra::DMatrix;

/// Force k (δ + c δ³); zero for δ ≤ 0 if one-sided.
#[derive(Debug, Clone)]
struct Spring {
    stiffness: f64,
    is_one_sided: bool,
    /// c, 1/m².
    cubic: f64,
}

impl CouplingForce for Spring {
    fn answer(&self, _: usize, _: usize, delta: f64) -> (f64, f64) {
        if self.is_one_sided && delta <= 0.0 {
            return (0.0, 0.0);
        }
        let c = self.cubic * delta * delta;
        (self.stiffness * delta * (1.0 + c), self.stiffness * (1.0 + 3.0 * c))
    }

    fn silent_up_to(&self, _: usize) -> f64 {
        if self.is_one_sided { 0.0 } else { f64::NEG_INFINITY }
    }
}

fn linear(mass: &[f64], damping: f64, stiffness: DMatrix<f64>) -> LinearPart {
    let n = mass.len();
    let of = |i: usize, j: usize| if i == j { damping * mass[i] } else { 0.0 };
    LinearPart { mass: mass.to_vec(), damping: DMatrix::from_fn(n, n, of), stiffness }
}

fn rule(step: f64) -> AverageAcceleration {
    AverageAcceleration::new(step).unwrap()
}

fn coupling(row: &[f64], offset: f64, lag: f64) -> Coupling {
    Coupling { row: row.to_vec(), offset, lag }
}

/// One mass on a coupling alone, pressed by a static force so that contact is never lost, with the
/// coupling's Kelvin–Voigt damping: x = (F/k)(1 − e^{−ζωt}(cos ω_d t + …)), ζ = τω/2.
#[test]
fn the_linear_limit_is_the_closed_form_at_second_order() {
    let (m, k, tau, force, end) = (0.7f64, 2e8f64, 6e-6, 900.0, 1e-3);
    let omega = (k / m).sqrt();
    let zeta = 0.5 * tau * omega;
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let decay = (-zeta * omega * end).exp();
    let swing = (damped * end).cos() + zeta * omega / damped * (damped * end).sin();
    // From twice the static deflection at rest.
    let exact = force / k * (1.0 + decay * swing);
    let error = |steps: usize| {
        let law = Spring { stiffness: k, is_one_sided: true, cubic: 0.0 };
        let part = linear(&[m], 0.0, DMatrix::zeros(1, 1));
        let one = [coupling(&[1.0], 0.0, tau)];
        let mut set = Coupled::new(&part, &one, &[], law, rule(end / steps as f64), steps).unwrap();
        set.set_external(&[force]).unwrap();
        set.set_motion(0, &[2.0 * force / k], &[0.0]).unwrap();
        (0..steps).for_each(|_| set.step().unwrap());
        (set.displacement(0) - exact).abs() / (force / k)
    };
    let (coarse, fine) = (error(400), error(800));
    assert!(((coarse / fine).log2() - 2.0).abs() < 0.05, "{coarse:e} {fine:e}");
    assert!(fine < 2e-3, "{fine:e}");
}

/// A chain with its last spring replaced by a linear coupling makes the same Newmark steps, to rounding.
#[test]
fn a_coupling_of_constant_stiffness_is_a_spring() {
    let (mass, k) = ([1.0, 2.0, 0.5], 4e7);
    let chain = |last: f64| {
        let mut s = DMatrix::<f64>::zeros(3, 3);
        for (i, j, k) in [(0, 0, 2.0 * k), (1, 1, k + last), (0, 1, -k), (1, 2, -last)] {
            s[(i, j)] = k;
            s[(j, i)] = k;
        }
        s[(2, 2)] = last;
        s
    };
    let law = || Spring { stiffness: 3e7, is_one_sided: false, cubic: 0.0 };
    let h = rule(2e-5);
    let row = [coupling(&[0.0, 1.0, -1.0], 0.0, 0.0)];
    let mut whole = Coupled::new(&linear(&mass, 30.0, chain(3e7)), &[], &[], law(), h, 7).unwrap();
    let mut split = Coupled::new(&linear(&mass, 30.0, chain(0.0)), &row, &[], law(), h, 7).unwrap();
    let (x, v) = ([1e-5, -2e-5, 3e-5], [0.01, 0.0, -0.02]);
    for set in [&mut whole, &mut split] {
        set.set_motion(0, &x, &v).unwrap();
    }
    for _ in 0..500 {
        whole.step().unwrap();
        split.step().unwrap();
    }
    let (a, b) = (whole.motion(), split.motion());
    for i in 0..3 {
        assert!((a.x[i] - b.x[i]).abs() < 1e-11 * 3e-5, "{i}: {:e} {:e}", a.x[i], b.x[i]);
        assert!((a.v[i] - b.v[i]).abs() < 1e-10 * 0.05);
    }
}

/// Without damping the energy with a stiffening coupling is conserved to second order in the step; a lag
/// dissipates it.
#[test]
fn energy_is_kept_to_second_order_and_a_lag_takes_it() {
    let cubic = 3e9;
    let spread = |steps: usize, lag: f64| {
        let law = Spring { stiffness: 5e7, is_one_sided: false, cubic };
        let mut ground = DMatrix::zeros(2, 2);
        ground[(0, 0)] = 2e7;
        let part = linear(&[1.0, 0.4], 0.0, ground);
        let one = [coupling(&[1.0, -1.0], 0.0, lag)];
        let mut set = Coupled::new(&part, &one, &[], law, rule(5e-3 / steps as f64), 1).unwrap();
        set.set_motion(0, &[2e-5, -1e-5], &[0.0, 0.0]).unwrap();
        let energy = |set: &Coupled<Spring>| {
            let d = set.deflections()[0];
            let stored = 5e7 * (0.5 * d * d + 0.25 * cubic * d.powi(4));
            set.energies().iter().sum::<f64>() + stored
        };
        let start = energy(&set);
        let mut last = start;
        let mut worst = 0.0f64;
        for _ in 0..steps {
            set.step().unwrap();
            last = energy(&set);
            worst = worst.max((last / start - 1.0).abs());
        }
        (worst, last / start)
    };
    let (coarse, fine) = (spread(1000, 0.0).0, spread(2000, 0.0).0);
    assert!(fine < 2e-3, "{fine:e}");
    assert!(((coarse / fine).log2() - 2.0).abs() < 0.2, "{coarse:e} {fine:e}");
    assert!(spread(2000, 2e-6).1 < 0.9);
}

/// A mass pressed by a constant force onto a one-sided spring, with an initial velocity: its motion is a
/// parabola in the air and part of a sine in contact, in turns.
#[test]
fn a_bouncing_mass_follows_the_piecewise_solution() {
    let (m, k, weight, thrown, end) = (0.5f64, 1e8f64, 600.0, 0.4f64, 2.2e-3f64);
    let omega = (k / m).sqrt();
    // x down; contact at x > 0, from x = 0 with speed +v each time.
    let sink = weight / k;
    // In contact: x = sink (1 − cos ωt) + (v/ω) sin ωt, back at x = 0 with −v at ωt = 2π − 2 atan(…).
    let in_contact = 2.0 * (std::f64::consts::PI - (thrown / omega / sink).atan()) / omega;
    let in_air = 2.0 * thrown / (weight / m);
    let exact = |t: f64| {
        let t = t % (in_contact + in_air);
        if t < in_contact {
            sink * (1.0 - (omega * t).cos()) + thrown / omega * (omega * t).sin()
        } else {
            let t = t - in_contact;
            -thrown * t + 0.5 * weight / m * t * t
        }
    };
    for is_rare in [false, true] {
        let worst = |steps: usize| {
            let law = Spring { stiffness: k, is_one_sided: true, cubic: 0.0 };
            let part = linear(&[m], 0.0, DMatrix::zeros(1, 1));
            let one = [coupling(&[1.0], 0.0, 0.0)];
            let (usual, rare): (&[Coupling], &[Coupling]) =
                if is_rare { (&[], &one) } else { (&one, &[]) };
            let h = end / steps as f64;
            let mut set = Coupled::new(&part, usual, rare, law, rule(h), 3).unwrap();
            set.set_external(&[weight]).unwrap();
            set.set_motion(0, &[0.0], &[thrown]).unwrap();
            let mut worst = 0.0f64;
            for i in 1..=steps {
                set.step().unwrap();
                worst = worst.max((set.displacement(0) - exact(i as f64 * h)).abs());
                assert!(set.forces()[0] >= 0.0);
            }
            worst
        };
        assert!(end > 1.2 * (in_contact + in_air));
        let top = 0.5 * thrown * thrown / (weight / m);
        let (coarse, fine) = (worst(4000) / top, worst(16000) / top);
        assert!(fine < 1e-4 && fine < 0.15 * coarse, "{coarse:e} {fine:e}");
    }
}

#[test]
fn rest_is_the_static_solution_and_stays() {
    // Two masses in a row pressed onto a support through a one-sided coupling with a gap.
    let law = Spring { stiffness: 3e7, is_one_sided: true, cubic: 0.0 };
    let mut ground = DMatrix::zeros(2, 2);
    ground[(1, 1)] = 2e7;
    let part = linear(&[1.0, 2.0], 5.0, ground);
    let one = [coupling(&[1.0, -1.0], 4e-6, 2e-6)];
    let mut set = Coupled::new(&part, &one, &[], law, rule(1e-5), 4).unwrap();
    assert_eq!(set.rest(), Ok(()));
    set.set_external(&[800.0, 0.0]).unwrap();
    set.rest().unwrap();
    let exact = [800.0 / 3e7 + 4e-6 + 800.0 / 2e7, 800.0 / 2e7];
    for _ in 0..50 {
        for (i, exact) in exact.iter().enumerate() {
            assert!((set.displacement(i) - exact).abs() < 1e-12 * exact);
        }
        set.step().unwrap();
    }
    // Pulled apart nothing holds the first mass.
    set.set_external(&[-1.0, 0.0]).unwrap();
    assert!(set.rest().is_err());
}

/// A skew-symmetric C couples the modes: a step must satisfy the full equations of motion and Newmark's rule.
#[test]
fn unsymmetric_damping_is_solved_in_full() {
    let (h, m, k, g) = (3e-5, [1.0, 1.0], 6e7, 900.0);
    let mut c = DMatrix::zeros(2, 2);
    (c[(0, 1)], c[(1, 0)]) = (-g, g);
    let mut stiffness = DMatrix::zeros(2, 2);
    (stiffness[(0, 0)], stiffness[(1, 1)]) = (k, k);
    let part = LinearPart { mass: m.to_vec(), damping: c, stiffness };
    let law = Spring { stiffness: 2e7, is_one_sided: false, cubic: 0.0 };
    let one = [coupling(&[0.6, 0.8], 0.0, 0.0)];
    let mut set = Coupled::new(&part, &one, &[], law, rule(h), 2).unwrap();
    set.set_motion(0, &[1e-5, 0.0], &[0.0, 0.1]).unwrap();
    let start = set.motion();
    set.step().unwrap();
    let end = set.motion();
    // Balance at the end of the step, and the rule itself.
    let p = 2e7 * (0.6 * end.x[0] + 0.8 * end.x[1]);
    let spin = [-g * end.v[1], g * end.v[0]];
    for i in 0..2 {
        let row = [0.6, 0.8][i];
        let left = end.a[i] + spin[i] + k * end.x[i] + row * p;
        assert!(left.abs() < 1e-9 * k * 1e-5, "{left:e}");
        let mean = 0.5 * h * (start.v[i] + end.v[i]);
        assert!((end.x[i] - start.x[i] - mean).abs() < 1e-12 * 1e-5);
    }
}

#[test]
fn states_resume_bit_by_bit() {
    let law = Spring { stiffness: 5e7, is_one_sided: true, cubic: 1e9 };
    let part =
        linear(&[1.0, 0.4], 20.0, DMatrix::from_fn(2, 2, |i, j| if i == j { 2e7 } else { 0.0 }));
    let one = [coupling(&[1.0, -1.0], 1e-6, 2e-6)];
    let mut set = Coupled::new(&part, &one, &[], law, rule(2e-5), 5).unwrap();
    set.set_motion(3, &[2e-5, -1e-5], &[0.0, 0.5]).unwrap();
    (0..37).for_each(|_| set.step().unwrap());
    let (state, mut other) = (set.state().clone(), set.clone());
    (0..90).for_each(|_| set.step().unwrap());
    (0..11).for_each(|_| other.step().unwrap());
    other.set_state(&state).unwrap();
    (0..90).for_each(|_| other.step().unwrap());
    assert_eq!(set.state(), other.state());
}

#[test]
fn divergence_and_unfit_input_are_named() {
    let law = Spring { stiffness: 5e7, is_one_sided: true, cubic: 0.0 };
    let part = linear(&[1.0, 2.0], 0.0, DMatrix::zeros(2, 2));
    let make = |row: &[f64], lag| {
        Coupled::new(&part, &[coupling(row, 0.0, lag)], &[], law.clone(), rule(1e-5), 4)
    };
    assert!(matches!(make(&[1.0], 0.0), Err(CoupledError::Size { .. })));
    assert!(matches!(make(&[1.0, f64::NAN], 0.0), Err(CoupledError::Coupling { .. })));
    assert!(matches!(make(&[1.0, 0.0], -1.0), Err(CoupledError::Coupling { .. })));
    let mut set = make(&[1.0, -1.0], 0.0).unwrap();
    set.set_external(&[0.0, 1e7]).unwrap();
    let error = (0..100_000).find_map(|_| set.step().err());
    assert!(matches!(error, Some(CoupledError::Diverged { coordinate: 1, .. })), "{error:?}");
    set.set_motion(0, &[f64::NAN, 0.0], &[0.0, 0.0]).unwrap();
    assert!(set.step().is_err());
}
