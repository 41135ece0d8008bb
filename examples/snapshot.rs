//! A result kept as a snapshot in your repository: the run fails where a number that you rely on has moved.
//!
//! `cargo run --release --example snapshot`; a first run, or one with `INSTA_UPDATE=always`, writes
//! `examples/snapshots/snapshot__frequencies.snap`, whose difference you read before you commit it.

use std::error::Error;

use epicyclic::gearset::{Scene, SceneKind, template};
use epicyclic::lumped::{LumpedModel, NaturalModes};

fn main() -> Result<(), Box<dyn Error>> {
    let set = Scene::from_toml(template(SceneKind::Planetary))?;
    let modes = NaturalModes::of(&LumpedModel::from_scene(&set)?)?;
    // As many digits as other machines give as well
    let row = |hz: f64, name: &str| format!("{hz:.3} Hz {name}");
    let rows: Vec<String> =
        modes.groups.iter().map(|group| row(group.frequency_hz, group.mode_type.name())).collect();
    insta::assert_snapshot!("frequencies", rows.join("\n"));
    println!("{} frequencies as kept", rows.len());
    Ok(())
}
