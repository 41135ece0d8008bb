//! Steady states of the FE/contact set at three speeds: harmonics of the sun's rotation.
//!
//! `cargo run --release --example steady_state`

use std::error::Error;

use epicyclic::experiments::models::FeContact;
use epicyclic::experiments::sweep::{Coordinate, Part};
use epicyclic::experiments::{SpeedRequest, SteadyStateModel};
use epicyclic::gearset::{LoadCase, Scene, SceneKind, template};

fn main() -> Result<(), Box<dyn Error>> {
    let set = Scene::from_toml(template(SceneKind::Planetary))?;
    let case = LoadCase::of_scene(&set)?.with_sun_torque(1000.0);
    let request =
        SpeedRequest { speeds_rpm: &[800.0, 1200.0, 1600.0], harmonics: 5, tolerance: 1e-6 };
    let states =
        FeContact::default().steady_states(&set, &case, &request).map_err(|e| e.to_string())?;
    for state in states {
        print!(
            "{:6.0} rpm, mesh frequency {:6.1} Hz:",
            state.case.speed_rpm, state.case.mesh_frequency_hz
        );
        for harmonic in 1..=5 {
            let amplitude = state.amplitude(Part::SUN, Coordinate::Rotation, harmonic);
            print!("  l = {harmonic}: {:.3} µrad", 1e6 * amplitude);
        }
        println!();
    }
    Ok(())
}
