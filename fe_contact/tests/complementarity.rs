//! The three contact solvers against each other on random and degenerate problems.

use fastrand::Rng;
use fe_contact::complementarity::*;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const PROBLEMS: u64 = 10_000;
/// Condition number above which forces are not compared, only separations and the KKT residual.
const SINGULAR: f64 = 1e10;

/// A problem with the extreme eigenvalues of its compliance, which limit how closely its solutions
/// can agree.
struct Case {
    compliance: DMatrix<f64>,
    gaps: Vec<f64>,
    kind: String,
    smallest: f64,
    largest: f64,
}

impl Case {
    fn problem(&self) -> Problem<'_> {
        Problem { compliance: &self.compliance, gaps: &self.gaps }
    }

    fn condition(&self) -> f64 {
        if self.smallest > 0.0 { self.largest / self.smallest } else { f64::INFINITY }
    }
}

fn normal(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}

/// Compliance (n×n) of one of seven kinds and its name.
fn compliance(rng: &mut Rng, n: usize) -> (DMatrix<f64>, &'static str) {
    let step = 1.0 / n as f64;
    let apart = |i: usize, j: usize| step * i.abs_diff(j) as f64;
    let square = |rng: &mut Rng, rank: usize| {
        let a = DMatrix::from_fn(rank, n, |_, _| normal(rng));
        a.transpose() * a
    };
    match rng.u32(0..7) {
        0 => {
            let log = DMatrix::from_fn(n, n, |i, j| 1.0 - (apart(i, j) + 0.5 * step).ln());
            let least = log.symmetric_eigenvalues().min();
            (log + DMatrix::identity(n, n) * (0.05 - least.min(0.0)), "logarithmic")
        }
        1 => {
            let length = 0.05 + 2.0 * rng.f64();
            (DMatrix::from_fn(n, n, |i, j| (-apart(i, j) / length).exp()), "exponential")
        }
        2 => {
            let ridge = 10f64.powi(-rng.i32(0..8));
            (square(rng, n) + DMatrix::identity(n, n) * ridge, "A'A + ridge")
        }
        3 => {
            let rank = rng.usize(1..=n);
            (square(rng, rank), "rank-deficient")
        }
        4 => (DMatrix::identity(n, n), "identity"),
        5 => {
            let length = 0.1 + rng.f64();
            let bell = |i, j| (-(apart(i, j) / length).powi(2)).exp();
            (DMatrix::from_fn(n, n, bell), "bell")
        }
        _ => {
            // Two flanks that share their bodies: blocks of a common part.
            let split = rng.usize(0..=n);
            let same = |i: usize, j: usize| (i < split) == (j < split);
            let entry = |i, j| {
                0.2 + if same(i, j) { (-3.0 * apart(i, j)).exp() } else { 0.0 }
                    + if i == j { 0.1 } else { 0.0 }
            };
            (DMatrix::from_fn(n, n, entry), "two flanks")
        }
    }
}

/// Gaps of one of nine kinds; only such as have a solution if C is singular.
fn gaps(rng: &mut Rng, c: &DMatrix<f64>, singular: bool) -> (Vec<f64>, &'static str) {
    let n = c.nrows();
    let solved = |forces: Vec<f64>, separations: Vec<f64>| -> Vec<f64> {
        (DVector::from_vec(separations) - c * DVector::from_vec(forces)).as_slice().to_vec()
    };
    match rng.u32(if singular { 5 } else { 0 }..9) {
        0 => ((0..n).map(|_| normal(rng)).collect(), "random"),
        1 => (vec![-1.0; n], "equal"),
        2 => {
            // A parabola, exactly symmetric, that is exactly 0 at one or two cells.
            let touched = rng.usize(0..=n);
            let square = |i: usize| (2 * i as i64 + 1 - n as i64).pow(2) as f64;
            ((0..n).map(|i| square(i) - square(touched.min(n - 1))).collect(), "parabola")
        }
        3 => ((0..n).map(|_| f64::from(rng.i32(-2..=1))).collect(), "few values"),
        4 => {
            let mut gaps = vec![1.0; n];
            gaps[rng.usize(0..n)] = -1.0;
            (gaps, "single overlap")
        }
        5 => {
            let zero = rng.bool();
            let gap = |rng: &mut Rng| if zero || rng.bool() { 0.0 } else { rng.f64() };
            ((0..n).map(|_| gap(rng)).collect(), "no load")
        }
        6 => (solved((0..n).map(|_| 0.1 + rng.f64()).collect(), vec![0.0; n]), "full patch"),
        7 => {
            // A third of the cells each carries force, is apart, and just touches.
            let (mut p, mut w) = (vec![0.0; n], vec![0.0; n]);
            for i in 0..n {
                match rng.u32(0..3) {
                    0 => p[i] = f64::from(rng.u32(1..4)),
                    1 => w[i] = f64::from(rng.u32(1..4)),
                    _ => {}
                }
            }
            (solved(p, w), "just touching")
        }
        _ => {
            // A solution exists, but it is not these forces.
            let p = (0..n).map(|_| rng.f64()).collect();
            (solved(p, (0..n).map(|_| rng.f64()).collect()), "solvable")
        }
    }
}

