//! `stability [MAP]`: methods and sets pushed until they fail.

mod guards;

pub(crate) use guards::GuardList;

use std::io::Write;
use std::path::Path;

use experiments::stability::{Border, MAPS, Map, StabilityMap, stability_map};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;
use validation::PublishedScene;

use crate::arguments::Stability;
use crate::error::{CommandError, Result, refused, unfit};
use crate::folder::ResultFiles;
use crate::inputs::{Working, needs, read_scene};
use crate::output::{self, Notation, Report, Table};

/// `stability MAP --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct StabilityOutput {
    /// Version of the program.
    version: String,
    #[serde(flatten)]
    map: StabilityMap,
}

/// `stability --format json`, without a map.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct StabilityList {
    maps: Vec<MapEntry>,
}

/// A map that can be asked for.
#[derive(Debug, Serialize, JsonSchema)]
struct MapEntry {
    name: String,
    /// What its border means.
    meaning: String,
    /// Whether `--scene` says for which set.
    takes_scene: bool,
}

pub(super) fn run(arguments: &Stability, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    if arguments.guards {
        return guards::run(arguments.format, out);
    }
    let Some(which) = arguments.map else {
        return list(arguments, out);
    };
    if arguments.scene.is_some() && !which.is_of_a_scene() {
        let reason = format!("the map {} is of no scene: leave it out", which.name);
        return Err(refused("--scene", reason));
    }
    let scene = match &arguments.scene {
        Some(path) => {
            let scene = read_scene(path, err)?;
            needs::warn(&scene, None, None, err)?;
            scene
        }
        None => built_in()?,
    };
    let files = ResultFiles::new(arguments.out.as_deref(), which.name)?;
    let working = Working::new("computing the map");
    let map = stability_map(which, &scene).map_err(|e| match &arguments.scene {
        Some(path) => unfit(path, e),
        None => unfit(Path::new("the scene built in"), e),
    })?;
    drop(working);
    let result = StabilityOutput { version: env!("CARGO_PKG_VERSION").into(), map };
    let saved = files.save(&result);
    #[cfg(feature = "charts")]
    let saved = saved.and_then(|()| files.draw(|| crate::figures::of_map(&result.map)));
    // What was computed is shown also where it cannot be saved.
    let shown = output::show(arguments.format, &result, out);
    saved.and(shown)
}

/// Five equally spaced planets: the set that shows every kind of mode and of phasing.
pub(super) fn built_in() -> Result<Scene> {
    validation::scene(PublishedScene::FivePlanets)
        .map_err(|source| CommandError::Scene { path: "the scene built in".into(), source })
}

/// The maps that there are.
fn list(arguments: &Stability, out: &mut dyn Write) -> Result<()> {
    if let Some(argument) =
        [("--scene", arguments.scene.is_some()), ("--out", arguments.out.is_some())]
            .into_iter()
            .find_map(|(name, is_given)| is_given.then_some(name))
    {
        let reason = "no map is named: name one of those that `epicyclic stability` lists";
        return Err(refused(argument, reason));
    }
    let entry = |m: &Map| MapEntry {
        name: m.name.into(),
        meaning: m.meaning.into(),
        takes_scene: m.is_of_a_scene(),
    };
    let maps = MAPS.into_iter().map(entry).collect();
    output::show(arguments.format, &StabilityList { maps }, out)
}

impl Report for StabilityList {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let table = Table::<&MapEntry>::new()
            .column("name", "", |m| &m.name)
            .column("meaning", "", |m| &m.meaning)
            .column("takes_scene", "", |m| m.takes_scene);
        table.csv(&self.maps, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        self.maps.iter().try_for_each(|m| writeln!(out, "{:<19} {}", m.name, m.meaning))?;
        Ok(())
    }
}

fn table<'r>() -> Table<'r, &'r Border> {
    use Notation::{Digits, Fixed, Plain};
    let what = |b: &&Border| match b.unit.as_str() {
        "" => b.quantity.clone(),
        unit => format!("{}, {unit}", b.quantity),
    };
    // Zero without a sign.
    let percent = |x: f64| Fixed(2).number(if x.abs() < 0.005 { 0.0 } else { x });
    Table::<&Border>::new()
        .column("of", "", |b| &b.of)
        .shown("of", Plain)
        .column("quantity", "", |b| &b.quantity)
        .shown_as("what", what)
        .column("unit", "", |b| &b.unit)
        .column("measured", "", |b| b.measured)
        .shown("measured", Digits)
        .column("theory", "", |b| b.theory)
        .shown("theory", Digits)
        .column("difference_percent", "", |b| b.difference_percent)
        .shown_as("difference %", move |b| b.difference_percent.map_or("–".into(), percent))
}

impl Report for StabilityOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(&self.map.borders, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        write_text(&self.map, out)
    }
}

pub(super) fn write_text(map: &StabilityMap, out: &mut dyn Write) -> Result<()> {
    writeln!(out, "{}: {}\n", map.map, map.system)?;
    table().text(&map.borders, out)?;
    Ok(writeln!(out, "{}", map.meaning)?)
}
