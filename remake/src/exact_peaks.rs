//! Resonant peaks with exact kinematics at every step for `kept/exact_peaks.toml`: the default scene
//! with four planets at the torques and places of `kept/torque_peaks.toml`, sun's translation in the
//! first harmonic and its rotation in the second. A quarter of an hour on two cores.
//!
//! `cargo run --release -p remake -- exact_peaks > p.toml && mv p.toml kept/exact_peaks.toml`
//!
//! Every march starts from the steady state of kinematics that are linear about the loaded configuration,
//! and goes on until its own cycles repeat.

use experiments::sweep::{FeModel, Part, Response, SteadySettings, SweepModel, SweepPoint, steady};
use fe_contact::statics::{Bodies, Imperfections};
use rayon::prelude::*;
use scene::{LoadCase, MeshKinematics, Scene};
use validation::{PublishedScene, Reference, scene};

/// Resonances as the torque study names them, each with the response of the sun that is evaluated.
const RESONANCES: [(&str, Response); 2] = [
    ("lowest translational", Response::Translation(Part::SUN)),
    ("lowest rotational", Response::Rotation(Part::SUN)),
];

/// Distance of the speeds to either side of a peak, as a share of its speed: about a half-width at 2 %
/// damping.
const ASIDE: f64 = 0.018;

/// Largest change from cycle to cycle of a steady state, with linear and with exact kinematics.
const TOLERANCES: [f64; 2] = [1e-7, 2e-5];

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// One peak under one torque.
struct Case {
    mode: &'static str,
    response: Response,
    harmonic: usize,
    torque_nm: f64,
    speeds_rpm: [f64; 3],
}

/// Amplitudes with exact kinematics and the cycles they took to repeat.
fn exact(
    scene: &Scene,
    bodies: &Bodies,
    case: &Case,
    load: LoadCase,
) -> Outcome<Vec<(f64, usize)>> {
    let model = |kinematics: MeshKinematics| {
        let mut own = scene.clone();
        own.dynamics.kinematics = kinematics;
        FeModel::new(&own, bodies, Imperfections::default(), load)
    };
    let linear = model(MeshKinematics::AboutMean);
    let exact = model(MeshKinematics::Exact);
    let run = |speed: f64| -> Outcome<(f64, usize)> {
        let mut state: Option<Vec<f64>> = None;
        let mut found = (f64::NAN, 0);
        for (model, tolerance) in [&linear, &exact].into_iter().zip(TOLERANCES) {
            let mut set = model.turning(&load.at_speed(speed), 0)?;
            match &state {
                Some(state) => set.restore(state)?,
                None => set.rest()?,
            }
            let settings =
                SteadySettings { tolerance, between_cycles: 0, ..SteadySettings::default() };
            let (planets, first) = (model.planets(), model.first_planet_rad());
            let march = steady(set.as_mut(), planets, first, model.steps_per_cycle(), &settings)?;
            let point = SweepPoint::new(load.at_speed(speed), &march, &settings, 0)?;
            found = (case.response.amplitude(&point.state, case.harmonic), march.cycles);
            eprintln!("{} {} {speed} {tolerance:e}: {found:?}", case.mode, case.torque_nm);
            state = Some(set.state());
        }
        Ok(found)
    };
    case.speeds_rpm.into_iter().map(run).collect()
}

pub(crate) fn remake() -> crate::Outcome {
    let scene = scene(PublishedScene::Oh58FourPlanets)?;
    let bodies = Bodies::new(&scene)?;
    let load = LoadCase::of_scene(&scene)?;
    let kept = Reference::load()?.torque_peaks;
    let mut cases = Vec::new();
    for (mode, response) in RESONANCES {
        let own = |p: &&validation::TorquePeak| p.system == "default scene" && p.mode == mode;
        let peak = kept.peak.iter().find(own).ok_or("no such peak")?;
        for (torque, top) in kept.torques_nm.iter().zip(&peak.speeds_rpm) {
            let aside = |by: f64| (10.0 * top * (1.0 + by)).round() / 10.0;
            let speeds_rpm = [aside(-ASIDE), aside(0.0), aside(ASIDE)];
            let harmonic = peak.harmonic as usize;
            cases.push(Case { mode, response, harmonic, torque_nm: *torque, speeds_rpm });
        }
    }
    let found: Vec<_> = cases
        .par_iter()
        .map(|case| exact(&scene, &bodies, case, load.with_sun_torque(case.torque_nm)))
        .collect::<Outcome<_>>()?;
    println!(
        "# Resonant peaks with exact kinematics at every step, four planets, 140 steps a cycle."
    );
    println!("source = \"own computation: dynamics.kinematics = exact, fidelity quasi_static\"");
    println!("command = \"cargo run --release -p remake -- exact_peaks\"");
    for (case, found) in cases.iter().zip(&found) {
        let list = |of: &dyn Fn(&(f64, usize)) -> String| {
            found.iter().map(of).collect::<Vec<_>>().join(", ")
        };
        println!("\n[[peak]]\nmode = \"{}\"\nharmonic = {}", case.mode, case.harmonic);
        println!("torque_nm = {:.1}\nspeeds_rpm = {:?}", case.torque_nm, case.speeds_rpm);
        println!("# m of translation, rad of rotation");
        println!("sun = [{}]", list(&|f| format!("{:.6e}", f.0)));
        println!("cycles = [{}]", list(&|f| f.1.to_string()));
    }
    Ok(())
}