fn case(seed: u64) -> Case {
    sized(seed, Rng::with_seed(!seed).usize(1..=24))
}

fn sized(seed: u64, n: usize) -> Case {
    let mut rng = Rng::with_seed(seed);
    let (c, first) = compliance(&mut rng, n);
    let values = c.clone().symmetric_eigenvalues();
    let singular = values.min() <= values.max() / SINGULAR;
    let (g, second) = gaps(&mut rng, &c, singular);
    // In about every other case the magnitudes of contact in m/N and m.
    let (per_force, length) = if rng.bool() { (3e-9, 2e-5) } else { (1.0, 1.0) };
    Case {
        compliance: c * per_force,
        gaps: g.iter().map(|g| g * length).collect(),
        kind: format!("{seed}: n = {n}, {first}, {second}"),
        smallest: values.min() * per_force,
        largest: values.max() * per_force,
    }
}

fn worst(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, v| if v.is_nan() { f64::NAN } else { a.max(v.abs()) })
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| a - b))
}

fn separations(case: &Case, forces: &[f64]) -> Vec<f64> {
    let w = &case.compliance * DVector::from_column_slice(forces);
    w.iter().zip(&case.gaps).map(|(w, g)| w + g).collect()
}

fn solved(solver: &dyn ComplementaritySolver, case: &Case, warm: Option<&[bool]>) -> Solution {
    solver
        .solve(&case.problem(), warm)
        .unwrap_or_else(|cause| panic!("{}: {}: {cause}", case.kind, solver.name()))
}

