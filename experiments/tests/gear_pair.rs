//! Gear pairs in time: the jump of a pair with backlash on lumped and finite-element models, by three tools that share
//! no code but the time step: marching up and down, shooting with continuation, and Floquet multipliers.

use crate::amplitudes;
use crate::crossings;
use crate::shipped;
use crate::tongue;

use std::f64::consts::TAU;

use amplitudes::{off, rotation};
use crossings::{at, speed};
use experiments::branches::{BranchEnd, BranchPoint, BranchSettings, branch};
use experiments::sweep::{
    Coordinate, DampedModel, Direction, FeModel, Memory, MeshLawModel, Part, Plan, SteadyMethod,
    SteadySettings, SweepModel, SweepPoint, even_speeds, run, steady,
};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, pair_cycle};
use gearset::{Facing, MeshKind, MeshLaw, PairFlanks, pair_law};
use lumped::BalancedSet;
use scene::{LoadCase, Scene};

const STEPS: usize = 140;

/// Mean mesh stiffness, N/m.
const K: f64 = 3.0e8;

/// The 50/50 pair, with inertias of the lumped model that give it the natural frequency 2500 Hz at `K`.
fn scene(damping_ratio: f64) -> Scene {
    let omega = TAU * NATURAL_HZ;
    // m_e = J/2r²
    let (radius, m_e) = (0.075 * f64::to_radians(20.0).cos(), K / (omega * omega));
    let inertia = 2.0 * m_e * radius * radius;
    let alpha = 2.0 * damping_ratio * omega;
    let text = format!(
        "{}\n[lumped]\ninertia_kg_m2 = {{ sun = {inertia}, planet = {inertia} }}\n\
         mesh_n_per_m = {{ sun_planet = {K} }}\n\
         [damping]\nmass_proportional_per_s = {alpha}\nstiffness_proportional_s = 0\n\
         [dynamics]\nsteps_per_cycle = {STEPS}\n",
        include_str!("../../scenes/pair_50_50.toml")
    );
    Scene::from_toml(&text).unwrap()
}

const NATURAL_HZ: f64 = 2500.0;

/// k = K (1 + 2 Σ ε_l cos lφ): harmonics of the mesh stiffness. The flanks have a backlash of 0.2 mm and meet
/// within 2 µm, a third of their mean approach.
fn law(epsilon: &[f64]) -> MeshLaw {
    let k = |step: usize| {
        let phi = TAU * step as f64 / STEPS as f64;
        let change = epsilon.iter().zip(1..).map(|(e, l)| 2.0 * e * f64::cos(f64::from(l) * phi));
        K * (1.0 + change.sum::<f64>())
    };
    let flanks = PairFlanks { backlash_m: Some(2e-4), rounding_m: 2e-6 };
    pair_law(&(0..STEPS).map(k).collect::<Vec<_>>(), &[0.0; STEPS], flanks).unwrap()
}

fn lumped(scene: &Scene, epsilon: &[f64]) -> MeshLawModel<'static> {
    let case = LoadCase::of_scene(scene).unwrap();
    MeshLawModel::lumped_with(scene, case, law(epsilon))
}

/// Speed (rpm) at a share of the natural frequency.
fn at_share(share: f64) -> f64 {
    share * NATURAL_HZ * 60.0 / 50.0
}

