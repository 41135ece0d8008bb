//! The mesh stiffness curve of a sun–planet mesh as CSV, from the shape of the teeth: deflection, stiffness and the
//! forces of the tooth pairs over one mesh cycle.
//!
//! `cargo run --release --example mesh_stiffness > mesh_stiffness.csv`

use std::error::Error;

use epicyclic::fe_contact::complementarity::ActiveSet;
use epicyclic::fe_contact::statics::{Bodies, pair_cycle};
use epicyclic::gearset::{MeshKind, Scene, SceneKind, template};

/// Normal force of the mesh, N.
const FORCE: f64 = 10_000.0;

/// Positions in the mesh cycle.
const POSITIONS: usize = 56;

fn main() -> Result<(), Box<dyn Error>> {
    let set = Scene::from_toml(template(SceneKind::Planetary))?;
    let bodies = Bodies::new(&set)?;
    let cycle = pair_cycle(&bodies, MeshKind::SunPlanet, FORCE, POSITIONS, &ActiveSet)?;
    println!(
        "phase_cycles,deflection_um,secant_stiffness_n_per_m,pairs_in_contact,largest_pair_force_n"
    );
    for position in &cycle.positions {
        let forces = position.pairs.iter().map(|pair| pair.force);
        let in_contact = forces.clone().filter(|force| *force > 0.0).count();
        println!(
            "{:.4},{:.4},{:.5e},{in_contact},{:.1}",
            position.phase,
            1e6 * position.deflection,
            cycle.secant_stiffness(position),
            forces.fold(0.0, f64::max),
        );
    }
    Ok(())
}