/// Checks the three solvers against each other; adds to the worst deviations seen.
fn agree(case: &Case, seen: &mut Worst) {
    let problem = case.problem();
    let a = solved(&ActiveSet, case, None);
    let l = solved(&Lemke, case, None);
    let i = solved(&InteriorPoint, case, None);
    let peak = worst(a.forces.iter().copied());
    let gap = worst(case.gaps.iter().copied()).max(f64::MIN_POSITIVE);
    let condition = case.condition();
    let w = separations(case, &a.forces);

    for (name, solution) in [("active set", &a), ("Lemke", &l), ("interior point", &i)] {
        let residual = kkt_residual(&problem, &solution.forces);
        seen.note(name, residual, case);
        assert!(residual < 1e-7, "{}: {name}: residual {residual:e}", case.kind);
        assert!(solution.forces.iter().all(|p| *p >= 0.0), "{}: tension", case.kind);
        for (active, p) in solution.active.iter().zip(&solution.forces) {
            assert!(*active || *p <= 1e-4 * peak, "{}: force outside contact", case.kind);
        }
    }
    // Separations are unique for every compliance.
    let pivoting = difference(&w, &separations(case, &l.forces)) / gap;
    let interior = difference(&w, &separations(case, &i.forces)) / gap;
    seen.note("separations, Lemke", pivoting, case);
    seen.note("separations, interior point", interior, case);
    assert!(pivoting < 1e-7, "{}: separations differ by {pivoting:e}", case.kind);
    assert!(interior < 1e-5, "{}: separations differ by {interior:e}", case.kind);

    if condition > SINGULAR || peak == 0.0 {
        return;
    }
    let pivoting = difference(&a.forces, &l.forces) / peak;
    seen.note("forces, Lemke", pivoting, case);
    let limit = f64::max(1e-9, 1e-14 * condition);
    assert!(pivoting <= limit, "{}: forces differ by {pivoting:e} of the peak", case.kind);
    let interior = difference(&a.forces, &i.forces) / peak;
    // Where a cell just touches, its p and w are only of the order of the root of the duality gap
    // t, with |Δp|² ≤ 2t/λ; elsewhere the error is of the order of t.
    let strict = (0..w.len()).all(|k| (a.forces[k] / peak).max(w[k] / gap) > 1e-3);
    let limit = if strict {
        seen.note(
            "forces, interior point over condition, clear contact",
            interior / condition.max(1.0),
            case,
        );
        f64::max(1e-6, 1e-11 * condition)
    } else {
        let diagonal = case.compliance.diagonal().max();
        let cost = 0.5 * worst(case.gaps.iter().zip(&a.forces).map(|(g, p)| g * p));
        let unit = gap * gap / diagonal;
        let root = (2e-12 * (unit + cost) / case.smallest).sqrt() / peak;
        seen.note("forces, interior point over bound, just touching", interior / root, case);
        f64::max(1e-6, 2.0 * root)
    };
    assert!(interior <= limit, "{}: forces differ by {interior:e} > {limit:e}", case.kind);
}

/// Largest deviations by name, with the case in which they occurred.
#[derive(Default)]
struct Worst(Vec<(&'static str, f64, String)>);

impl Worst {
    fn note(&mut self, what: &'static str, value: f64, case: &Case) {
        let at = self.0.iter().position(|(name, ..)| *name == what).unwrap_or_else(|| {
            self.0.push((what, -1.0, String::new()));
            self.0.len() - 1
        });
        if value.is_nan() || value > self.0[at].1 {
            self.0[at] =
                (what, value, format!("{}, condition {:.0e}", case.kind, case.condition()));
        }
    }

    fn print(&self) {
        for (what, value, place) in &self.0 {
            println!("{what}: {value:.1e} ({place})");
        }
    }
}

#[test]
fn the_solvers_agree_on_random_and_degenerate_problems() {
    let mut seen = Worst::default();
    // The two further cases: gaps for which a solution only just exists, and forces that a singular
    // compliance does not determine.
    for seed in (0..PROBLEMS).chain([13_992, 24_372]) {
        agree(&case(seed), &mut seen);
    }
    seen.print();
}

#[test]
fn the_solvers_agree_on_large_problems() {
    let mut seen = Worst::default();
    for seed in 0..60 {
        agree(&sized(seed, 60 + 2 * seed as usize), &mut seen);
    }
    for n in [60, 300] {
        let case = cylinder(n);
        agree(&case, &mut seen);
        let warm = solved(&ActiveSet, &case, None).active;
        let runs: [(&dyn ComplementaritySolver, Option<&[bool]>); 4] =
            [(&ActiveSet, Some(&warm)), (&ActiveSet, None), (&Lemke, None), (&InteriorPoint, None)];
        for (solver, warm) in runs {
            let start = std::time::Instant::now();
            let solution = (0..10).map(|_| solved(solver, &case, warm)).last().unwrap();
            let (name, each) = (solver.name(), start.elapsed() / 10);
            let hint = if warm.is_some() { " warm" } else { "" };
            println!("n = {n}: {name}{hint} {each:?}, {} iterations", solution.iterations);
        }
    }
    seen.print();
}

/// A cylinder on a half-plane: logarithmic compliance, parabolic gaps, about a third in contact.
fn cylinder(n: usize) -> Case {
    let step = 1.0 / n as f64;
    let compliance = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { 0.5 } else { 0.0 };
        1e-9 * (1.0 + own - (step * i.abs_diff(j) as f64 + 0.5 * step).ln())
    });
    let gap = |i: usize| 1e-3 * (((i as f64 + 0.5) * step - 0.5).powi(2) - 0.1);
    let values = compliance.clone().symmetric_eigenvalues();
    Case {
        compliance,
        gaps: (0..n).map(gap).collect(),
        kind: format!("cylinder, n = {n}"),
        smallest: values.min(),
        largest: values.max(),
    }
}

