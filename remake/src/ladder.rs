//! Error and cost of the fidelities by steps per cycle and contact cells: `kept/ladder.toml`. Needs
//! `kept/full_sweep.toml`; twenty minutes on two cores, most of them for modes of the bodies.
//!
//! `cargo run --release -p remake -- ladder > ladder.toml && mv ladder.toml kept/`
//!
//! Error: speed and height of the peak of the sun's rotation in the second harmonic, four planets under
//! 1413 N·m, against `full` without the error of the time step. Cost: time of a step of the steady set over
//! that of the lumped model in time at 140 steps, all fidelities alternating in one run; for `full`, three
//! cycles alternating with the lumped model, after a first cycle that visits every position. Flanks of eight
//! elements and contact tables as in `kept/full_sweep.toml`.

use std::time::Instant;

use experiments::sweep::{
    Direction, FeModel, Marching, Memory, MeshLawModel, Part, Plan, Response, SteadySettings,
    SteadyState, SweepModel, run, steady, top_of_three,
};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};
use validation::{FullSweep, FullSweepPoint, PublishedScene, scene};

/// Speeds about the peak, rpm, with the spacing of those in `kept/full_sweep.toml`.
const SPEEDS: [f64; 7] = [1540.0, 1570.0, 1600.0, 1630.0, 1660.0, 1690.0, 1720.0];

/// Speed at which steps are timed, rpm.
const TIMED_RPM: f64 = 1630.0;

/// Rounds of timing, and least duration of the batch of steps in one round, s.
const ROUNDS: usize = 31;
const BATCH_S: f64 = 0.02;

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

#[derive(Clone, Copy, PartialEq)]
enum Model {
    Lumped,
    Fidelity(Fidelity),
}

struct Setting {
    model: Model,
    steps: u32,
    cells: u32,
}

fn settings(cells: u32) -> Vec<Setting> {
    let mut list = Vec::new();
    // Costs are divided by that of the first.
    for steps in [140, 70, 280, 560] {
        list.push(Setting { model: Model::Lumped, steps, cells });
    }
    for steps in [70, 140, 280, 560] {
        list.push(Setting { model: Model::Fidelity(Fidelity::MeshLaw), steps, cells });
    }
    for steps in [28, 56, 70, 140, 280, 560] {
        list.push(Setting { model: Model::Fidelity(Fidelity::QuasiStatic), steps, cells });
    }
    for cells in [cells / 2, 2 * cells] {
        list.push(Setting { model: Model::Fidelity(Fidelity::QuasiStatic), steps: 140, cells });
    }
    for modes in [2, 10, 30, 90] {
        list.push(Setting { model: Model::Fidelity(Fidelity::Modal(modes)), steps: 140, cells });
    }
    list
}

/// Place (rpm) and height (rad) of the peak of the sun's rotation in l = 2.
fn highest(points: &[&SteadyState]) -> Option<(f64, f64)> {
    let rotation = |p: &SteadyState| Response::Rotation(Part::SUN).amplitude(p, 2);
    top_of_three(points.iter().map(|p| (p.case.speed_rpm, rotation(p))))
}

/// Mean time of a step, s, over at least `least_s`.
fn timed(set: &mut dyn Marching, least_s: f64) -> Outcome<f64> {
    let (start, mut count) = (Instant::now(), 0u32);
    loop {
        for _ in 0..140 {
            set.step()?;
        }
        count += 140;
        let gone = start.elapsed().as_secs_f64();
        if gone >= least_s {
            return Ok(gone / f64::from(count));
        }
    }
}

fn model<'s>(
    scene: &Scene,
    bodies: &'s Bodies,
    which: Model,
    truth: &FullSweep,
) -> Outcome<Box<dyn SweepModel + 's>> {
    let case = LoadCase::of_scene(scene)?.with_sun_torque(truth.torque_nm);
    let law = || MeshLawModel::new(scene, bodies, case);
    Ok(match which {
        Model::Lumped => Box::new(law()?.lumped()),
        Model::Fidelity(Fidelity::MeshLaw) => Box::new(law()?),
        Model::Fidelity(_) => {
            let model = FeModel::new(scene, bodies, Imperfections::default(), case);
            Box::new(model.with_tables(truth.table_size))
        }
    })
}

