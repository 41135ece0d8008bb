//! A set of your own, from a scene file and changed in code: what softer planet bearings do to its natural frequencies.
//!
//! `cargo run --release --example own_set -- my_set.toml` (without a file: the template of `epicyclic scene new`)

use std::error::Error;
use std::path::Path;

use epicyclic::gearset::{Scene, SceneKind, template};
use epicyclic::lumped::{LumpedModel, NaturalModes};

fn main() -> Result<(), Box<dyn Error>> {
    let set = match std::env::args().nth(1) {
        Some(path) => Scene::from_file(Path::new(&path))?,
        None => Scene::from_toml(template(SceneKind::Planetary))?,
    };
    let mut soft = set.clone();
    let bearing = soft.supports.planet_bearing_n_per_m;
    soft.supports.planet_bearing_n_per_m = 0.5 * bearing;
    println!("{}: planet bearings of {bearing:.3e} N/m and half as stiff", set.title);
    let [given, softer] = [&set, &soft].map(frequencies);
    for ((hz, name), (soft_hz, _)) in given?.iter().zip(softer?) {
        println!("{hz:9.1} Hz {soft_hz:9.1} Hz  {name}");
    }
    Ok(())
}

/// Natural frequencies, Hz, each with the type of its modes.
fn frequencies(set: &Scene) -> Result<Vec<(f64, &'static str)>, Box<dyn Error>> {
    let modes = NaturalModes::of(&LumpedModel::from_scene(set)?)?;
    Ok(modes.groups.iter().map(|group| (group.frequency_hz, group.mode_type.name())).collect())
}