#[test]
fn warm_starts_change_no_result() {
    let mut seen = Worst::default();
    let mut rng = Rng::with_seed(0);
    for case in (0..3000).map(case).filter(|c| c.condition() < 1e3) {
        let cold = solved(&ActiveSet, &case, None);
        let peak = worst(cold.forces.iter().copied()).max(f64::MIN_POSITIVE);
        let n = case.gaps.len();
        let starts = [
            cold.active.clone(),
            cold.active.iter().map(|a| !a).collect(),
            vec![true; n],
            vec![false; n],
            (0..n).map(|_| rng.bool()).collect(),
            vec![true; n + 1],
        ];
        for start in &starts {
            let warm = solved(&ActiveSet, &case, Some(start));
            let off = difference(&cold.forces, &warm.forces) / peak;
            seen.note("warm start", off, &case);
            assert!(off <= 1e-12, "{}: {off:e} from {start:?}", case.kind);
            for solver in [&Lemke as &dyn ComplementaritySolver, &InteriorPoint] {
                assert_eq!(solved(solver, &case, None), solved(solver, &case, Some(start)));
            }
        }
        let again = solved(&ActiveSet, &case, Some(&cold.active));
        assert!(again.iterations <= 1, "{}: {} factorisations", case.kind, again.iterations);
    }
    seen.print();
}

const SOLVERS: [&dyn ComplementaritySolver; 3] = [&ActiveSet, &Lemke, &InteriorPoint];

#[test]
fn a_problem_solved_by_hand_comes_out() {
    // The force on the first cell separates the second: w₂ = 1·2 − 1.5.
    let compliance = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
    let problem = Problem { compliance: &compliance, gaps: &[-4.0, -1.5] };
    for solver in SOLVERS {
        let solution = solver.solve(&problem, None).unwrap();
        assert!(difference(&solution.forces, &[2.0, 0.0]) < 1e-9, "{}", solver.name());
        assert_eq!(solution.active, [true, false], "{}", solver.name());
    }
}

#[test]
fn the_smallest_problems_have_solutions() {
    let none = DMatrix::zeros(0, 0);
    let one = DMatrix::from_element(1, 1, 4.0);
    for solver in SOLVERS {
        let name = solver.name();
        let run = |compliance: &DMatrix<f64>, gaps: &[f64]| {
            solver.solve(&Problem { compliance, gaps }, None).unwrap()
        };
        assert_eq!(run(&none, &[]).forces, [0.0; 0], "{name}");
        assert!((run(&one, &[-8.0]).forces[0] - 2.0).abs() < 1e-9, "{name}");
        for gap in [0.0, 1.0, -0.0] {
            let free = run(&one, &[gap]);
            assert_eq!(
                (free.forces[0], free.active[0], free.iterations),
                (0.0, false, 0),
                "{name}"
            );
        }
    }
}

#[test]
fn unusable_input_is_refused() {
    let fault = |compliance: &DMatrix<f64>, gaps: &[f64]| {
        let faults = SOLVERS.map(|s| s.solve(&Problem { compliance, gaps }, None).unwrap_err());
        assert!(faults.iter().all(|f| *f == faults[0]), "{faults:?}");
        faults[0].clone()
    };
    let one = DMatrix::identity(2, 2);
    assert_eq!(
        fault(&DMatrix::zeros(2, 3), &[-1.0, -1.0]),
        ComplementarityError::NotSquare { rows: 2, columns: 3 }
    );
    assert_eq!(fault(&one, &[-1.0]), ComplementarityError::SizeMismatch { order: 2, gaps: 1 });
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        // Refused even if nothing would touch.
        assert_eq!(fault(&one, &[1.0, bad]), ComplementarityError::GapNotFinite { index: 1 });
        let mut compliance = one.clone();
        compliance[(0, 1)] = bad;
        assert_eq!(
            fault(&compliance, &[1.0, 1.0]),
            ComplementarityError::ComplianceNotFinite { row: 0, column: 1 }
        );
    }
}

