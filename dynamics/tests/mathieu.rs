//! Borders of stability of Mathieu's equation ẍ + (a − 2q cos 2t) x = 0, by the derivative of the steps that
//! shooting uses, against its characteristic values.
//!
//! A border is where a Floquet multiplier over the period π is +1 (a₀, b₂, a₂: trace of the monodromy matrix 2) or
//! −1 (b₁, a₁: trace −2). Values for q = 5: Abramowitz & Stegun, *Handbook of Mathematical Functions* (1964),
//! table 20.1; all: eigenvalues of the tridiagonal matrices of the Fourier coefficients' recurrences (DLMF § 28.4),
//! computed here.

use std::f64::consts::PI;

use dynamics::{
    AverageAcceleration, Coupled, Coupling, CouplingForce, LinearPart, MapDerivative, Multiplier,
    MultiplierKind, PassedSteps, generalized_symmetric, multipliers,
};
use nalgebra::{DMatrix, Matrix2};

/// P = (a − 2q cos 2t) δ; in the cycle of π. Where the stiffness is negative the force falls with deflection: a
/// step is still solvable, since 4m/h² is far above it.
struct Mathieu {
    a: f64,
    q: f64,
    steps: usize,
}

impl CouplingForce for Mathieu {
    fn answer(&self, _: usize, step: usize, delta: f64) -> (f64, f64) {
        let theta = 2.0 * PI * step as f64 / self.steps as f64;
        let stiffness = self.a - 2.0 * self.q * theta.cos();
        (stiffness * delta, stiffness)
    }
}

/// The derivative of the map of one cycle with respect to displacement and velocity, the monodromy matrix, as
/// shooting computes it.
fn monodromy(a: f64, q: f64, steps: usize) -> Matrix2<f64> {
    let linear = LinearPart {
        mass: vec![1.0],
        damping: DMatrix::zeros(1, 1),
        stiffness: DMatrix::zeros(1, 1),
    };
    let one = [Coupling { row: vec![1.0], offset: 0.0, lag: 0.0 }];
    let rule = AverageAcceleration::new(PI / steps as f64).unwrap();
    let mut set = Coupled::new(&linear, &one, &[], Mathieu { a, q, steps }, rule, steps).unwrap();
    let mut passed = PassedSteps::default();
    set.keep_step(&mut passed);
    for _ in 0..steps {
        set.step().unwrap();
        set.keep_step(&mut passed);
    }
    let columns = set.derivative_of::<f64>(&passed, 1.0).unwrap().columns;
    assert_eq!(columns.shape(), (2, 2));
    Matrix2::from_fn(|i, j| columns[(i, j)])
}

/// Extrapolated in the step: the rule is symmetric in time, so its error has even powers of the step only.
fn extrapolated(a: f64, q: f64) -> Matrix2<f64> {
    let [s1, s2, s4] = [240, 480, 960].map(|steps| monodromy(a, q, steps));
    let (t1, t2) = ((4.0 * s2 - s1) / 3.0, (4.0 * s4 - s2) / 3.0);
    (16.0 * t2 - t1) / 15.0
}

/// Multipliers of the steps themselves, 960 in a cycle: their borders are off by less than 1e-4, and the volume is
/// kept to rounding.
fn found_multipliers(a: f64, q: f64) -> Vec<Multiplier> {
    let matrix = monodromy(a, q, 960);
    let columns = DMatrix::from_fn(2, 2, |i, j| matrix[(i, j)]);
    multipliers(&MapDerivative { active: vec![0, 1], columns, scales: vec![1.0; 2] }).unwrap()
}

/// Root of trace − target by the secant rule from a bracket of ±`about`.
fn border(guess: f64, q: f64, target: f64, about: f64) -> f64 {
    let of = |a: f64| extrapolated(a, q).trace() - target;
    let (mut a, mut b) = (guess - about, guess + about);
    let (mut f, mut g) = (of(a), of(b));
    assert!(f * g < 0.0, "no border near {guess}");
    for _ in 0..40 {
        let c = (a * g - b * f) / (g - f);
        let h = of(c);
        if h.abs() < 1e-13 {
            return c;
        }
        if h * g < 0.0 {
            (a, f) = (b, g);
        } else {
            f *= 0.5;
        }
        (b, g) = (c, h);
        if (b - a).abs() < 1e-12 {
            break;
        }
    }
    b
}

