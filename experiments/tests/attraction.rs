//! Motions that sweeps report as steady attract, also where shooting and repeating cycles find unstable ones.

use crate::shipped;

use experiments::sweep::{
    Attraction, Coordinate, Direction, FeModel, Marching, Memory, MeshLawModel, Part, Plan, Record,
    SearchStart, SteadyMethod, SteadySettings, Sweep, SweepModel, SweepPoint, run,
};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{LoadCase, Scene};

fn swept(model: &dyn SweepModel, speeds: &[f64], to: Direction, method: SteadyMethod) -> Sweep {
    let steady = SteadySettings { method, between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan::new(speeds, &[to], steady).unwrap();
    run(model, &plan, &Memory, &|_| ()).unwrap().complete().unwrap()
}

/// The catalogue pair with 4 µm of backlash and half the damping at 60 N·m. At 3400 rpm, coming down, shooting
/// finds a motion of 46 µrad with a multiplier of 1.4. An independent model with one degree of freedom ends from
/// 400 random starts at 8.0, 38.9 or 78.8 µrad and nowhere else.
fn pair_with_little_backlash() -> Scene {
    let text = include_str!("../../scenes/pair_50_50.toml")
        .replace("sun_planet_backlash_mm = 0.1", "sun_planet_backlash_mm = 0.004");
    let mut scene = Scene::from_toml(&text).unwrap();
    scene.damping.mass_proportional_per_s = 71.45;
    scene.damping.stiffness_proportional_s = 1.105e-6;
    scene.dynamics.steps_per_cycle = 280;
    scene
}

#[test]
fn a_pair_with_two_sided_contact_ends_at_motions_that_attract() {
    let scene = pair_with_little_backlash();
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(60.0);
    let model = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let speeds = [3400.0, 3600.0, 3800.0, 4000.0, 4200.0];
    for method in [SteadyMethod::Shooting, SteadyMethod::Marching] {
        let found = swept(&model, &speeds, Direction::Down, method);
        let points = found.points();
        assert!(points.iter().all(|p| p.is_steady && p.attracts == Attraction::ByMultipliers));
        assert!(points.iter().all(|p| p.largest_multiplier().unwrap() < 1.0));
        let microrad = 1e6 * points[0].state.amplitude(Part::SUN, Coordinate::Rotation, 1);
        let nearest = [8.0f64, 38.9, 78.8].map(|own| (microrad / own - 1.0).abs());
        println!("{method:?}: {microrad} µrad");
        assert!(nearest.iter().any(|off| *off < 0.015), "{method:?}: {microrad} µrad");
        assert!(matches!(points[0].start, SearchStart::Speed(3600.0) | SearchStart::Unstable));
    }
}

/// At 3600 rpm three motions of that pair attract. Sweeps that share this speed list the same three, whatever
/// other speeds they have, although they arrive at different ones.
#[test]
fn sweeps_with_random_starts_list_the_same_motions_at_a_speed_they_share() {
    let scene = pair_with_little_backlash();
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(60.0);
    let model = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let steady = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let [alone, among] = [vec![3600.0], vec![3400.0, 3600.0, 4200.0]].map(|speeds| {
        let plan = Plan::new(&speeds, &[Direction::Down], steady.clone()).unwrap();
        let found = run(&model, &plan.with_random_starts(12), &Memory, &|_| ()).unwrap();
        let here = found.attractors().into_iter().find(|own| own.speed_rpm == 3600.0).unwrap();
        let amplitude = |chain: &str| {
            let points = found.by_speed();
            let (_, p) = points
                .iter()
                .find(|(name, p)| *name == chain && p.state.case.speed_rpm == 3600.0)
                .unwrap();
            1e6 * p.state.amplitude(Part::SUN, Coordinate::Rotation, 1)
        };
        assert!(found.coexisting_rpm().contains(&3600.0));
        let arrived = amplitude("down_00");
        let mut all: Vec<f64> = here.motions.iter().map(|m| amplitude(&m.chains[0])).collect();
        all.sort_by(f64::total_cmp);
        (arrived, all)
    });
    println!("{alone:?} {among:?}");
    assert!((alone.0 / among.0 - 1.0).abs() > 0.1);
    assert_eq!((alone.1.len(), among.1.len()), (3, 3));
    assert!(alone.1.iter().zip(&among.1).all(|(a, b)| (a / b - 1.0).abs() < 1e-3));
}

/// What the steps are said to change of a strong harmonic near a resonance is what four times as many change, and
/// up to half of that more; with the steps that are named it is not said.
#[test]
#[ignore = "long: .ci/full runs it"]
fn the_error_of_the_steps_is_that_seen_with_more_of_them() {
    let at = |name: &str, steps: u32, rpm: f64| {
        let scene = shipped::scene(name, steps, 1.0);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
        let found = swept(&model, &[rpm], Direction::Up, SteadyMethod::Shooting);
        found.points()[0].clone()
    };
    for (name, rpm, least) in
        [("oh58_3p", 650.0, 0.09), ("oh58_4p", 950.0, 0.09), ("oh58_4p", 1200.0, 0.08)]
    {
        let coarse = at(name, 140, rpm);
        let estimate = coarse.step_error.unwrap();
        let fine = at(name, 560, rpm);
        let [a, b] = [&coarse, &fine].map(|p| {
            let of = |coordinate| {
                let lines = p.state.with_translations();
                let mut lines = lines.into_iter();
                let line = lines.find(|l| {
                    l.part == Part::SUN
                        && l.coordinate == coordinate
                        && l.harmonic == estimate.harmonic
                });
                line.map_or(0.0, |l| l.amplitude)
            };
            [of(Coordinate::Rotation), of(Coordinate::Translation)]
        });
        let changes = a.iter().zip(b).map(|(a, b)| (a / b - 1.0).abs());
        // A harmonic that is rounding in one of the two is left out.
        let changes = changes.zip(a).filter(|(_, a)| *a > 1e-9).map(|(change, _)| change);
        let seen = changes.fold(0.0, f64::max);
        println!("{name}, {rpm} rpm: {seen:.4} seen, {estimate:?}");
        assert!(
            seen > least && estimate.share > seen && estimate.share < 1.5 * seen,
            "{seen} {estimate:?}"
        );
        assert!(at(name, estimate.steps as u32, rpm).step_error.is_none());
    }
}

/// Largest change over two marches of some cycles, one of them pushed, relative to the vibration: at first and at
/// the end.
fn after_a_push(set: &mut dyn Marching, point: &SweepPoint, steps: usize) -> [f64; 2] {
    let cycles = 40 * point.repeats_after.unwrap();
    let state = set.state();
    let counters = set.counters();
    let mut ends = Vec::new();
    for push in [0.0, 1e-7] {
        let mut pushed = state.clone();
        pushed.iter_mut().skip(counters).for_each(|x| *x *= 1.0 + push);
        set.restore(&pushed).unwrap();
        let (mut first, mut last) = (Record::new(3), Record::new(3));
        first.march(set, 0.0, steps).unwrap();
        (1..cycles).for_each(|_| last.march(set, 0.0, steps).unwrap());
        ends.push([first, last]);
    }
    [0, 1].map(|k| ends[1][k].change_from(&ends[0][k]))
}

/// OH-58 with three planets at a tenth of its damping, where teeth part: shooting finds unstable motions at some
/// speeds. What is reported repeats, after one cycle or several, and a push off it decays.
#[test]
fn what_a_sweep_finds_where_teeth_part_attracts() {
    let steps = 70;
    let scene = shipped::scene("oh58_3p", steps as u32, 0.1);
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    let fe = FeModel::new(&scene, &bodies, Imperfections::default(), case.with_sun_torque(50.0));
    let law = MeshLawModel::new(&scene, &bodies, case.with_sun_torque(100.0)).unwrap();
    let runs: [(&dyn SweepModel, &[f64]); 2] =
        [(&fe, &[2250.0, 2400.0, 2700.0, 2800.0]), (&law, &[4100.0, 4120.0, 4145.0, 4300.0])];
    let (mut left, mut several) = (0, 0);
    for (model, speeds) in runs {
        let states = std::sync::Mutex::new(Vec::new());
        let steady = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
        let plan = Plan::new(speeds, &[Direction::Down], steady).unwrap();
        let keep = |kept: &experiments::sweep::Kept| {
            if let experiments::sweep::Kept::Found { point, state } = kept {
                states.lock().unwrap().push(((**point).clone(), state.clone()));
            }
        };
        run(model, &plan, &Memory, &keep).unwrap().complete().unwrap();
        for (point, state) in states.into_inner().unwrap() {
            let rpm = point.state.case.speed_rpm;
            let (repeats, attracts) = (point.repeats_after, point.attracts);
            println!("{} {rpm} rpm: {repeats:?} {attracts:?}, {:?}", model.name(), point.start);
            left += usize::from(point.why_marched.is_some());
            if !attracts.is_shown() {
                assert!(!point.is_steady && repeats.is_none());
                continue;
            }
            several += usize::from(repeats != Some(1));
            assert_eq!(point.is_steady, repeats == Some(1));
            let mut set = model.turning(&point.state.case, point.size).unwrap();
            set.restore(&state).unwrap();
            let [first, last] = after_a_push(set.as_mut(), &point, steps);
            let expected = point.largest_multiplier().unwrap().powi(39);
            assert!(first > 1e-9 && last < 5.0 * expected * first, "{rpm}: {first:e} {last:e}");
        }
    }
    assert!(left > 0 && several > 0, "{left} marched, {several} repeat after several cycles");
}

/// OH-58 with three planets below 30 rpm, where 140 steps in a mesh cycle are longer than the periods of most
/// natural modes: the answer is that of four times the steps, whatever speeds were asked before.
#[test]
#[ignore = "long: .ci/full runs it"]
fn slow_sets_have_the_motion_of_shorter_steps() {
    let of = |steps: u32, speeds: &[f64]| {
        let scene = shipped::scene("oh58_3p", steps, 1.0);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
        swept(&model, speeds, Direction::Up, SteadyMethod::Shooting)
    };
    let rotation = |p: &SweepPoint| p.state.amplitude(Part::SUN, Coordinate::Rotation, 1);
    let speeds = [5.0, 15.0, 40.0, 100.0];
    let (together, fine) = (of(140, &speeds), of(560, &speeds));
    for (a, b) in together.points().iter().zip(fine.points()) {
        let rpm = a.state.case.speed_rpm;
        let alone = of(140, &[rpm]);
        let sizes = [a, &b, &alone.points()[0]].map(|p| p.largest_multiplier().unwrap());
        let amplitudes = [a, &b, &alone.points()[0]].map(|p| 1e6 * rotation(p));
        println!("{rpm} rpm: {amplitudes:?} µrad, multipliers {sizes:?}");
        assert!(a.is_steady && b.is_steady && a.contact_loss == 0.0);
        for k in [1, 2] {
            assert!((amplitudes[k] / amplitudes[0] - 1.0).abs() < 0.01, "{rpm}");
            assert!((sizes[k] - sizes[0]).abs() < 0.01, "{rpm}");
        }
    }
}
