//! Prints the tables of `docs/fe_dynamics_effects.md`: the effect of single changes on the tabled
//! frequencies, and the linearised FE/contact set against the lumped model with parameters from it.

use experiments::modal::{Preload, agreement};
use fe_contact::statics::Bodies;
use validation::effects::{EffectStudy, Variant, effects};
use validation::{PublishedScene, Reference, Table, scene};

/// Positions in the mesh cycle.
const POSITIONS: usize = 20;

pub(crate) fn remake() -> crate::Outcome {
    let reference = Reference::load()?;
    let four = scene(PublishedScene::Oh58FourPlanets)?;
    let bodies = Bodies::new(&four)?;
    let preload = Preload { load: scene::LoadCase::standing(1130.0), position: 0.0, step_s: 5e-6 };
    println!("### Rigid carrier: FE/contact against the lumped model with parameters from FE\n");
    println!(
        "| planets | position | pairs off the line of action | worst of all modes, % | at, Hz | 5 to 15 kHz, % | all along the line of action, % |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|");
    for table in Table::ALL {
        for k in 0..POSITIONS {
            let position = k as f64 / POSITIONS as f64;
            let found =
                agreement(&scene(table.consistent())?, &bodies, &Preload { position, ..preload })?;
            println!(
                "| {} | {position:.2} | {} | {:+.3} | {:.0} | {:+.3} | {:.0e} |",
                table.planets(),
                found.pairs_off_the_line,
                found.worst_percent,
                found.at_hz,
                found.worst_mesh_ruled_percent,
                found.along_the_line_percent,
            );
        }
    }
    let own = Variant::own_bodies(&four)?;
    let study = EffectStudy { bodies: &bodies, own: &own, preload, variants: &Variant::ALL };
    for table in Table::ALL {
        print!("\n{}", effects(&reference, table, &study)?);
    }
    Ok(())
}
