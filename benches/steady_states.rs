//! Steady states by shooting against marching to the same residual, at a resonance (780 Hz, l = 1) with 2, 0.5 and
//! 0.2 % of damping, from the steady state 1 % below: cycles, derivatives, and CPU time in turns in one process.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench steady_states`

use std::path::Path;
use std::time::Instant;

use experiments::sweep::{FeModel, MeshLawModel, SteadyMethod, SteadySettings, SweepModel, steady};
use fe_contact::statics::{Bodies, Imperfections};
use gearset::{LoadCase, Scene};

const TORQUE: f64 = 1413.0;

/// Speed of the resonance and of the steady state from which both start, rpm.
const SPEEDS: [f64; 2] = [2205.0, 2183.0];

const ROUNDS: usize = 7;

fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// Cycles, derivatives and time (s) of a steady state from another one, set-up of the speed's frames included.
fn timed(model: &dyn SweepModel, start: &[f64], method: SteadyMethod) -> (usize, usize, f64) {
    let settings = SteadySettings {
        method,
        between_cycles: 0,
        most_cycles: 20_000,
        ..SteadySettings::default()
    };
    let clock = Instant::now();
    let mut set = model.turning(&model.case().at_speed(SPEEDS[0]), 1).expect("a set");
    set.restore(start).expect("a state");
    let (planets, first) = (model.planets(), model.first_planet_rad());
    let found = steady(set.as_mut(), planets, first, model.steps_per_cycle(), &settings);
    let found = found.expect("a steady state");
    assert!(found.method == method && found.residual <= settings.tolerance);
    (found.cycles, found.derivatives, clock.elapsed().as_secs_f64())
}

fn main() {
    // `cargo bench … -- --test` only tests that benches start.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    let nominal = Scene::from_file(&path).expect("a scene of the repository");
    println!(
        "model          damping  shooting: cycles derivatives  ms   marching: cycles  ms   ratio"
    );
    for factor in [1.0, 0.25, 0.1] {
        let mut scene = nominal.clone();
        scene.damping.mass_proportional_per_s *= factor;
        scene.damping.stiffness_proportional_s *= factor;
        scene.damping.bearing_s *= factor;
        let bodies = Bodies::new(&scene).expect("bodies");
        let case = LoadCase::of_scene(&scene).expect("an operating point").with_sun_torque(TORQUE);
        let fe = FeModel::new(&scene, &bodies, Imperfections::default(), case);
        let law = MeshLawModel::new(&scene, &bodies, case).expect("a mesh law");
        for model in [&fe as &dyn SweepModel, &law, &law.lumped()] {
            let mut set = model.turning(&case.at_speed(SPEEDS[1]), 1).expect("a set");
            set.rest().expect("an equilibrium");
            let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
            let (planets, first) = (model.planets(), model.first_planet_rad());
            steady(set.as_mut(), planets, first, model.steps_per_cycle(), &settings)
                .expect("a steady state");
            let start = set.state();
            let (mut shot, mut marched) = (Vec::new(), Vec::new());
            let mut counts = [[0; 2]; 2];
            for _ in 0..ROUNDS {
                let (cycles, derivatives, time) = timed(model, &start, SteadyMethod::Shooting);
                counts[0] = [cycles, derivatives];
                shot.push(1e3 * time);
                let (cycles, derivatives, time) = timed(model, &start, SteadyMethod::Marching);
                counts[1] = [cycles, derivatives];
                marched.push(1e3 * time);
            }
            let ratio = median(shot.iter().zip(&marched).map(|(s, m)| m / s).collect());
            println!(
                "{:<14} {:5.2} %  {:16} {:11} {:6.1} {:16} {:6.1}  {ratio:5.1}",
                model.name(),
                2.0 * factor,
                counts[0][0],
                counts[0][1],
                median(shot),
                counts[1][0],
                median(marched),
            );
        }
    }
}
