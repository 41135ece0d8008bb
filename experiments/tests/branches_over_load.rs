//! Branches over torque and damping, what they hold fixed, and branches that leave others.

use crate::{amplitudes, shipped};

use amplitudes::{off, rotation};
use dynamics::continuation::Family;
use experiments::branches::{
    BranchEnd, BranchError, BranchOrigin, BranchParameter, BranchPoint, BranchPointKind,
    BranchSettings, PARAMETER_CHANGE, PeriodicFamily, branch, branches,
};
use experiments::sweep::{
    FeModel, MeshLawModel, SteadyMethod, SteadySettings, SweepError, SweepModel, SweepPoint, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{LoadCase, Scene};

const STEPS: usize = 70;

fn scene(damping: f64) -> Scene {
    let mut scene = shipped::scene("oh58_3p", STEPS as u32, damping);
    scene.damping.bearing_s *= damping;
    scene
}

fn law<'b>(scene: &Scene, bodies: &'b Bodies, torque_nm: f64, rpm: f64) -> MeshLawModel<'b> {
    let case = LoadCase::of_scene(scene).unwrap().with_sun_torque(torque_nm).at_speed(rpm);
    MeshLawModel::new(scene, bodies, case).unwrap()
}

/// The motion that a march from rest arrives at.
fn marched(model: &dyn SweepModel, case: LoadCase, most_cycles: usize) -> SweepPoint {
    let settings = SteadySettings {
        method: SteadyMethod::Marching,
        tolerance: 1e-9,
        most_cycles,
        between_cycles: 0,
        ..SteadySettings::default()
    };
    let mut set = model.turning(&case, 0).unwrap();
    set.rest().unwrap();
    let found = steady(set.as_mut(), 3, 0.0, STEPS, &settings).unwrap();
    SweepPoint::new(case, &found, &settings, 0).unwrap()
}

/// The first and last point and the one at the start.
fn three(points: &[BranchPoint], start: f64) -> [&BranchPoint; 3] {
    let middle = points.iter().find(|p| p.parameter == start).unwrap();
    [&points[0], middle, &points[points.len() - 1]]
}

/// Along a branch over torque the law of the meshes stays that of the middle torque. Under each torque the motion is
/// that which the same model marches to from rest; a model made under that torque differs, the less the nearer the
/// torques of both models: the difference is due to what is held fixed and to nothing else.
#[test]
fn a_branch_over_torque_is_that_of_steady_states_about_one_reference() {
    let scene = scene(1.0);
    let bodies = Bodies::new(&scene).unwrap();
    let (rpm, range) = (1500.0, [300.0, 500.0]);
    let model = law(&scene, &bodies, 400.0, rpm);
    let found = branch(&model, &BranchSettings::along(BranchParameter::Torque, range)).unwrap();
    assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
    assert!(found.points.len() > 3);
    let mut effects = Vec::new();
    for p in three(&found.points, 400.0) {
        let torque = p.parameter;
        assert!((p.state.case.sun_torque_nm - torque).abs() < 1e-9 * torque);
        assert_eq!((p.state.case.speed_rpm, p.damping_factor), (rpm, 1.0));
        let case = model.case().with_sun_torque(torque);
        let own = marched(&model, case, 2000);
        let same = off(&rotation(&own.state), &rotation(&p.state));
        let scratch = law(&scene, &bodies, torque, rpm);
        let other = marched(&scratch, scratch.case(), 2000);
        let effect = off(&rotation(&other.state), &rotation(&p.state));
        println!("{torque} N·m: {same:e} off the same reference, {effect:e} off the own one");
        assert!(same < 1e-6, "{torque}: {same:e}");
        effects.push(effect);
    }
    // About the own reference nothing differs; on either side something does.
    assert!(effects[1] < 1e-6, "{effects:?}");
    // A reference half as far away leaves about half of the difference.
    let nearer = law(&scene, &bodies, 350.0, rpm);
    let (scratch, torque) = (law(&scene, &bodies, 300.0, rpm), 300.0);
    let at = |model: &MeshLawModel<'_>| {
        rotation(&marched(model, model.case().with_sun_torque(torque), 2000).state)
    };
    let half = off(&at(&scratch), &at(&nearer));
    println!("reference 50 N·m away: {half:e}, 100 N·m away: {:e}", effects[0]);
    assert!((0.3..0.7).contains(&(half / effects[0])), "{half:e} {:e}", effects[0]);
}