#[test]
fn overlaps_that_no_forces_close_are_errors() {
    let see_saw = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
    let rigid = DMatrix::zeros(2, 2);
    for compliance in [&see_saw, &rigid] {
        let problem = Problem { compliance, gaps: &[-1.0, -1.0] };
        for solver in [&ActiveSet as &dyn ComplementaritySolver, &Lemke] {
            let fault = solver.solve(&problem, None).unwrap_err();
            assert!(matches!(fault, ComplementarityError::RayTermination { .. }), "{fault}");
        }
        let fault = InteriorPoint.solve(&problem, None).unwrap_err();
        assert!(matches!(fault, ComplementarityError::InteriorPoint(_)), "{fault}");
    }
    // C times the vector of ones is 0 to rounding, so that the sum of the separations is that of
    // the gaps for all forces, and negative.
    for seed in 0..500 {
        let mut rng = Rng::with_seed(seed);
        let n = rng.usize(2..=24);
        let mut a = DMatrix::from_fn(n, n, |_, _| normal(&mut rng));
        for mut row in a.row_iter_mut() {
            let mean = row.mean();
            row.add_scalar_mut(-mean);
        }
        let compliance = a.transpose() * a;
        let mut gaps: Vec<f64> = (0..n).map(|_| normal(&mut rng)).collect();
        let excess = gaps.iter().sum::<f64>() / n as f64 + 0.5;
        gaps.iter_mut().for_each(|g| *g -= excess);
        for solver in SOLVERS {
            let result = solver.solve(&Problem { compliance: &compliance, gaps: &gaps }, None);
            assert!(result.is_err(), "{seed}: {} found {result:?}", solver.name());
        }
    }
}

#[test]
fn the_residual_names_every_violation() {
    let compliance = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 2.0]));
    let problem = Problem { compliance: &compliance, gaps: &[-4.0, 2.0] };
    let residual = |forces: &[f64]| kkt_residual(&problem, forces);
    assert_eq!(residual(&[4.0, 0.0]), 0.0);
    // Tension of a quarter of the peak; a quarter of the largest gap left as overlap; a force
    // across a gap.
    assert_eq!(residual(&[4.0, -1.0]), 0.25);
    assert_eq!(residual(&[3.0, 0.0]), 0.25);
    assert_eq!(residual(&[4.0, 2.0]), 0.75);
    assert_eq!(residual(&[f64::NAN, 0.0]), f64::INFINITY);
    assert_eq!(residual(&[4.0]), f64::INFINITY);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn units_and_order_do_not_matter(
        seed in PROBLEMS..2 * PROBLEMS,
        per_force in -12i32..6,
        length in -9i32..6,
    ) {
        let case = case(seed);
        prop_assume!(case.condition() < 1e6);
        let n = case.gaps.len();
        let (c, g) = (10f64.powi(per_force), 10f64.powi(length));
        let mut order: Vec<usize> = (0..n).collect();
        Rng::with_seed(seed).shuffle(&mut order);
        let compliance = DMatrix::from_fn(n, n, |i, j| c * case.compliance[(order[i], order[j])]);
        let gaps: Vec<f64> = order.iter().map(|i| g * case.gaps[*i]).collect();
        let other = Problem { compliance: &compliance, gaps: &gaps };
        for solver in [&ActiveSet as &dyn ComplementaritySolver, &Lemke] {
            let forces = solved(solver, &case, None).forces;
            let back: Vec<f64> =
                solver.solve(&other, None).unwrap().forces.iter().map(|p| p * c / g).collect();
            let expected: Vec<f64> = order.iter().map(|i| forces[*i]).collect();
            let off = difference(&expected, &back);
            let limit = f64::max(1e-11, 1e-14 * case.condition());
            prop_assert!(off <= limit * worst(forces.into_iter()), "{}: {off:e}", case.kind);
        }
    }
}
