//! Steady states of `full` at five speeds for `kept/full_sweep.toml`: four planets under 1413 N·m,
//! about the peak of the sun's rotation in the second harmonic, off resonance, and at the lowest
//! translational mode's first harmonic. Half an hour on two cores.
//!
//! `cargo run --release -p remake -- truth > kept/full_sweep.toml`
//!
//! Flanks have eight elements, as at every fidelity that is compared with these results. A cycle has
//! 140 steps; the error of the time step, which is of second order and alike at all fidelities, follows from
//! quasi-static bodies at 140, 280 and 560 steps about the peak. Each speed starts with few steps, and every
//! finer run starts from the steady state of the coarser one, which saves most cycles of the expensive runs.

use experiments::sweep::{
    Coordinate, FeModel, Part, Response, SteadySettings, SweepModel, SweepPoint, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use gearset::Body;
use rayon::prelude::*;
use scene::{CellLayout, Fidelity, LoadCase, Scene};
use validation::{PublishedScene, scene};

const TORQUE_NM: f64 = 1413.0;
const FLANK_ELEMENTS: u32 = 8;

/// Steady states at one speed.
#[derive(Clone, Copy)]
struct SpeedPlan {
    speed_rpm: f64,
    /// Steps per cycle of successive runs, each from the state of the one before; the first is not recorded.
    steps: &'static [u32],
    /// Largest change of the steady state from cycle to cycle.
    tolerance: f64,
}

/// Runs with every degree of freedom. At the last speed the sun's rotation is a hundredth of the planets', by
/// which the change from cycle to cycle is measured, so that the tolerance is smaller there.
const PLANS: [SpeedPlan; 5] = [
    SpeedPlan { speed_rpm: 1600.0, steps: &[35, 140], tolerance: TOLERANCE },
    SpeedPlan { speed_rpm: 1630.0, steps: &[35, 140], tolerance: TOLERANCE },
    SpeedPlan { speed_rpm: 1660.0, steps: &[35, 140], tolerance: TOLERANCE },
    SpeedPlan { speed_rpm: 1000.0, steps: &[35, 140], tolerance: TOLERANCE },
    SpeedPlan { speed_rpm: 2196.0, steps: &[35, 140], tolerance: 1e-6 },
];

/// The same with quasi-static bodies.
const STEPS_ALONE: SpeedPlan =
    SpeedPlan { speed_rpm: 0.0, steps: &[35, 140, 280, 560], tolerance: TOLERANCE };
const SPEEDS_ALONE: [f64; 3] = [1600.0, 1630.0, 1660.0];

/// Contact tables for twice the usual load, because mesh forces at resonance exceed the usual one.
const TABLES: usize = 1;

/// Largest change of a steady state from cycle to cycle at the other speeds.
const TOLERANCE: f64 = 3e-5;

fn numbers(values: impl Iterator<Item = f64>) -> String {
    values.map(|x| format!("{x:.6e}")).collect::<Vec<_>>().join(", ")
}

fn text(list: &str, steps: u32, point: &SweepPoint) -> String {
    let speed = point.state.case.speed_rpm;
    let mut text = format!("\n[[{list}]]\nsteps_per_cycle = {steps}\nspeed_rpm = {speed:.1}\n");
    text += &format!("cycles = {}\nresidual = {:.1e}\n", point.cycles, point.residual);
    for part in [Part::SUN, Part::Body(Body::Planet(0))] {
        let of = |response: Response| numbers((1..=5).map(|l| response.amplitude(&point.state, l)));
        text += &format!("{}_rotation_rad = [{}]\n", part.name(), of(Response::Rotation(part)));
        text += &format!("{}_translation_m = [{}]\n", part.name(), of(Response::Translation(part)));
    }
    for part in [Part::SunMesh(0), Part::RingMesh(0)] {
        let force = |l| point.state.amplitude(part, Coordinate::Force, l);
        text += &format!("{}_force_n = [{}]\n", part.name(), numbers((1..=5).map(force)));
    }
    text
}

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Steady states at one speed, as text.
fn at_speed(
    list: &str,
    scene: &Scene,
    bodies: &Bodies,
    plan: SpeedPlan,
    case: LoadCase,
) -> Outcome<String> {
    let SpeedPlan { speed_rpm: speed, steps, tolerance } = plan;
    let settings = SteadySettings { tolerance, between_cycles: 0, ..SteadySettings::default() };
    let (mut state, mut all): (Option<Vec<f64>>, String) = (None, String::new());
    for (k, steps) in steps.iter().copied().enumerate() {
        let mut own = scene.clone();
        own.dynamics.steps_per_cycle = steps;
        let model = FeModel::new(&own, bodies, Imperfections::default(), case);
        let mut set = model.turning(&case.at_speed(speed), TABLES)?;
        match &state {
            Some(state) => set.restore(state)?,
            None => set.rest()?,
        }
        let (planets, first) = (model.planets(), model.first_planet_rad());
        let found = steady(set.as_mut(), planets, first, steps as usize, &settings)?;
        let point =
            text(list, steps, &SweepPoint::new(case.at_speed(speed), &found, &settings, TABLES)?);
        eprintln!("{point}");
        if k > 0 {
            all += &point;
        }
        state = Some(set.state());
    }
    Ok(all)
}

pub(crate) fn remake() -> crate::Outcome {
    let mut scene = scene(PublishedScene::Oh58FourPlanets)?;
    scene.dynamics.fidelity = Fidelity::Full;
    scene.fe_contact.flank_elements = FLANK_ELEMENTS;
    scene.fe_contact.cell_layout = CellLayout::Graded;
    let bodies = Bodies::new(&scene)?;
    let case = LoadCase::of_scene(&scene)?.with_sun_torque(TORQUE_NM);
    println!("# Harmonics 1 to 5 of steady states with every degree of freedom, four planets.");
    println!("# Remade by: cargo run --release -p remake -- truth");
    println!("source = \"own computation, fidelity full\"");
    println!("command = \"cargo run --release -p remake -- truth\"");
    println!("torque_nm = {TORQUE_NM:.1}\nflank_elements = {FLANK_ELEMENTS}");
    // Even cells cost as much and leave 1.3 % in the height of the peak (docs/studies.md).
    println!("cell_layout = \"graded\"\ntable_size = {TABLES}");
    let all: Vec<String> = PLANS
        .into_par_iter()
        .map(|plan| at_speed("point", &scene, &bodies, plan, case))
        .collect::<Outcome<_>>()?;
    all.iter().for_each(|text| print!("{text}"));
    scene.dynamics.fidelity = Fidelity::QuasiStatic;
    for speed_rpm in SPEEDS_ALONE {
        let plan = SpeedPlan { speed_rpm, ..STEPS_ALONE };
        print!("{}", at_speed("quasi_static", &scene, &bodies, plan, case)?);
    }
    Ok(())
}
