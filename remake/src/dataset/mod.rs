//! Recomputes the tables of the data set and writes them to `data/dataset/`; three minutes on two
//! cores.
//!
//! `cargo run --release -p remake -- dataset`
//!
//! A value that two codes give is that of the other code, its uncertainty twice their difference; one of two meshes of
//! elements is that of the finer, its uncertainty twice the difference.

mod closed_forms;
mod fe_modes;
mod mesh_cycles;
mod meshes;
mod pairs;
mod stability;
mod sweeps;
mod torque_growth;

use std::fs;
use std::path::Path;
use std::sync::Arc;

use scene::Scene;
use validation::certified::{DATA_SET_VERSION, Row, write_rows};
use validation::results::{KnownScene, KnownScenes};

use crate::Outcome;

/// Least uncertainty, in parts of the value: rounding of binary numbers.
const ROUNDING: f64 = 1e-15;

/// Shipped scenes without variants of them, by id.
fn scenes() -> Vec<Arc<KnownScene>> {
    let shipped = |known: &&Arc<KnownScene>| {
        epicyclic_data::text(&format!("scenes/{}.toml", known.id)).is_some()
    };
    let mut scenes: Vec<_> = KnownScenes::shipped().iter().filter(shipped).cloned().collect();
    scenes.sort_by(|a, b| a.id.cmp(&b.id));
    scenes
}

/// The shipped scene of that id.
fn scene_named(id: &str) -> Result<Scene, String> {
    let known = scenes().into_iter().find(|known| known.id == id);
    known.map(|known| known.scene.clone()).ok_or_else(|| format!("no scene is called {id}"))
}

/// Writes all tables.
pub(crate) fn remake() -> Outcome {
    let folder = Path::new("data/dataset");
    let closed = closed_forms::rows()?;
    let swept = sweeps::rows()?;
    let of = |rows: &[Row], quantities: &[&str]| {
        let is = |row: &&Row| quantities.contains(&row.quantity.as_str());
        rows.iter().filter(is).cloned().collect::<Vec<Row>>()
    };
    let modes = &["frequency", "multiplicity"];
    let matrices = &["mass", "stiffness"];
    let rules = &["excites"];
    let others = |row: &&Row| {
        let quantity = row.quantity.as_str();
        ![&modes[..], &matrices[..], &rules[..]].concat().contains(&quantity)
    };
    let geometry = closed.iter().filter(others).cloned().collect();
    let tables = [
        ("geometry", geometry),
        ("modes", [of(&closed, modes), fe_modes::rows()?].concat()),
        ("matrices", of(&closed, matrices)),
        ("rules", of(&closed, rules)),
        ("pairs", pairs::rows()?),
        ("mesh_cycle", mesh_cycles::rows()?),
        ("steady_states", of(&swept, &["amplitude"])),
        ("torque_growth", torque_growth::rows()?),
        ("stability", [of(&swept, &["multiplier"]), stability::rows(&closed)?].concat()),
    ];
    for (name, mut rows) in tables {
        for row in &mut rows {
            row.id = row.name();
            row.version = DATA_SET_VERSION.to_owned();
        }
        fs::write(folder.join(format!("{name}.csv")), write_rows(&rows)?)?;
        eprintln!("{name}: {} rows", rows.len());
    }
    Ok(())
}