/// a₀, b₁, a₁, b₂, a₂ from the recurrences' matrices with 30 coefficients each.
fn characteristic_values(q: f64) -> [f64; 5] {
    let lowest = |diagonal: &dyn Fn(usize) -> f64, first: f64, which: usize| {
        let n = 30;
        let matrix = DMatrix::from_fn(n, n, |i: usize, j: usize| match (i, j) {
            _ if i == j => diagonal(i),
            (0, 1) | (1, 0) => first,
            _ if i.abs_diff(j) == 1 => q,
            _ => 0.0,
        });
        generalized_symmetric(&matrix, &vec![1.0; n]).unwrap().lambda[which]
    };
    let odd = |i: usize| (2.0 * i as f64 + 1.0).powi(2);
    let even = |i: usize| 4.0 * (i as f64).powi(2);
    let start = |sign: f64| move |i: usize| odd(i) + if i == 0 { sign * q } else { 0.0 };
    [
        lowest(&even, 2f64.sqrt() * q, 0),
        lowest(&start(-1.0), q, 0),
        lowest(&start(1.0), q, 0),
        lowest(&|i| even(i + 1), q, 0),
        lowest(&even, 2f64.sqrt() * q, 1),
    ]
}

const TARGETS: [f64; 5] = [2.0, -2.0, -2.0, 2.0, 2.0];

#[test]
fn recurrences_give_the_tabulated_values() {
    let table = [-5.800_046_02, -5.790_080_60, 1.858_187_54, 2.099_460_45, 7.449_109_74];
    for (found, printed) in characteristic_values(5.0).iter().zip(table) {
        assert!((found - printed).abs() < 6e-9, "{found} {printed}");
    }
}

#[test]
fn borders_of_stability_are_the_characteristic_values() {
    for q in [1.0, 5.0] {
        for (exact, target) in characteristic_values(q).into_iter().zip(TARGETS) {
            let found = border(exact, q, target, 2e-3);
            println!("q {q}: {found:.10} and {exact:.10}: {:e}", found - exact);
            assert!((found - exact).abs() < 1e-6, "q {q}: {found} {exact}");
        }
    }
}

/// On the stable side of a border both multipliers lie on the unit circle as a complex pair, on the other side one
/// leaves it through the point that the border is named for: −1 for a₁ and b₁, +1 for the others.
#[test]
fn multipliers_leave_the_unit_circle_at_the_borders() {
    let q = 5.0;
    // a₀ < b₁ and a₁ < b₂ bound stable regions from below and above; above a₂ the motion is stable again.
    let is_stable_above = [true, false, true, false, true];
    let borders = characteristic_values(q).into_iter().zip(TARGETS).zip(is_stable_above);
    for ((border, target), is_stable_above) in borders {
        let away = if is_stable_above { 1e-3 } else { -1e-3 };
        let (stable, unstable) =
            (found_multipliers(border + away, q), found_multipliers(border - away, q));
        for m in &stable {
            assert_eq!(m.kind(), MultiplierKind::NeimarkSacker, "{border}: {m:?}");
            assert!((m.size() - 1.0).abs() < 1e-9, "{border}: {m:?}");
        }
        let [large, small] = [unstable[0], unstable[1]];
        let kind = if target > 0.0 { MultiplierKind::Fold } else { MultiplierKind::PeriodDoubling };
        assert_eq!(large.kind(), kind, "{border}: {large:?}");
        assert!(large.size() > 1.0 + 1e-4, "{border}: {large:?}");
        assert!((large.re * small.re - 1.0).abs() < 1e-9, "{border}: {large:?} {small:?}");
    }
}

/// Without damping the phase volume is kept (Liouville): the product of both multipliers is one at any step.
#[test]
fn the_determinant_is_one() {
    for a in [-5.9, 0.3, 3.0] {
        let determinant = monodromy(a, 5.0, 240).determinant();
        let size = monodromy(a, 5.0, 240).norm_squared();
        assert!((determinant - 1.0).abs() < 1e-11 * size.max(1.0), "{determinant}");
    }
}

/// Without extrapolation 240 steps are not enough for the figure claimed.
#[test]
fn one_number_of_steps_misses_the_borders() {
    let exact = characteristic_values(5.0)[4];
    let slope =
        (extrapolated(exact + 1e-4, 5.0).trace() - extrapolated(exact - 1e-4, 5.0).trace()) / 2e-4;
    let off = (monodromy(exact, 5.0, 240).trace() - 2.0) / slope;
    assert!(off.abs() > 1e-5, "{off:e}");
}
