//! Motion in time of the FE/contact set from rest at constant speed, as CSV: rotation of the sun and forces of its
//! meshes.
//!
//! `cargo run --release --example time_series > time_series.csv`

use std::error::Error;

use epicyclic::fe_contact::statics::{Bodies, Imperfections};
use epicyclic::fe_contact::vibration::{Loading, NominalRotation, VibratingSet};
use epicyclic::gearset::{LoadCase, Scene, SceneKind, template};

/// Mesh cycles that are marched, and steps in each.
const CYCLES: usize = 20;
const STEPS: usize = 140;

fn main() -> Result<(), Box<dyn Error>> {
    let set = Scene::from_toml(template(SceneKind::Planetary))?;
    let case = LoadCase::of_scene(&set)?;
    let bodies = Bodies::new(&set)?;
    let rotation = NominalRotation::Turning {
        mesh_frequency: case.mesh_frequency_hz,
        steps_per_cycle: STEPS,
        direction: case.direction(),
    };
    // Contact tables reach to twice the torque shared evenly, over the base radius of the sun.
    let sun = bodies.geometry.sun.as_ref().ok_or("the set has no sun")?;
    let share = case.sun_load_nm() / set.planets.count() as f64;
    let loading =
        Loading { torque_nm: case.sun_load_nm(), mesh_force: 2.0 * share / sun.base_radius };
    let none = Imperfections::default();
    let mut motion = VibratingSet::new(&set, &bodies, case.sense(), none, rotation, loading)?;
    motion.rest(case.sun_load_nm())?;
    println!("time_s,sun_rotation_rad,sun_mesh_0_n,sun_mesh_1_n");
    let mut forces = Vec::new();
    for _ in 0..CYCLES * STEPS {
        motion.step()?;
        let ([_, _, sun], _) = motion.displacements();
        motion.mesh_forces(&mut forces);
        println!("{:.7e},{:.7e},{:.3},{:.3}", motion.time(), sun[2], forces[0], forces[1]);
    }
    Ok(())
}
