//! Steady states by shooting against marching to the same residual.
//!
//! - **Two resonances** of l = 1, 586 Hz, at which teeth stay in contact, and 780 Hz, at which they part below 1 % of
//!   damping, with 2, 0.5 and 0.2 %, from the steady state 1 % below: cycles, derivatives and CPU time of shooting and
//!   of marching alone, in turns in one process; the ratios are those of the times, and of the steps of marching to
//!   those of shooting. Shooting computes the stability of the motion as well: the ratio of the motion alone leaves out
//!   the time of the eigenvalues of the last derivative, which shows the change of the next cycle too, and of the
//!   eigenvector of the largest.
//! - **The default sweep** of 97 speeds, four planets, set-up shared: shooting against marching with the multipliers of
//!   its end.
//! - **Prices**: the first cycle at a new speed, a later one, a derivative, and one for corrections (in single
//!   precision).
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench steady_states`; arguments `resonance`, `sweep`, `prices` choose parts.

use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;

use dynamics::{floquet_vector, multipliers};
use experiments::sweep::{
    Direction, FeModel, Memory, MeshLawModel, Plan, Record, SteadyMethod, SteadySettings,
    SweepModel, even_speeds, run, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::Along;
use scene::{LoadCase, Scene};

const TORQUE: f64 = 1413.0;

/// Speeds of the resonances, each with that of the steady state from which all start, rpm.
const RESONANCES: [[f64; 2]; 2] = [[1658.0, 1641.0], [2205.0, 2183.0]];

const ROUNDS: usize = 5;

/// Cycles after which marching is given up: the motion then has no steady state to be compared with.
const MOST_CYCLES: usize = 6000;

/// CPU time of all threads so far, s; where the system does not tell, elapsed time.
fn cpu_s() -> f64 {
    // The system brings a thread's account up to date when it may change threads.
    std::thread::yield_now();
    let of_task = |entry: std::fs::DirEntry| -> Option<f64> {
        let text = std::fs::read_to_string(entry.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse().ok()
    };
    static START: OnceLock<Instant> = OnceLock::new();
    match std::fs::read_dir("/proc/self/task") {
        Ok(tasks) => 1e-9 * tasks.flatten().filter_map(of_task).sum::<f64>(),
        Err(_) => START.get_or_init(Instant::now).elapsed().as_secs_f64(),
    }
}

fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// Steady states that are found by shooting between two readings of the clock, which cost about 0.1 ms.
const REPEATS: usize = 8;

/// What a steady state took.
struct Taken {
    cycles: usize,
    derivatives: usize,
    /// CPU time, ms.
    time: f64,
    /// Of it, that of the Floquet multipliers and the motion that belongs to the largest.
    of_stability: f64,
}

/// What one of some steady states found by shooting from the same other one took, set-up of the speed's frames
/// included.
fn shot(model: &dyn SweepModel, rpm: f64, start: &[f64]) -> Option<Taken> {
    let settings =
        SteadySettings { between_cycles: 0, most_cycles: MOST_CYCLES, ..SteadySettings::default() };
    let (planets, first) = (model.planets(), model.first_planet_rad());
    let once = || {
        let mut set = model.turning(&model.case().at_speed(rpm), 1).expect("a set");
        set.restore(start).expect("a state");
        let found = steady(set.as_mut(), planets, first, model.steps_per_cycle(), &settings);
        (found.expect("a steady state"), set)
    };
    let clock = cpu_s();
    (1..REPEATS).for_each(|_| drop(once()));
    let (found, mut set) = once();
    let time = 1e3 * (cpu_s() - clock) / REPEATS as f64;
    let (why, residual) = (&found.why_marched, found.residual);
    if found.method != SteadyMethod::Shooting {
        println!("{}: shooting did not converge and the point was marched: {why:?}", model.name());
    }
    let of_stability = match found.method {
        SteadyMethod::Marching => 0.0,
        SteadyMethod::Shooting => {
            let derivative = set.derivative().expect("a derivative").of_cycle(Along::Motion);
            let derivative = derivative.expect("a derivative");
            let clock = cpu_s();
            for _ in 0..REPEATS {
                let found = multipliers(&derivative).expect("multipliers");
                floquet_vector(&derivative, found[0]).expect("a perturbation");
            }
            1e3 * (cpu_s() - clock) / REPEATS as f64
        }
    };
    let (cycles, derivatives) = (found.cycles, found.derivatives);
    let taken = Taken { cycles, derivatives, time, of_stability };
    (residual <= settings.tolerance).then_some(taken)
}

/// What marching until cycles repeat took.
fn marched(model: &dyn SweepModel, rpm: f64, start: &[f64]) -> Option<Taken> {
    let tolerance = SteadySettings::default().tolerance;
    let clock = cpu_s();
    let mut set = model.turning(&model.case().at_speed(rpm), 1).expect("a set");
    set.restore(start).expect("a state");
    let (planets, first) = (model.planets(), model.first_planet_rad());
    let (mut now, mut before) = (Record::new(planets), Record::new(planets));
    let mut cycles = 0;
    while cycles == 0 || now.change_from(&before) > tolerance {
        if cycles == MOST_CYCLES {
            return None;
        }
        std::mem::swap(&mut now, &mut before);
        now.march(set.as_mut(), first, model.steps_per_cycle()).expect("a cycle");
        cycles += 1;
    }
    let time = 1e3 * (cpu_s() - clock);
    Some(Taken { cycles, derivatives: 0, time, of_stability: 0.0 })
}

fn resonance(nominal: &Scene) {
    println!(
        "rpm  model        damping | shooting: cycles derivatives ms | marching: cycles ms | marching/shooting: steps, time, time of the motion alone"
    );
    for [rpm, below] in RESONANCES {
        for factor in [1.0, 0.25, 0.1] {
            let mut scene = nominal.clone();
            scene.damping.mass_proportional_per_s *= factor;
            scene.damping.stiffness_proportional_s *= factor;
            scene.damping.bearing_s *= factor;
            let bodies = Bodies::new(&scene).expect("bodies");
            let case = LoadCase::of_scene(&scene).expect("an operating point");
            let case = case.with_sun_torque(TORQUE);
            let fe = FeModel::new(&scene, &bodies, Imperfections::default(), case);
            let law = MeshLawModel::new(&scene, &bodies, case).expect("a mesh law");
            for model in [&fe as &dyn SweepModel, &law, &law.lumped()] {
                let row = at_resonance(model, rpm, below);
                println!("{rpm} {:<12} {:5.2} % | {row}", model.name(), 2.0 * factor);
            }
        }
    }
}

/// One row: of shooting, of marching, and their ratios.
fn at_resonance(model: &dyn SweepModel, rpm: f64, below: f64) -> String {
    let mut set = model.turning(&model.case().at_speed(below), 1).expect("a set");
    set.rest().expect("an equilibrium");
    let settings =
        SteadySettings { between_cycles: 0, most_cycles: MOST_CYCLES, ..Default::default() };
    let (planets, first) = (model.planets(), model.first_planet_rad());
    steady(set.as_mut(), planets, first, model.steps_per_cycle(), &settings)
        .expect("a motion to start from");
    let start = set.state();
    let mut times: [Vec<f64>; 2] = Default::default();
    let mut alone = Vec::new();
    let mut counts = [(0, 0); 2];
    for _ in 0..ROUNDS {
        let all = [shot(model, rpm, &start), marched(model, rpm, &start)];
        for (k, found) in all.into_iter().enumerate() {
            let Some(taken) = found else {
                return format!("no steady state within {MOST_CYCLES} cycles");
            };
            counts[k] = (taken.cycles, taken.derivatives);
            times[k].push(taken.time);
            if k == 0 {
                alone.push(taken.time - taken.of_stability);
            }
        }
    }
    let ratio = |shot: &[f64]| median(shot.iter().zip(&times[1]).map(|(s, m)| m / s).collect());
    format!(
        "{:4} {:2} {:7.2} | {:5} {:8.2} | {:6.1} {:6.1} {:6.1}",
        counts[0].0,
        counts[0].1,
        median(times[0].clone()),
        counts[1].0,
        median(times[1].clone()),
        counts[1].0 as f64 / counts[0].0 as f64,
        ratio(&times[0]),
        ratio(&alone),
    )
}

fn sweep(scene: &Scene) {
    let bodies = Bodies::new(scene).expect("bodies");
    let case = LoadCase::of_scene(scene).expect("an operating point");
    let fe = FeModel::new(scene, &bodies, Imperfections::default(), case);
    let speeds = even_speeds(100.0, 2500.0, 25.0).expect("speeds");
    let once = |method: SteadyMethod| {
        let settings = SteadySettings { method, ..SteadySettings::default() };
        let plan = Plan::new(&speeds, &[Direction::Up], settings).expect("a plan");
        let clock = cpu_s();
        let found = run(&fe, &plan, &Memory, &|_| ()).expect("a sweep");
        let time = cpu_s() - clock;
        let of = |count: fn(&experiments::sweep::SweepPoint) -> usize| {
            found.points().iter().map(|p| count(p)).sum::<usize>() as f64 / speeds.len() as f64
        };
        let shot = found.points().iter().filter(|p| p.method == SteadyMethod::Shooting).count();
        (time, of(|p| p.cycles), of(|p| p.derivatives), shot)
    };
    // Tables and patterns, which both share.
    once(SteadyMethod::Shooting);
    let (mut ratios, mut all) = (Vec::new(), Vec::new());
    for _ in 0..3 {
        let (shot, marched) = (once(SteadyMethod::Shooting), once(SteadyMethod::Marching));
        ratios.push(marched.0 / shot.0);
        all.push((shot, marched));
    }
    println!(
        "sweep of {} speeds (s, cycles, derivatives a point, points shot): {all:.2?}",
        speeds.len()
    );
    println!("marching over shooting, time: {:.2}", median(ratios));
}

fn prices(scene: &Scene) {
    let bodies = Bodies::new(scene).expect("bodies");
    let case = LoadCase::of_scene(scene).expect("an operating point");
    let fe = FeModel::new(scene, &bodies, Imperfections::default(), case);
    let law = MeshLawModel::new(scene, &bodies, case).expect("a mesh law");
    for model in [&fe as &dyn SweepModel, &law, &law.lumped()] {
        let steps = model.steps_per_cycle();
        let mut rows: [Vec<f64>; 5] = Default::default();
        for round in 0..10 {
            let mut record = Record::new(model.planets());
            let clock = cpu_s();
            let case = model.case().at_speed(1500.0 + 10.0 * f64::from(round));
            let mut set = model.turning(&case, 0).expect("a set");
            rows[0].push(cpu_s() - clock);
            set.rest().expect("an equilibrium");
            let mut cycle = || {
                set.derivative().expect("a derivative").start();
                for _ in 0..steps {
                    set.step().expect("a step");
                    set.derivative().expect("a derivative").keep_step();
                }
                set.derivative().expect("a derivative").end().expect("a cycle");
            };
            let clock = cpu_s();
            cycle();
            rows[1].push(cpu_s() - clock);
            (0..10).for_each(|_| cycle());
            let clock = cpu_s();
            cycle();
            let own = cpu_s() - clock;
            for (row, along) in [(3, Along::Motion), (4, Along::MotionRoughly)] {
                let clock = cpu_s();
                let found = set.derivative().expect("a derivative").of_cycle(along);
                rows[row].push(cpu_s() - clock);
                found.expect("a derivative");
            }
            record.march(set.as_mut(), 0.0, steps).expect("a cycle");
            rows[2].push(own);
        }
        let [built, first, later, derivative, rough] = rows.map(|row| 1e3 * median(row));
        println!(
            "{:<14} built {built:.3} ms, first cycle {first:.3} ms, a later one {later:.3} ms, a derivative {derivative:.3} ms = {:.1} cycles, one for corrections {rough:.3} ms = {:.1} cycles",
            model.name(),
            derivative / later,
            rough / later
        );
    }
}

/// A part of the bench, run on its own by its name.
type Part = fn(&Scene);

fn main() {
    let chosen: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    // `cargo bench … -- --test` only tests that benches start.
    if chosen.iter().any(|argument| argument == "--test") {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    let scene = Scene::from_file(&path).expect("a scene of the repository");
    let parts: [(&str, Part); 3] = [("prices", prices), ("sweep", sweep), ("resonance", resonance)];
    for (name, part) in parts {
        if chosen.is_empty() || chosen.iter().any(|own| own == name) {
            part(&scene);
        }
    }
}
