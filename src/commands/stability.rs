//! `stability [MAP]`: methods and sets pushed until they fail.

use std::io::Write;
use std::path::Path;

use experiments::stability::{Border, MAPS, Map, StabilityMap, stability_map};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;
use validation::PublishedScene;

use crate::arguments::{Stability, TableFormat};
use crate::error::CommandError;
use crate::output;

use super::files::ResultFiles;
use super::working::Working;
use super::{read_scene, unfit};

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

const HEADER: [&str; 6] = ["of", "quantity", "unit", "measured", "theory", "difference_percent"];

pub(super) fn run(
    arguments: &Stability,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<(), CommandError> {
    if arguments.guards {
        return super::stability_guards::run(arguments.format, out);
    }
    let Some(which) = arguments.map else {
        return list(arguments, out);
    };
    if arguments.scene.is_some() && !which.is_of_a_scene() {
        let reason = format!("the map {} is of no scene: leave it out", which.name);
        return Err(CommandError::Argument { argument: "--scene", reason });
    }
    let scene = match &arguments.scene {
        Some(path) => {
            let scene = read_scene(path)?;
            super::needs::warn(&scene, err)?;
            scene
        }
        None => built_in()?,
    };
    let files = ResultFiles::new(arguments.out.as_deref(), which.name)?;
    let working = Working::new("computing the map");
    let map = stability_map(which, &scene).map_err(|e| match &arguments.scene {
        Some(path) => unfit(path, e.to_string()),
        None => unfit(Path::new("the scene built in"), e.to_string()),
    })?;
    drop(working);
    let result = StabilityOutput { version: env!("CARGO_PKG_VERSION").into(), map };
    let saved = files.save(
        &result,
        |out| write_csv(&result.map, out),
        |folder| figure(&result.map, folder),
    );
    // What was computed is shown also where it cannot be saved.
    let shown = match arguments.format {
        TableFormat::Json => output::json(out, &result),
        TableFormat::Csv => write_csv(&result.map, out),
        TableFormat::Text => write_text(&result.map, out),
    };
    saved.and(shown)
}

/// Draws a map into a folder.
#[cfg(feature = "charts")]
fn figure(map: &StabilityMap, folder: &Path) -> Result<(), CommandError> {
    Ok(crate::figures::save(&[crate::figures::of_map(map)], folder)?)
}

#[cfg(not(feature = "charts"))]
fn figure(_: &StabilityMap, _: &Path) -> Result<(), CommandError> {
    Ok(())
}

/// Five equally spaced planets: the set that shows every kind of mode and of phasing.
pub(super) fn built_in() -> Result<Scene, CommandError> {
    validation::scene(PublishedScene::FivePlanets)
        .map_err(|source| CommandError::Scene { path: "the scene built in".into(), source })
}

/// The maps that there are.
fn list(arguments: &Stability, out: &mut dyn Write) -> Result<(), CommandError> {
    if let Some(argument) =
        [("--scene", arguments.scene.is_some()), ("--out", arguments.out.is_some())]
            .into_iter()
            .find_map(|(name, is_given)| is_given.then_some(name))
    {
        let reason = "no map is named: name one of those that `epicyclic stability` lists".into();
        return Err(CommandError::Argument { argument, reason });
    }
    let entry = |m: &Map| MapEntry {
        name: m.name.into(),
        meaning: m.meaning.into(),
        takes_scene: m.is_of_a_scene(),
    };
    let maps: Vec<MapEntry> = MAPS.into_iter().map(entry).collect();
    match arguments.format {
        TableFormat::Json => output::json(out, &StabilityList { maps }),
        TableFormat::Csv => {
            let row =
                |m: &MapEntry| vec![m.name.clone(), m.meaning.clone(), m.takes_scene.to_string()];
            output::csv(out, &["name", "meaning", "takes_scene"], maps.iter().map(row))
        }
        TableFormat::Text => {
            maps.iter().try_for_each(|m| writeln!(out, "{:<19} {}", m.name, m.meaning))?;
            Ok(())
        }
    }
}

fn write_csv(map: &StabilityMap, out: &mut dyn Write) -> Result<(), CommandError> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let row = |b: &Border| {
        vec![
            b.of.clone(),
            b.quantity.clone(),
            b.unit.clone(),
            number(b.measured),
            number(b.theory),
            number(b.difference_percent),
        ]
    };
    output::csv(out, &HEADER, map.borders.iter().map(row))
}

pub(super) fn write_text(map: &StabilityMap, out: &mut dyn Write) -> Result<(), CommandError> {
    writeln!(out, "{}: {}\n", map.map, map.system)?;
    let mut table =
        output::table(&["of", "what", "measured", "theory", "difference %"], &[2, 3, 4]);
    for b in &map.borders {
        let unit = if b.unit.is_empty() { String::new() } else { format!(", {}", b.unit) };
        table.add_row([
            b.of.clone(),
            format!("{}{unit}", b.quantity),
            b.measured.map_or("–".into(), shown),
            b.theory.map_or("–".into(), shown),
            b.difference_percent.map_or("–".into(), percent),
        ]);
    }
    writeln!(out, "{table}")?;
    writeln!(out, "{}", map.meaning)?;
    Ok(())
}

/// Two decimals, zero without a sign.
fn percent(x: f64) -> String {
    let shown = format!("{x:.2}");
    if shown == "-0.00" { "0.00".into() } else { shown }
}

/// Six digits; powers of ten where a number is very small or large.
fn shown(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if !(1e-3..1e6).contains(&a) => format!("{x:.4e}"),
        a => format!("{x:.*}", 5usize.saturating_sub(a.log10().floor().max(0.0) as usize)),
    }
}