/// Over damping nothing is held fixed that depends on it: every point is that of a scene with so much damping.
#[test]
fn a_branch_over_damping_is_that_of_scenes_with_other_damping() {
    let own = scene(1.0);
    let bodies = Bodies::new(&own).unwrap();
    let model = law(&own, &bodies, 400.0, 1500.0);
    let settings = BranchSettings::along(BranchParameter::Damping, [0.4, 1.2]);
    let found = branch(&model, &settings).unwrap();
    assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
    for p in three(&found.points, 0.8) {
        let other = scene(p.parameter);
        let scratch = law(&other, &bodies, 400.0, 1500.0);
        let marched = marched(&scratch, scratch.case(), 4000);
        let off = off(&rotation(&marched.state), &rotation(&p.state));
        println!("damping × {}: {off:e}", p.damping_factor);
        assert_eq!(p.parameter, p.damping_factor);
        assert!(off < 1e-6 && p.is_stable, "{off:e}");
    }
    // Less damping, larger multipliers.
    let ends = [0, found.points.len() - 1].map(|i| found.points[i].largest_multiplier());
    assert!(ends[0] > ends[1] + 0.01, "{ends:?}");
}

/// ∂F/∂λ by central differences does not depend on their step.
#[test]
fn derivatives_in_the_parameter_are_the_same_over_two_steps() {
    let scene = scene(1.0);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 400.0, 1500.0);
    let mut set = model.turning(&model.case(), 0).unwrap();
    set.rest().unwrap();
    steady(set.as_mut(), 3, 0.0, STEPS, &SteadySettings::default()).unwrap();
    let y = set.derivative().unwrap().coordinates();
    for (over, value) in [
        (BranchParameter::Speed, 1500.0),
        (BranchParameter::Torque, 400.0),
        (BranchParameter::Damping, 1.0),
    ] {
        let at = |change: f64| {
            let family = PeriodicFamily::new(&model, over, 0, y.len());
            family.with_change(change).evaluate(&y, value).unwrap().derivative
        };
        let [own, ten] = [at(PARAMETER_CHANGE), at(10.0 * PARAMETER_CHANGE)];
        // Displacements, then velocities: each half by itself.
        let n = y.len() / 2;
        for kind in 0..2 {
            let [a, b] = [own.rows(kind * n, n), ten.rows(kind * n, n)];
            let off = (a - b).amax() / a.amax();
            println!("{over:?}, half {kind}: {off:e}");
            assert!(a.amax() > 0.0 && off < 1e-4, "{over:?}: {off:e}");
        }
    }
}

/// Off the period doubling of `branches.rs` leaves a branch of motions that repeat after two mesh cycles. Below it
/// marching arrives at these.
#[test]
fn motions_that_repeat_after_two_cycles_are_followed_off_a_period_doubling() {
    let scene = scene(0.1);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 80.0, 4200.0);
    let settings = BranchSettings {
        start: 4180.0,
        longest_step: 0.02,
        ..BranchSettings::over([4090.0, 4190.0])
    };
    let found = branches(&model, &settings).unwrap();
    println!("{:?} {:?}", found.not_followed, found.coexisting());
    assert!(found.not_followed.is_empty());
    let all: Vec<_> = found.branches.iter().filter(|b| b.repeats_after == 2).collect();
    assert_eq!((found.branches.len(), all.len()), (2, 1));
    let BranchOrigin::PeriodDoubling(at) = all[0].origin else { panic!("{:?}", all[0].origin) };
    assert!((at - 4122.66).abs() < 0.01, "{at}");
    println!("off {at}: {} points to {:?}", all[0].points.len(), all[0].ends);
    for p in &all[0].points {
        assert!(p.residual < 1e-8, "{:e}", p.residual);
        assert!(p.between.is_some_and(|share| share > 0.0), "{:?}", p.between);
    }
    // It ends at the bound of the speeds, with more energy between harmonics than anywhere before. (Before steps on
    // which the sense of the branch changes were refused, it fell back onto itself at 4108 rpm and returned to the
    // doubling.)
    assert_eq!(all[0].ends, [BranchEnd::Origin, BranchEnd::Bound]);
    let share = |p: &BranchPoint| p.between.unwrap();
    let most = all[0].points.iter().map(share).fold(0.0f64, f64::max);
    let (first, last) = (&all[0].points[0], &all[0].points[all[0].points.len() - 1]);
    for p in [first, last] {
        println!("end at {}: {:e} of {most:e}", p.parameter, share(p));
    }
    assert!(
        (first.parameter - at).abs() < 1.0 && share(first) < 0.01 * most && share(first) > 1e-15
    );
    assert!(last.parameter == 4090.0 && share(last) == most);
    // A located point is one at which stability is about to change.
    let is_sound = |p: &&BranchPoint| {
        p.is_stable && p.kind == BranchPointKind::Regular && p.parameter < at - 1.0
    };
    let mut sound: Vec<&BranchPoint> = all[0].points.iter().filter(is_sound).collect();
    sound.sort_by(|a, b| a.parameter.total_cmp(&b.parameter));
    sound.dedup_by(|a, b| (a.parameter - b.parameter).abs() < 1.0);
    let march = SteadySettings {
        method: SteadyMethod::Marching,
        tolerance: 1e-6,
        most_cycles: 6000,
        between_cycles: 0,
        ..SteadySettings::default()
    };
    // Where one motion after another is stable, marching from speed to speed stays on it: down from before the
    // doubling.
    let mut state: Option<Vec<f64>> = None;
    let above = std::iter::once((at + 2.0, None));
    let mut met = 0;
    for (rpm, own) in above.chain(sound.iter().rev().map(|p| (p.parameter, Some(*p)))) {
        let case = model.case().at_speed(rpm);
        let mut set = model.turning(&case, 0).unwrap();
        match &state {
            Some(state) => set.restore(state).unwrap(),
            None => set.rest().unwrap(),
        }
        let swept = steady(set.as_mut(), 3, 0.0, STEPS, &march).unwrap();
        state = Some(set.state());
        let repeats_after = swept.repeats_after;
        let Some(p) = own else { continue };
        let swept = SweepPoint::new(case, &swept, &march, 0).unwrap();
        let [own, other] = [&p.contact_loss, &swept.contact_loss];
        let force = (swept.lowest_force_n - p.lowest_force_n).abs();
        println!("{rpm} rpm: {repeats_after:?} cycles, loss {other}, {own}; {force} N");
        let is_met = (own - other).abs() < 2.0 / STEPS as f64 && force < 0.01;
        met += i32::from(repeats_after == Some(2) && is_met && *own > 0.0);
    }
    assert!(met > 0);
}

