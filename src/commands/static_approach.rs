//! `static --approach-um`: a gear pair at one phase with its driving race rotated, also as a CalculiX deck.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use fe_contact::export::calculix::{DeckSettings, deck};
use fe_contact::statics::{Bodies, at_approach};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{Static, TableFormat};
use crate::error::CommandError;
use crate::output;

use super::working::Working;
use super::{fe_refused, loads, refused, save, statics, unfit, writable};

/// `static --approach-um --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ApproachOutput {
    /// Torque on the driving gear over its base radius.
    force_n: f64,
    /// Time of meshing, factorising and solving, to compare two programs in one run.
    seconds: f64,
    /// Time of solving alone.
    solve_seconds: f64,
    pairs: Vec<ApproachPair>,
}

/// One tooth pair within reach of the approach.
#[derive(Debug, Serialize, JsonSchema)]
struct ApproachPair {
    index: i64,
    force_n: f64,
    /// Peak of the ellipse fitted to the pressures; null at a corner, where they are singular.
    peak_pressure_pa: Option<f64>,
}

pub(super) fn run(
    arguments: &Static,
    scene: &Scene,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<(), CommandError> {
    let path = &arguments.scene;
    let kind = scene.pair.ok_or_else(|| unfit(path, "`mesh` is absent"))?;
    let approach_um = loads::approach(arguments.approach_um.unwrap_or(0.0), scene, err)?;
    writable(arguments.export_inp.as_deref())?;
    let phase = arguments.phase.unwrap_or(0.0);
    if !phase.is_finite() {
        let reason = format!("{phase}: allowed is a finite number of cycles");
        return Err(refused("--phase", reason));
    }
    let phase = phase.rem_euclid(1.0);
    let start = Instant::now();
    let working = Working::new("meshing the bodies and solving the positions");
    let bodies = Bodies::new(scene).map_err(fe_refused(path))?;
    let before = Instant::now();
    let solver = statics::solver(arguments.solver);
    let own = at_approach(&bodies, kind, phase, approach_um * 1e-6, solver);
    let own = own.map_err(fe_refused(path))?;
    drop(working);
    let (seconds, solve_seconds) = (start.elapsed().as_secs_f64(), before.elapsed().as_secs_f64());
    let exported = |file: &Path| {
        let settings = DeckSettings {
            per_half_width: arguments.export_per_half_width.unwrap_or(12.0),
            flank_elements: arguments.export_flank_elements.unwrap_or(12) as usize,
            teeth: arguments.export_teeth.map(|n| n as usize),
            ..DeckSettings::default()
        };
        save(file, &deck(&bodies, &own, &settings).map_err(fe_refused(path))?)
    };
    let saved = arguments.export_inp.as_deref().map_or(Ok(()), exported);
    let pairs = own.pairs.iter().map(|p| ApproachPair {
        index: p.index,
        force_n: p.force,
        peak_pressure_pa: p.peak_pressure,
    });
    let result =
        ApproachOutput { force_n: own.force, seconds, solve_seconds, pairs: pairs.collect() };
    // What was computed is shown also where the deck cannot be written.
    let mut show = || match arguments.format {
        TableFormat::Json => output::json(out, &result),
        TableFormat::Csv => {
            let rows = result.pairs.iter().map(|p| {
                let peak = p.peak_pressure_pa.map_or(String::new(), |p| p.to_string());
                vec![p.index.to_string(), p.force_n.to_string(), peak]
            });
            output::csv(out, &["pair", "force_n", "peak_pressure_pa"], rows)
        }
        TableFormat::Text => {
            let (name, force) = (kind.name(), result.force_n);
            writeln!(out, "{}", scene.title)?;
            writeln!(out, "{name} mesh at phase {phase}, approach {approach_um} µm: {force:.2} N")?;
            for p in &result.pairs {
                let peak = p.peak_pressure_pa.map_or("at a corner".to_owned(), |p| {
                    format!("peak pressure {:.1} MPa", p * 1e-6)
                });
                writeln!(out, "pair {}: {:.2} N, {peak}", p.index, p.force_n)?;
            }
            Ok(())
        }
    };
    saved.and(show())
}