pub(crate) fn remake() -> crate::Outcome {
    let truth = FullSweep::load()?;
    let (torque, mut scene) = (truth.torque_nm, scene(PublishedScene::Oh58FourPlanets)?);
    scene.fe_contact.flank_elements = truth.flank_elements;
    scene.fe_contact.cell_layout = truth.cell_layout;
    let at_timed = LoadCase::of_scene(&scene)?.with_sun_torque(torque).at_speed(TIMED_RPM);
    let peak = truth.rotational_peak().ok_or("the truth has no peak")?;
    println!("# Fidelities of the ladder by error and cost, four planets.");
    println!("# Remade by: cargo run --release -p remake -- ladder");
    println!("source = \"own computation; truth: fidelity full, steps extrapolated\"");
    println!("command = \"cargo run --release -p remake -- ladder\"");
    println!(
        "torque_nm = {torque:.1}\npeak_rpm = {:.3}\npeak_rad = {:.6e}",
        peak.speed_rpm, peak.height_rad
    );
    println!("table_size = {}", truth.table_size);
    println!("peak_rpm_uncertain_percent = {:.1e}", peak.uncertain_percent[0]);
    println!("peak_rad_uncertain_percent = {:.1e}", peak.uncertain_percent[1]);

    let settings = settings(scene.fe_contact.contact_cells);
    let mut tops = Vec::new();
    // The number of contact cells is a setting of the bodies, which the models borrow.
    let made: Vec<(Scene, Bodies)> = settings
        .iter()
        .map(|s| {
            let mut own = scene.clone();
            own.dynamics.steps_per_cycle = s.steps;
            own.fe_contact.contact_cells = s.cells;
            if let Model::Fidelity(fidelity) = s.model {
                own.dynamics.fidelity = fidelity;
            }
            let bodies = Bodies::new(&own)?;
            Ok((own, bodies))
        })
        .collect::<Outcome<_>>()?;
    let models: Vec<_> = settings
        .iter()
        .zip(&made)
        .map(|(s, (own, bodies))| model(own, bodies, s.model, &truth))
        .collect::<Outcome<_>>()?;
    let steady_settings =
        SteadySettings { tolerance: 1e-6, between_cycles: 0, ..SteadySettings::default() };
    let mut sets = Vec::new();
    for (setting, model) in settings.iter().zip(&models) {
        let plan = Plan::new(&SPEEDS, &[Direction::Up], steady_settings.clone())?;
        let sweep = run(model.as_ref(), &plan, &Memory, &|_| ())?.complete()?;
        let points = sweep.points();
        tops.push(highest(&sweep.states()).ok_or("no peak")?);
        let size =
            points.iter().find(|p| p.state.case.speed_rpm == TIMED_RPM).map_or(0, |p| p.size);
        let mut set = model.turning(&at_timed, size)?;
        set.rest()?;
        let steps = model.steps_per_cycle();
        steady(set.as_mut(), model.planets(), model.first_planet_rad(), steps, &steady_settings)?;
        eprintln!("{} at {} steps, {} cells", model.name(), setting.steps, setting.cells);
        sets.push(set);
    }
    let mut ratios = vec![Vec::new(); sets.len()];
    for _ in 0..ROUNDS {
        let lumped = timed(sets[0].as_mut(), BATCH_S)?;
        for (set, own) in sets.iter_mut().zip(&mut ratios) {
            own.push(timed(set.as_mut(), BATCH_S)? / lumped);
        }
    }
    for (((setting, model), top), (set, own)) in
        settings.iter().zip(&models).zip(&tops).zip(sets.iter().zip(&mut ratios))
    {
        own.sort_by(f64::total_cmp);
        let quartiles = [ROUNDS / 4, ROUNDS / 2, 3 * ROUNDS / 4].map(|i| own[i]);
        let [low, median, high] = quartiles;
        let effort = set.effort();
        println!("\n[[fidelity]]\nname = \"{}\"", model.name());
        println!("steps_per_cycle = {}\ncontact_cells = {}", setting.steps, setting.cells);
        println!("peak_rpm = {:.3}\npeak_rad = {:.6e}", top.0, top.1);
        println!("step_ratio = [{low:.2}, {median:.2}, {high:.2}]");
        println!("coordinates = {}\nsolutions = {:.2}", effort.coordinates, effort.solutions);
    }

    // Every degree of freedom: the first step at a position needs one solution per port.
    scene.dynamics.fidelity = Fidelity::Full;
    scene.dynamics.steps_per_cycle = 140;
    let bodies = Bodies::new(&scene)?;
    let full = model(&scene, &bodies, Model::Fidelity(Fidelity::Full), &truth)?;
    let mut set = full.turning(&at_timed, 0)?;
    set.rest()?;
    (0..140).try_for_each(|_| set.step())?;
    let mut own = Vec::new();
    for _ in 0..3 {
        own.push(timed(set.as_mut(), 0.0)? / timed(sets[0].as_mut(), BATCH_S)?);
    }
    own.sort_by(f64::total_cmp);
    let near = |p: &&FullSweepPoint| truth.is_about_the_peak(p.speed_rpm);
    let points = truth.of_steps(140).filter(near);
    let (rpm, rad) = top_of_three(points.map(|p| (p.speed_rpm, p.sun_rotation_rad[1])))
        .ok_or("the truth has no peak")?;
    println!("\n[[fidelity]]\nname = \"full\"\nsteps_per_cycle = 140");
    println!("contact_cells = {}", scene.fe_contact.contact_cells);
    println!("peak_rpm = {rpm:.3}\npeak_rad = {rad:.6e}");
    println!("step_ratio = [{:.0}.0, {:.0}.0, {:.0}.0]", own[0], own[1], own[2]);
    let effort = set.effort();
    println!("coordinates = {}\nsolutions = {:.2}", effort.coordinates, effort.solutions);
    Ok(())
}
