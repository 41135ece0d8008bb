//! Branches of periodic motions over speed: folds, bifurcations, and what marching makes of them.

use crate::{amplitudes, crossings, shipped};

use amplitudes::{off, rotation};
use crossings::{at, speed};
use dynamics::continuation::{
    ContinuationError, ContinuationOptions, End, Evaluation, Family, Scales, Unkept, trace_both,
};
use experiments::branches::{
    BranchEnd, BranchError, BranchParameter, BranchPoint, BranchPointKind, BranchSettings,
    PeriodicFamily, branch,
};
use experiments::sweep::{
    Direction, FeModel, Memory, MeshLawModel, Plan, SteadyMethod, SteadySettings, SweepError,
    SweepModel, even_speeds, run, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};

fn law<'b>(scene: &Scene, bodies: &'b Bodies, torque_nm: f64) -> MeshLawModel<'b> {
    let case = LoadCase::of_scene(scene).unwrap().with_sun_torque(torque_nm);
    MeshLawModel::new(scene, bodies, case).unwrap()
}

/// OH-58 with three planets under a twenty-fourth of its torque and with a fifth of its damping: where teeth begin to
/// part the response softens and bends over, with an unstable part between two folds. Marching upwards and downwards
/// jumps within one speed step of the folds and is never on the unstable part.
#[test]
fn both_folds_are_traced_and_marching_jumps_there() {
    let scene = shipped::scene("oh58_3p", 70, 0.2);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 50.0);
    let fine = BranchSettings {
        start: 2950.0,
        longest_step: 0.05,
        most_points: 2000,
        ..BranchSettings::over([2790.0, 2960.0])
    };
    let found = branch(&model, &fine).unwrap();
    assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
    let folds: Vec<&BranchPoint> = found.folds().collect();
    println!("{} points", found.points.len());
    for fold in &folds {
        println!("fold at {:.6} rpm: {:?}", speed(fold), fold.multipliers[0]);
        let [re, im] = fold.multipliers[0];
        assert!((re - 1.0).abs() < 1e-4 && im == 0.0, "{:?}", fold.multipliers);
    }
    assert_eq!(folds.len(), 2);
    let (up, down) = (speed(folds[0]), speed(folds[1]));
    assert!(up > down + 40.0 && found.bifurcations().count() == 0);
    // Between the folds, and only there, the motion is unstable.
    let [first, last] = [0, 1].map(|k| found.points.iter().position(|p| p == folds[k]).unwrap());
    for (i, p) in found.points.iter().enumerate() {
        assert!(p.residual < 1e-9, "{}: {:e}", speed(p), p.residual);
        if i != first && i != last {
            assert_eq!(p.is_stable, !(first..last).contains(&i), "{} rpm", speed(p));
        }
    }
    let lost = |p: &&BranchPoint| p.contact_loss > 0.0;
    assert!(found.points.iter().filter(lost).count() > 10);

    // From the other side, and in other scales, the same folds are found.
    let other = branch(&model, &BranchSettings { start: 2800.0, ..fine.clone() }).unwrap();
    let again: Vec<f64> = other.folds().map(speed).collect();
    assert_eq!(again.len(), 2);
    for (a, b) in again.iter().zip([up, down]) {
        println!("fold again at {a:.6} rpm: {:e}", (a - b) / b);
        assert!((a - b).abs() < 1e-6 * b, "{a} {b}");
    }

    let step = 5.0;
    let speeds = even_speeds(2800.0, 2950.0, step).unwrap();
    let settings = SteadySettings {
        method: SteadyMethod::Marching,
        between_cycles: 0,
        most_cycles: 6000,
        ..SteadySettings::default()
    };
    for direction in [Direction::Up, Direction::Down] {
        let mut plan = Plan::new(&speeds, &[direction], settings.clone()).unwrap();
        // One chain all the way.
        let all: Vec<f64> = match direction {
            Direction::Up => speeds.clone(),
            Direction::Down => speeds.iter().rev().copied().collect(),
        };
        plan.chains.truncate(1);
        plan.chains[0].speeds_rpm = all;
        let swept = run(&model, &plan, &Memory, &|_| ()).unwrap();
        let mut jumps = Vec::new();
        let mut was_upper = None;
        for p in &swept.chains[0].1 {
            let rpm = p.state.case.speed_rpm;
            assert!(p.is_steady, "{rpm}");
            let own = rotation(&p.state);
            let motions = at(&found, rpm);
            assert_eq!(motions.len(), if (down..up).contains(&rpm) { 3 } else { 1 }, "{rpm}");
            let nearest = motions
                .iter()
                .enumerate()
                .min_by(|(_, a), (_, b)| off(&own, &a.0).total_cmp(&off(&own, &b.0)));
            let (index, (motion, is_stable)) = nearest.unwrap();
            assert!(*is_stable, "{direction:?} {rpm}: on the unstable part");
            assert!(off(&own, motion) < 1e-2, "{direction:?} {rpm}: {}", off(&own, motion));
            // The last motion along the branch is reached from higher speeds.
            let is_upper = match motions.len() {
                3 => index == 2,
                _ => rpm >= up,
            };
            if was_upper.is_some_and(|was| was != is_upper) {
                jumps.push(rpm);
            }
            was_upper = Some(is_upper);
        }
        println!("{direction:?}: jumps at {jumps:?}, folds at {up:.3} and {down:.3}");
        assert_eq!(jumps.len(), 1);
        let expected = if direction == Direction::Up { up } else { down };
        assert!((jumps[0] - expected).abs() <= step, "{jumps:?} {expected}");
    }
}