#[test]
fn torques_and_factors_that_make_no_branch_are_refused() {
    let scene = scene(1.0);
    let bodies = Bodies::new(&scene).unwrap();
    let model = law(&scene, &bodies, 400.0, 1500.0);
    for (over, range) in [
        (BranchParameter::Torque, [-100.0, 100.0]),
        (BranchParameter::Torque, [0.0, 100.0]),
        (BranchParameter::Torque, [100.0, f64::INFINITY]),
        (BranchParameter::Damping, [0.0, 1.0]),
        (BranchParameter::Damping, [1.0, 0.5]),
    ] {
        let settings = BranchSettings::along(over, range);
        match branch(&model, &settings) {
            Err(BranchError::Range { .. }) => {}
            other => panic!("{over:?} {range:?}: {other:?}"),
        }
    }
    // The other flanks are not those that the model was made for.
    let settings = BranchSettings::along(BranchParameter::Torque, [-300.0, -200.0]);
    let error = branch(&model, &settings).unwrap_err();
    assert!(matches!(error, BranchError::Sweep(SweepError::OtherFlanks { .. })), "{error}");
}

/// The catalogue's pair at a speed at which it has two stable motions between two torques a seventh apart: both folds
/// are found whatever the range of torques is. With the whole vibration as unit of arc the branch from 100 to 180 N·m
/// falls onto itself.
#[test]
#[ignore = "long: .ci/full runs it"]
fn folds_over_torque_do_not_depend_on_the_range() {
    let scene = shipped::scene("pair_50_50", 140, 2.0);
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(150.0).at_speed(3970.0);
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let folds = |range: [f64; 2]| -> Vec<f64> {
        let found = branch(&model, &BranchSettings::along(BranchParameter::Torque, range)).unwrap();
        assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound], "{range:?}");
        let mut folds: Vec<f64> = found.folds().map(|p| p.parameter).collect();
        folds.sort_by(f64::total_cmp);
        folds
    };
    let first = folds([100.0, 160.0]);
    assert_eq!(first.len(), 2, "{first:?}");
    assert!(first[1] > 1.1 * first[0] && first[1] < 1.2 * first[0], "{first:?}");
    for high in [180.0, 200.0, 240.0, 300.0, 340.0, 380.0] {
        for low in [60.0, 100.0] {
            let own = folds([low, high]);
            println!("{low} to {high} N·m: {own:?}");
            assert_eq!(own.len(), 2, "{low} to {high} N·m: {own:?}");
            assert!(
                own.iter().zip(&first).all(|(a, b)| (a / b - 1.0).abs() < 1e-5),
                "{low} to {high} N·m: {own:?}"
            );
        }
    }
}
