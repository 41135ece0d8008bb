//! Steady states of `full` at five speeds for `reference/full_sweep.toml`: four planets under 1413 N·m,
//! about the peak of the sun's rotation in the second harmonic, off resonance, and at the lowest
//! translational mode's first harmonic. Three quarters of an hour on two cores.
//!
//! `cargo run --release -p validation --example truth > reference/full_sweep.toml`
//!
//! Flanks of eight elements, as every rung it is compared with must have. 140 steps a cycle everywhere and
//! 560 about the peak: what steps do can be told from what the bodies' inertia does.

use fe_contact::statics::{Bodies, Imperfections};
use gearset::{Kinematics, Rung};
use validation::sweep::{
    Chain, Coordinate, FeModel, Memory, Part, Plan, Response, SteadySettings, SweepPoint, run,
};
use validation::{PublishedScene, scene};

const TORQUE_NM: f64 = 1413.0;
const FLANK_ELEMENTS: u32 = 8;

/// Steps a cycle with chains of speeds, rpm.
const PLANS: [(u32, [&[f64]; 2]); 2] =
    [(140, [&[1600.0, 1630.0, 1660.0], &[1000.0, 2196.0]]), (560, [&[1600.0, 1630.0], &[1660.0]])];

fn numbers(values: impl Iterator<Item = f64>) -> String {
    values.map(|x| format!("{x:.6e}")).collect::<Vec<_>>().join(", ")
}

fn print(steps: u32, point: &SweepPoint) {
    println!("\n[[point]]");
    println!("steps_per_cycle = {steps}\nspeed_rpm = {}", point.speed_rpm);
    println!("cycles = {}\nresidual = {:.1e}", point.cycles, point.residual);
    for part in [Part::Sun, Part::Planet(0)] {
        let of = |response: Response| numbers((1..=5).map(|l| response.amplitude(point, l)));
        println!("{}_rotation_rad = [{}]", part.name(), of(Response::Rotation(part)));
        println!("{}_translation_m = [{}]", part.name(), of(Response::Translation(part)));
    }
    for part in [Part::SunMesh(0), Part::RingMesh(0)] {
        let force = |l| point.amplitude(part, Coordinate::Force, l);
        println!("{}_force_n = [{}]", part.name(), numbers((1..=5).map(force)));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = scene(PublishedScene::Oh58FourPlanets)?;
    scene.dynamics.rung = Rung::Full;
    scene.fe_contact.flank_elements = FLANK_ELEMENTS;
    let bodies = Bodies::new(&scene)?;
    let kinematics = Kinematics::from_scene(&scene).ok_or("no kinematics")??;
    let hz_per_rpm = kinematics.mesh_frequency_hz / scene.operation.ok_or("no speed")?.speed_rpm;
    println!("# Harmonics 1 to 5 of steady states with every degree of freedom, four planets.");
    println!("# Remade by: cargo run --release -p validation --example truth");
    println!("source = \"own computation, rung full\"");
    println!("command = \"cargo run --release -p validation --example truth\"");
    println!("torque_nm = {TORQUE_NM:.1}\nflank_elements = {FLANK_ELEMENTS}");
    for (steps, chains) in PLANS {
        scene.dynamics.steps_per_cycle = steps;
        let model = FeModel::new(&scene, &bodies, Imperfections::default(), TORQUE_NM);
        let chain = |(k, speeds): (usize, &&[f64])| Chain {
            name: format!("{steps}_{k}"),
            speeds_rpm: speeds.to_vec(),
        };
        let steady =
            SteadySettings { tolerance: 3e-5, between_cycles: 0, ..SteadySettings::default() };
        let plan = Plan { steady, chains: chains.iter().enumerate().map(chain).collect() };
        let done = |p: &SweepPoint| eprintln!("{steps} steps, {} rpm: {}", p.speed_rpm, p.cycles);
        let sweep = run(&model, &plan, hz_per_rpm, &Memory, &done)?;
        sweep.points().into_iter().for_each(|point| print(steps, point));
    }
    Ok(())
}