/// A point found by shooting at a bound of a branch is the branch's own: the motion of a sweep.
#[test]
fn motions_of_sweeps_lie_on_the_branch() {
    let scene = shipped::scene("oh58_3p", 70, 0.2);
    let bodies = Bodies::new(&scene).unwrap();
    let law = law(&scene, &bodies, 50.0);
    let lumped = law.lumped();
    let mut quasi = scene.clone();
    quasi.dynamics.fidelity = Fidelity::QuasiStatic;
    let fe = |scene: &Scene| {
        FeModel::new(scene, &bodies, Imperfections::default(), law.case().with_sun_torque(500.0))
    };
    let quasi = fe(&quasi);
    let models: [&dyn SweepModel; 3] = [&law, &lumped, &quasi];
    for model in models {
        let ends = [1000.0, 1030.0];
        let found = branch(model, &BranchSettings::over(ends)).unwrap();
        assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound], "{}", model.name());
        let plan = Plan::new(&ends, &[Direction::Up], SteadySettings::default()).unwrap();
        let swept = run(model, &plan, &Memory, &|_| ()).unwrap();
        let own = [&found.points[0], &found.points[found.points.len() - 1]];
        for (p, shot) in own.into_iter().zip(swept.points()) {
            assert!((speed(p) - shot.state.case.speed_rpm).abs() < 1e-9);
            let off = off(&rotation(&p.state), &rotation(&shot.state));
            let change = p.largest_multiplier() - shot.largest_multiplier().unwrap();
            println!("{}, {} rpm: {off:e}, multiplier {change:e}", model.name(), speed(p));
            assert!(off < 1e-6 && change.abs() < 1e-6 && p.is_stable);
            assert!(p.grazing_margin.is_some_and(|margin| (0.0..1.0).contains(&margin)));
        }
    }
}

/// A period doubling by a multiplier that passes −1: below it no motion repeats with the mesh cycle that marching could
/// find, and the branch goes on unstable. (That of `subharmonic.rs`, under a quarter more torque, is at a kink of the
/// branch, over which a multiplier jumps.)
#[test]
fn a_period_doubling_is_located_where_marching_doubles_its_period() {
    let scene = shipped::scene("oh58_3p", 70, 0.1);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 80.0);
    let settings = BranchSettings { start: 4180.0, ..BranchSettings::over([4090.0, 4190.0]) };
    let found = branch(&model, &settings).unwrap();
    assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
    let all: Vec<&BranchPoint> = found.bifurcations().collect();
    assert_eq!((all.len(), found.folds().count()), (1, 0));
    let [re, im] = all[0].multipliers[0];
    println!("period doubling at {:.6} rpm: {re} {im}", speed(all[0]));
    assert_eq!(all[0].kind, BranchPointKind::PeriodDoubling);
    assert!((re + 1.0).abs() < 1e-5 && im == 0.0);
    let critical = speed(all[0]);
    let march = SteadySettings {
        method: SteadyMethod::Marching,
        tolerance: 1e-5,
        most_cycles: 3000,
        between_cycles: 0,
        ..SteadySettings::default()
    };
    assert!(4110.0 < critical && critical < 4180.0);
    for (rpm, period) in [(4180.0, 1), (4110.0, 2)] {
        let mut set = model.turning(&model.case().at_speed(rpm), 0).unwrap();
        set.rest().unwrap();
        let marched = steady(set.as_mut(), 3, 0.0, 70, &march).unwrap();
        assert_eq!(marched.repeats_after, Some(period), "{rpm} rpm");
    }
}

