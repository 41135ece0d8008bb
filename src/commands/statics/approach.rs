//! `static --approach-um`: a gear pair at one phase with its driving race rotated, also as a CalculiX deck.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use fe_contact::export::calculix::{DeckSettings, deck};
use fe_contact::statics::at_approach;
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use super::solver::solver;
use crate::arguments::Static;
use crate::error::{Result, fe_refused, refused, unfit};
use crate::folder::{save, writable};
use crate::inputs::{Working, bodies, loads};
use crate::output::{self, Report, Table};

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
    /// Title, mesh, phase and approach.
    #[serde(skip)]
    heading: String,
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
) -> Result<()> {
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
    let bodies = bodies(path, scene, arguments.large)?;
    let before = Instant::now();
    let solver = solver(arguments.solver);
    let found = at_approach(&bodies, kind, phase, approach_um * 1e-6, solver);
    let found = found.map_err(fe_refused(path))?;
    drop(working);
    let (seconds, solve_seconds) = (start.elapsed().as_secs_f64(), before.elapsed().as_secs_f64());
    let exported = |file: &Path| {
        let settings = DeckSettings {
            per_half_width: arguments.export_per_half_width.unwrap_or(12.0),
            flank_elements: arguments.export_flank_elements.unwrap_or(12) as usize,
            teeth: arguments.export_teeth.map(|n| n as usize),
            ..DeckSettings::default()
        };
        save(file, &deck(&bodies, &found, &settings).map_err(fe_refused(path))?)
    };
    let saved = arguments.export_inp.as_deref().map_or(Ok(()), exported);
    let pairs = found.pairs.iter().map(|p| ApproachPair {
        index: p.index,
        force_n: p.force,
        peak_pressure_pa: p.peak_pressure,
    });
    let (title, name) = (&scene.title, kind.name());
    let result = ApproachOutput {
        force_n: found.force,
        seconds,
        solve_seconds,
        pairs: pairs.collect(),
        heading: format!("{title}\n{name} mesh at phase {phase}, approach {approach_um} µm"),
    };
    // What was computed is shown also where the deck cannot be written.
    saved.and(output::show(arguments.format, &result, out))
}

impl Report for ApproachOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let table = Table::<&ApproachPair>::new()
            .column("pair", "", |p| p.index)
            .column("force_n", "", |p| p.force_n)
            .column("peak_pressure_pa", "", |p| p.peak_pressure_pa);
        table.csv(&self.pairs, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}: {:.2} N", self.heading, self.force_n)?;
        for p in &self.pairs {
            let peak = p
                .peak_pressure_pa
                .map_or("at a corner".to_owned(), |p| format!("peak pressure {:.1} MPa", p * 1e-6));
            writeln!(out, "pair {}: {:.2} N, {peak}", p.index, p.force_n)?;
        }
        Ok(())
    }
}