/// Traces the branch through the primary resonance and marches along it in both directions; checks that a softening
/// jump is where theory has it. Returns the speeds of jump-up (upper fold) and jump-down (lower fold). Where contact is
/// not
/// `is_smooth`, each of the `steps` of a mesh cycle in which teeth begin to part is a corner, at which a fold may be.
fn softening_jump(
    model: &dyn SweepModel,
    range: [f64; 2],
    step: f64,
    (steps, is_smooth): (usize, bool),
) -> [f64; 2] {
    let settings = BranchSettings {
        start: range[1],
        longest_step: 0.05,
        most_points: 3000,
        ..BranchSettings::over(range)
    };
    let found = branch(model, &settings).unwrap();
    assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
    let folds: Vec<&BranchPoint> = found.folds().collect();
    for fold in &folds {
        let ([re, im], at) = (fold.multipliers[0], speed(fold));
        println!("fold at {at:.4} rpm: {re} {im}");
        let i = found.points.iter().position(|p| p == *fold).unwrap();
        let [before, after] = [i - 1, i + 1].map(|i| &found.points[i]);
        let parts_in_one_more = (after.contact_loss - before.contact_loss) * steps as f64;
        if is_smooth || (re - 1.0).abs() < 1e-4 {
            // A multiplier crosses +1.
            assert!((re - 1.0).abs() < 1e-4 && im == 0.0, "{:?}", fold.multipliers);
        } else {
            // It jumps over +1 where teeth part in one step more: the map of the steps has a corner there.
            assert!((parts_in_one_more.abs() - 1.0).abs() < 1e-9, "{parts_in_one_more}");
            let [[low, _], [high, _]] = [before, after].map(|p| p.multipliers[0]);
            assert!(low < 1.0 && high > 1.0 && before.multipliers[0][1] == 0.0, "{low} {high}");
        }
    }
    assert_eq!((folds.len(), found.bifurcations().count()), (2, 0));
    let (up, down) = (speed(folds[0]), speed(folds[1]));
    assert!(up > down + 4.0 * step, "no softening jump: folds at {up} and {down}");
    let [first, last] = [0, 1].map(|k| found.points.iter().position(|p| p == folds[k]).unwrap());
    for (i, p) in found.points.iter().enumerate() {
        if i != first && i != last {
            assert_eq!(p.is_stable, !(first..last).contains(&i), "{} rpm", speed(p));
        }
        // Contact is lost on the upper branch behind the last fold, and teeth stay together on the lower branch.
        if i > last && speed(p) < up {
            assert!(p.contact_loss > 0.0, "{} rpm", speed(p));
        }
        if i < first && speed(p) < down {
            assert_eq!(p.contact_loss, 0.0, "{} rpm", speed(p));
        }
    }

    // Motions at the bounds themselves have one neighbour only.
    let speeds = even_speeds(range[0] + step, range[1] - step, step).unwrap();
    let settings = SteadySettings {
        method: SteadyMethod::Marching,
        between_cycles: 0,
        most_cycles: 6000,
        ..SteadySettings::default()
    };
    for direction in [Direction::Up, Direction::Down] {
        let mut plan = Plan::new(&speeds, &[direction], settings.clone()).unwrap();
        let all: Vec<f64> = match direction {
            Direction::Up => speeds.clone(),
            Direction::Down => speeds.iter().rev().copied().collect(),
        };
        plan.chains.truncate(1);
        plan.chains[0].speeds_rpm = all;
        let swept = run(model, &plan, &Memory, &|_| ()).unwrap();
        assert_eq!(swept.chains[0].1.len(), speeds.len());
        let (mut jumps, mut was_upper) = (Vec::new(), None);
        for p in &swept.chains[0].1 {
            let rpm = p.state.case.speed_rpm;
            assert!(p.is_steady, "{rpm}");
            let (own, motions) = (rotation(&p.state), at(&found, rpm));
            assert_eq!(motions.len(), if (down..up).contains(&rpm) { 3 } else { 1 }, "{rpm}");
            let by_size = |a: &(usize, &([f64; 5], bool)), b: &(usize, &([f64; 5], bool))| {
                off(&own, &a.1.0).total_cmp(&off(&own, &b.1.0))
            };
            let (index, (motion, is_stable)) = motions.iter().enumerate().min_by(by_size).unwrap();
            assert!(*is_stable, "{direction:?} {rpm}: on the unstable part");
            assert!(off(&own, motion) < 2e-2, "{direction:?} {rpm}: {}", off(&own, motion));
            let is_upper = if motions.len() == 3 { index == 2 } else { rpm >= up };
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
    [up, down]
}

#[test]
fn a_lumped_pair_jumps_where_the_folds_of_its_branch_are() {
    let scene = scene(0.05);
    let [up, down] = softening_jump(
        &lumped(&scene, &[0.1]),
        [at_share(0.7), at_share(1.1)],
        10.0,
        (STEPS, true),
    );
    let natural = at_share(1.0);
    println!("natural frequency at {natural} rpm; folds at {up} and {down}");
    assert!(down < up && up < 1.02 * natural);
}

/// Negative control: with so much damping that teeth stay together the resonance has no fold.
#[test]
fn without_contact_loss_there_is_no_jump() {
    let scene = scene(0.2);
    let settings = BranchSettings {
        start: at_share(1.1),
        ..BranchSettings::over([at_share(0.7), at_share(1.1)])
    };
    let found = branch(&lumped(&scene, &[0.1]), &settings).unwrap();
    assert_eq!((found.folds().count(), found.bifurcations().count()), (0, 0));
    assert!(found.points.iter().all(|p| p.is_stable && p.contact_loss == 0.0));
}

/// Harmonic l of the stiffness excites the pair most where l f_m is the natural frequency: superharmonic resonances at
/// a half and a third of it, each led by its own harmonic. The excitation is so small that teeth stay together and the
/// pair is linear but for its changing stiffness; the peaks are then at f_n/l to first order in it.
#[test]
fn superharmonic_resonances_are_at_a_half_and_a_third() {
    let scene = scene(0.02);
    let model = lumped(&scene, &[0.002, 0.002, 0.002]);
    let speeds = even_speeds(at_share(0.25), at_share(0.6), 2.5).unwrap();
    let plan = Plan::new(&speeds, &[Direction::Up], SteadySettings::default()).unwrap();
    let swept = run(&model, &plan, &Memory, &|_| ()).unwrap();
    let points = swept.points();
    assert_eq!(points.len(), speeds.len());
    assert!(points.iter().all(|p| p.is_steady && p.contact_loss == 0.0));
    for harmonic in [2usize, 3] {
        let own = |p: &&experiments::sweep::SweepPoint| {
            p.state.amplitude(Part::SUN, Coordinate::Rotation, harmonic)
        };
        let top = points.iter().copied().max_by(|a, b| own(a).total_cmp(&own(b))).unwrap();
        let rpm = top.state.case.speed_rpm;
        let all = rotation(&top.state);
        println!("harmonic {harmonic} is largest at {rpm} rpm: {all:?}");
        let expected = at_share(1.0 / harmonic as f64);
        assert!((rpm - expected).abs() <= 5.0, "{rpm} {expected}");
        assert!(all.iter().all(|a| *a <= all[harmonic - 1]));
        // |q_l| = 2 ε F/(k_m) / (2ζ) at resonance, F/k_m the mean deflection; the sun turns by half of it.
        let case = model.case();
        let r = 0.075 * f64::to_radians(20.0).cos();
        let mean = case.sun_load_nm() / r / K;
        let amplitude = 2.0 * 0.002 * mean / (2.0 * 0.02) / (2.0 * r);
        assert!((all[harmonic - 1] / amplitude - 1.0).abs() < 0.03, "{all:?} {amplitude:e}");
    }
}

/// The folds of time stepping and of harmonic balance are the same, but for the time step of the one.
#[test]
fn harmonic_balance_finds_the_motion_of_the_upper_branch() {
    let scene = scene(0.05);
    let model = lumped(&scene, &[0.1]);
    let speeds = [at_share(1.05)];
    let plan = Plan::new(&speeds, &[Direction::Up], SteadySettings::default()).unwrap();
    let swept = run(&model, &plan, &Memory, &|_| ()).unwrap();
    let point = swept.points()[0];
    let case = model.case();
    let set = BalancedSet::new(&scene, Facing::CounterClockwise, law(&[0.1]), case.sun_load_nm());
    let balanced =
        set.unwrap().solve(point.state.case.mesh_frequency_hz, None, &Default::default()).unwrap();
    let first = balanced.coordinates[0].lines[1].norm();
    let r = 0.075 * f64::to_radians(20.0).cos();
    // The one coordinate is the relative rotation; each gear has half of it.
    let own = 2.0 * r * rotation(&point.state)[0];
    println!("{first:e} {own:e}");
    assert!((first / own - 1.0).abs() < 2e-3);
}

/// Far below resonance the transmission error in time is that of a mesh cycle at rest with the driven gear held, by
/// another part of the program: mean and peak to peak.
#[test]
fn at_a_low_speed_the_transmission_error_is_the_static_one() {
    let (scene, bodies) = meshed();
    let case = LoadCase::of_scene(&scene).unwrap().at_speed(10.0);
    let radius = bodies.planet.mesh.outline.gear().base_radius;
    let force = case.sun_load_nm() / radius;
    let rest = pair_cycle(&bodies, MeshKind::SunPlanet, force, 70, &ActiveSet).unwrap();
    let fe = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let mut set = fe.turning(&case, 0).unwrap();
    set.rest().unwrap();
    let found = steady(set.as_mut(), fe.shape(), 0.0, 70, &SteadySettings::default()).unwrap();
    // Rotations of sun and of planet 0 after those of carrier and ring.
    let [sun, planet] = [8, 11].map(|channel| found.record.channel(channel));
    let error: Vec<f64> = sun.iter().zip(&planet).map(|(s, p)| radius * (s + p)).collect();
    let mean = error.iter().sum::<f64>() / 70.0;
    let fold = |f: fn(f64, f64) -> f64| error.iter().copied().reduce(f).unwrap();
    let peak_to_peak = fold(f64::max) - fold(f64::min);
    println!("mean {mean:e} {:e}", rest.mean_deflection());
    println!("peak to peak {peak_to_peak:e} {:e}", rest.peak_to_peak());
    assert!((mean / rest.mean_deflection() - 1.0).abs() < 0.01);
    assert!((peak_to_peak / rest.peak_to_peak() - 1.0).abs() < 0.02);
    // Equal gears turn by equal angles.
    assert!(sun.iter().zip(&planet).all(|(s, p)| (s - p).abs() < 1e-9 * s.abs()));
}

/// The catalogue scene on a coarse mesh, and its gears.
fn meshed() -> (Scene, Bodies) {
    let scene = shipped::scene("pair_50_50", 70, 1.0);
    let bodies = Bodies::new(&scene).unwrap();
    (scene, bodies)
}

/// √(k/m_e)/2π with the mean tangent stiffness of the mesh at rest, as a speed of the sun, rpm.
fn natural_rpm(bodies: &Bodies, case: &LoadCase) -> f64 {
    let radius = bodies.planet.mesh.outline.gear().base_radius;
    let force = case.sun_load_nm() / radius;
    let cycle = pair_cycle(bodies, MeshKind::SunPlanet, force, 28, &ActiveSet).unwrap();
    let over_r2 = |inertia: f64| inertia / (radius * radius);
    let (m_s, m_p) =
        (over_r2(bodies.sun.as_ref().unwrap().inertia), over_r2(bodies.planet.inertia));
    let f_n = (cycle.mean_tangent_stiffness() * (m_s + m_p) / (m_s * m_p)).sqrt() / TAU;
    println!(
        "k = {:e} N/m, m_e = {} kg, f_n = {f_n} Hz",
        cycle.mean_tangent_stiffness(),
        m_s / 2.0
    );
    60.0 * f_n / 50.0
}

/// The meshed pair with more damping: both folds of the primary resonance then lie apart from the resonance at half its
/// speed.
fn damped(factor: f64) -> (Scene, Bodies, LoadCase) {
    let (mut scene, bodies) = meshed();
    scene.damping.mass_proportional_per_s *= factor;
    scene.damping.stiffness_proportional_s *= factor;
    let case = LoadCase::of_scene(&scene).unwrap();
    (scene, bodies, case)
}

/// The branch of the pair with meshed teeth, on its mesh law, at twice the scene's damping. The fold at the lower
/// amplitude is where teeth part in seven steps of a cycle instead of six, and a multiplier jumps over 1 instead of
/// passing it. The other fold is smooth, as it is from 1.9 to 2.05 times the damping; from 2.1 times on there is none.
#[test]
fn a_finite_element_pair_jumps_where_the_folds_of_its_branch_are() {
    let (scene, bodies, case) = damped(2.0);
    let natural = natural_rpm(&bodies, &case);
    let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let range = [0.9, 1.05].map(|share| (share * natural).round());
    let [up, down] = softening_jump(&law, range, 5.0, (70, false));
    println!("folds at {} and {} of f_n", up / natural, down / natural);
}

/// Contact solved in every step and the mesh law made from it have two motions over the same range of speeds, of which
/// one loses contact.
#[test]
fn contact_in_every_step_has_the_coexisting_motions_of_the_mesh_law() {
    let (scene, bodies, case) = damped(1.5);
    let natural = natural_rpm(&bodies, &case);
    let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let fe = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let step = 0.02 * natural;
    let speeds = even_speeds(0.6 * natural, 1.1 * natural, step).unwrap();
    let settings = SteadySettings {
        method: SteadyMethod::Marching,
        between_cycles: 0,
        most_cycles: 4000,
        ..SteadySettings::default()
    };
    let ends = [&law as &dyn SweepModel, &fe].map(|model| {
        let both = [Direction::Up, Direction::Down];
        let mut plan = Plan::new(&speeds, &both, settings.clone()).unwrap();
        plan.chains.truncate(2);
        for (chain, direction) in plan.chains.iter_mut().zip(both) {
            chain.speeds_rpm = speeds.clone();
            if direction == Direction::Down {
                chain.speeds_rpm.reverse();
            }
        }
        let swept = run(model, &plan, &Memory, &|_| ()).unwrap();
        let coexisting = swept.coexisting_rpm();
        let shares: Vec<f64> = coexisting.iter().map(|n| n / natural).collect();
        println!("{}: two motions at {shares:?} of f_n", model.name());
        for rpm in &coexisting {
            let here = swept.points().into_iter().filter(|p| p.state.case.speed_rpm == *rpm);
            let lost: Vec<f64> = here.map(|p| p.contact_loss).collect();
            let most = lost.iter().fold(0.0f64, |a, l| a.max(*l));
            assert!(lost.len() == 2 && most > 0.1, "{rpm}: {lost:?}");
        }
        [coexisting[0], coexisting[coexisting.len() - 1]]
    });
    let [law, contact] = ends;
    assert!(law[1] > law[0] + 2.0 * step);
    // The range of two motions ends within that of the speeds.
    assert!([law, contact].iter().all(|ends| ends[0] > speeds[0]));
    for (a, b) in law.iter().zip(contact) {
        assert!((a - b).abs() <= 1.01 * step, "{law:?} {contact:?}");
    }
}

/// Superharmonic resonances: the harmonics 2 and 3 of the transmission error have a local maximum where the harmonic is
/// at the natural frequency. Where teeth part the peak is bent to lower speeds.
#[test]
fn superharmonic_resonances_of_the_finite_element_pair() {
    let (scene, bodies) = meshed();
    let case = LoadCase::of_scene(&scene).unwrap();
    let natural = natural_rpm(&bodies, &case);
    let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
    for harmonic in [2usize, 3] {
        let own = natural / harmonic as f64;
        let speeds = even_speeds(0.8 * own, 1.2 * own, 0.01 * own).unwrap();
        let plan = Plan::new(&speeds, &[Direction::Up], SteadySettings::default()).unwrap();
        let swept = run(&law, &plan, &Memory, &|_| ()).unwrap();
        let list: Vec<(f64, f64)> = swept
            .points()
            .iter()
            .map(|p| {
                let size = p.state.amplitude(Part::SUN, Coordinate::Rotation, harmonic);
                (p.state.case.speed_rpm / own, size)
            })
            .collect();
        let (at, top) = list.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        let ends = [list[0].1, list[list.len() - 1].1];
        println!(
            "harmonic {harmonic}: {top:e} rad at {at} of f_n/{harmonic}, at the ends {ends:?}"
        );
        assert!((0.88..1.05).contains(&at), "{at}");
        assert!(ends.iter().all(|end| top > 2.0 * end), "{top} {ends:?}");
    }
}

/// FE/contact inside and outside a tongue of parametric instability: about twice the natural frequency the motion that
/// repeats with the mesh cycle is unstable, and its period doubles at the borders. They are those of Hill's equation
/// with the mesh stiffness along the motion. (With the stiffness under a constant load, as at rest, the tongue would be
/// a fifth narrower.) Of the lower border the mesh law with 70, 140 and 280 steps, and as many positions of its table,
/// is 1.0e-3, 4.5e-4 and 4e-5 off.
#[test]
fn a_finite_element_pair_is_unstable_inside_its_tongue_only() {
    let (mut scene, bodies) = meshed();
    scene.dynamics.steps_per_cycle = 140;
    let case = LoadCase::of_scene(&scene).unwrap();
    let model = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let natural = natural_rpm(&bodies, &case);
    let range = [1.85 * natural, 2.15 * natural];
    let borders = |model: &dyn SweepModel, factor: f64| -> Vec<f64> {
        let settings = BranchSettings { start: range[0], ..BranchSettings::over(range) };
        let found = branch(&DampedModel { model, factor }, &settings).unwrap();
        assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
        let at: Vec<f64> = found.bifurcations().map(speed).collect();
        for p in found.points.iter().filter(|p| at.iter().all(|s| (speed(p) - s).abs() > 0.1)) {
            let is_inside = at.len() == 2 && speed(p) > at[0] && speed(p) < at[1];
            assert_eq!(p.is_stable, !is_inside, "{} rpm", speed(p));
            assert_eq!(p.contact_loss, 0.0);
        }
        at
    };
    let nearly_undamped = 0.02;
    let [low, high] = borders(&model, nearly_undamped)[..] else { panic!("no tongue") };

    // k along the motion at either border, from contact solved at its deflections.
    let hill = [low, high].map(|border| {
        let settings =
            BranchSettings { start: border, most_points: 2, ..BranchSettings::over(range) };
        let own =
            branch(&DampedModel { model: &model, factor: nearly_undamped }, &settings).unwrap();
        let at = own
            .points
            .iter()
            .min_by(|a, b| (speed(a) - border).abs().total_cmp(&(speed(b) - border).abs()));
        tongue::Hill::along(at.unwrap(), &bodies, case.sun_load_nm())
    });
    let [exact_low, exact_high] = [hill[0].borders()[0], hill[1].borders()[1]];
    println!("{low} {high}, Hill along the motion {exact_low} {exact_high}");
    // 140 steps lower a frequency of half the mesh frequency by (π/140)²/12 = 4e-5; the table of the law adds its own
    // part.
    let (half, exact_half) = (0.5 * (high - low), 0.5 * (exact_high - exact_low));
    assert!((low / exact_low - 1.0).abs() < 1e-3 && (high / exact_high - 1.0).abs() < 1e-3);
    assert!((half / exact_half - 1.0).abs() < 0.03, "{half} {exact_half}");
    let centre = 0.5 * (low + high);
    let hill = &hill[0];
    // To first order Ω = 2ω ± ω h/2 with k = k̄ (1 + h cos Ωt); the next terms are of h².
    for (first, exact) in hill.first_order().into_iter().zip(hill.borders()) {
        assert!((first / exact - 1.0).abs() < hill.h() * hill.h(), "{first} {exact}");
    }

    // Contact solved in every step instead of looked up.
    let solved = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let [solved_low, solved_high] = borders(&solved, nearly_undamped)[..] else {
        panic!("no tongue")
    };
    println!("contact solved: {solved_low} {solved_high}");
    assert!((solved_low / low - 1.0).abs() < 1e-3 && (solved_high / high - 1.0).abs() < 1e-3);

    // Damping closes it from 4ζ = h on: half of that, and twice.
    let omega = 0.5 * TAU * case.at_speed(centre).mesh_frequency_hz;
    let d = scene.damping;
    let zeta = 0.5 * (d.mass_proportional_per_s / omega + d.stiffness_proportional_s * omega);
    let closing = 0.25 * hill.h() / zeta;
    assert_eq!(borders(&model, 0.5 * closing).len(), 2);
    assert!(borders(&model, 2.0 * closing).is_empty());
}

/// Harmonic l meets a mode at y/tan y of its frequency, y = πl/S with S steps in a cycle: a pair of constant stiffness
/// that harmonic 5 of an unloaded transmission error excites, found by marching and shooting alike.
#[test]
fn a_resonance_is_where_the_steps_in_a_cycle_put_it() {
    const HARMONIC: usize = 5;
    for steps in [42usize, 70, 140] {
        let (zeta, y) = (0.005, std::f64::consts::PI * HARMONIC as f64 / steps as f64);
        let mut scene = scene(zeta);
        scene.dynamics.steps_per_cycle = steps as u32;
        let wave = |step: usize| 1e-8 * f64::cos(TAU * (HARMONIC * step) as f64 / steps as f64);
        let excitation: Vec<f64> = (0..steps).map(wave).collect();
        let flanks = PairFlanks { backlash_m: None, rounding_m: 0.0 };
        let law = pair_law(&vec![K; steps], &excitation, flanks).unwrap();
        let model = MeshLawModel::lumped_with(&scene, LoadCase::of_scene(&scene).unwrap(), law);
        // 1/A² of a mode is a parabola over the square of the speed.
        let expected = at_share(1.0 / HARMONIC as f64) * y / y.tan();
        let squares = [-zeta, 0.0, zeta].map(|part| (1.0 + part).powi(2));
        let values = squares.map(|square| {
            let case = model.case().at_speed(expected * square.sqrt());
            let mut set = model.turning(&case, 0).unwrap();
            set.rest().unwrap();
            let settings = SteadySettings::default();
            let found = steady(set.as_mut(), model.shape(), 0.0, steps, &settings).unwrap();
            let point = SweepPoint::new(case, &found, &settings, 0).unwrap();
            point.state.amplitude(Part::SUN, Coordinate::Rotation, HARMONIC).powi(-2)
        });
        let [a, b, c] = squares;
        let [fa, fb, fc] = values;
        let (slope, other) = ((fb - fa) / (b - a), (fc - fb) / (c - b));
        let curvature = (other - slope) / (c - a);
        let peak = 0.5 * (a + b) - 0.5 * slope / curvature;
        let off = peak.sqrt() - 1.0;
        println!("{steps} steps: y/tan y = {:.5}, off {off:.1e}", y / y.tan());
        // Damping lowers it by ζ²; atan(y)/y would be 4e-3 (42 steps), 6e-4 (70) and 4e-5 (140) higher.
        assert!((off + zeta * zeta).abs() < 1e-5, "{steps} steps: {off:e}");
    }
}