/// A family with one entry of its Jacobian off by 1 %, or none.
struct Off<'m> {
    own: PeriodicFamily<'m>,
    share: f64,
    scales: Vec<f64>,
    evaluations: usize,
}

impl Family for Off<'_> {
    type Error = SweepError;

    fn dimension(&self) -> usize {
        self.own.dimension()
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, SweepError> {
        self.evaluations += 1;
        let mut found = self.own.evaluate(y, lambda)?;
        // The largest entry, scaled.
        let n = found.jacobian.nrows();
        let size = |(i, j): (usize, usize)| {
            (found.jacobian[(i, j)] * self.scales[j] / self.scales[i]).abs()
        };
        let all = (0..n * n).map(|k| (k / n, k % n));
        let largest = all.max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap();
        found.jacobian[largest] *= 1.0 + self.share;
        Ok(found)
    }
}

/// Negative control: with a wrong entry Newton's method converges, if at all, at a rate instead of quadratically. Step
/// control answers with shorter steps, so that the same stretch takes more evaluations.
#[test]
fn a_wrong_entry_of_the_jacobian_shows_in_the_iterations() {
    let scene = shipped::scene("oh58_3p", 70, 0.2);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 500.0);
    let case = model.case().at_speed(1500.0);
    let mut set = model.turning(&case, 0).unwrap();
    set.rest().unwrap();
    steady(set.as_mut(), 3, 0.0, 70, &SteadySettings::default()).unwrap();
    let start = set.derivative().unwrap().coordinates();
    let n = start.len();
    let size = start.iter().take(n / 2).fold(0.0f64, |a, y| a.max(y.abs()));
    let rate = 3.0 * std::f64::consts::TAU * case.mesh_frequency_hz;
    let unknowns = (0..n).map(|i| if i < n / 2 { size } else { rate * size }).collect();
    let scales = Scales { unknowns, parameter: 30.0 };
    let options = ContinuationOptions {
        steps: [0.01, 0.1],
        most_iterations: 60,
        correction: 1e-12,
        ..ContinuationOptions::within([1450.0, 1550.0])
    };
    let count = |share: f64| -> Result<[usize; 2], ContinuationError<SweepError>> {
        let (own, scales) =
            (PeriodicFamily::new(&model, BranchParameter::Speed, 0, n), scales.clone());
        let mut family = Off { own, share, scales: scales.unknowns.clone(), evaluations: 0 };
        let found = trace_both(&mut family, (&start, 1500.0), &scales, &options, &mut Unkept)?;
        assert!(found.ends.iter().all(|end| matches!(end, End::Bound)));
        Ok([family.evaluations, found.points.len()])
    };
    let (right, wrong) = (count(0.0).unwrap(), count(0.01).unwrap());
    println!("{right:?} evaluations and points, {wrong:?} with a wrong entry");
    assert!(wrong[0] > 2 * right[0], "{right:?} {wrong:?}");
}

#[test]
fn what_makes_no_branch_is_refused() {
    let scene = shipped::scene("oh58_3p", 70, 0.1);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 100.0);
    let refused = |settings: BranchSettings| match branch(&model, &settings) {
        Err(error) => error,
        other => panic!("{other:?}"),
    };
    for (range, start) in [
        ([1000.0, 1000.0], 1000.0),
        ([1000.0, 900.0], 950.0),
        ([-1.0, 900.0], 500.0),
        ([800.0, f64::NAN], 850.0),
        ([800.0, 900.0], 950.0),
    ] {
        let settings = BranchSettings { start, ..BranchSettings::over(range) };
        assert!(matches!(refused(settings), BranchError::Range { .. }));
    }
    let few = BranchSettings { most_points: 1, ..BranchSettings::over([800.0, 900.0]) };
    assert!(matches!(refused(few), BranchError::Points(1)));
    let mut full = scene.clone();
    full.dynamics.fidelity = Fidelity::QuasiStatic;
    full.dynamics.kinematics = scene::MeshKinematics::Exact;
    let exact = FeModel::new(&full, &bodies, Imperfections::default(), model.case());
    let error = branch(&exact, &BranchSettings::over([800.0, 900.0])).unwrap_err();
    assert!(matches!(error, BranchError::NoDerivative(_)), "{error}");
}
