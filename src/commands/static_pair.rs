//! `static` of one mesh alone.

use std::io::Write;

use fe_contact::statics::{Bodies, PairAtPhase, PairCycle, ToothPairLoad, pair_cycle};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{Static, TableFormat};
use crate::error::CommandError;
#[cfg(feature = "charts")]
use crate::figures;
use crate::output;

use super::working::Working;
use super::{fe_refused, statics, unfit};

/// `static --format json` of a gear pair. δ = r_b · elastic rotation of the driving gear, the driven
/// one held; positive in approach, zero unloaded.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct PairOutput {
    /// sun_planet or ring_planet.
    mesh: String,
    normal_force_n: f64,
    /// Mean over the positions of F/δ.
    mean_secant_stiffness_n_per_m: f64,
    /// Mean over the positions of ΔF/Δδ for a load step of 1 %.
    mean_tangent_stiffness_n_per_m: f64,
    /// Mean of δ.
    transmission_error_mean_um: f64,
    transmission_error_peak_to_peak_um: f64,
    /// Mean number of loaded pairs.
    effective_contact_ratio: f64,
    /// Evenly spaced phases from 0, where pair 0 starts the theoretical path of contact.
    positions: Vec<PairPosition>,
}

/// One position.
#[derive(Debug, Serialize, JsonSchema)]
struct PairPosition {
    /// Cycles.
    phase: f64,
    transmission_error_um: f64,
    tangent_stiffness_n_per_m: f64,
    /// Loaded pairs; pair k stands k base pitches on from pair 0.
    pairs: Vec<PairLoad>,
}

/// One loaded tooth pair.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct PairLoad {
    pub(super) index: i64,
    pub(super) force_n: f64,
    /// Largest cell pressure; singular at a tip corner.
    pub(super) peak_pressure_pa: f64,
}

impl PairLoad {
    pub(super) fn of(load: &ToothPairLoad) -> Self {
        let ToothPairLoad { index, force, peak_pressure } = *load;
        Self { index, force_n: force, peak_pressure_pa: peak_pressure }
    }
}

pub(super) fn run(
    arguments: &Static,
    scene: &Scene,
    force: f64,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let path = &arguments.scene;
    let kind = scene.pair.ok_or_else(|| unfit(path, "`mesh` is absent"))?;
    let working = Working::new("meshing the bodies and solving the positions");
    let bodies = Bodies::new(scene).map_err(fe_refused(path))?;
    let solver = statics::solver(arguments.solver);
    let positions = arguments.position_count();
    let cycle = pair_cycle(&bodies, kind, force, positions, solver).map_err(fe_refused(path))?;
    drop(working);
    let saved: Result<(), CommandError> = Ok(());
    #[cfg(feature = "charts")]
    let saved = arguments.figures.as_ref().map_or(saved, |folder| {
        Ok(figures::save(&figures::of_pair_cycle(&scene.title, &cycle), folder)?)
    });
    // What was computed is shown also where its figures cannot be saved.
    let shown = match arguments.format {
        TableFormat::Json => output::json(out, &describe(&cycle)),
        TableFormat::Csv => csv(&cycle, out),
        TableFormat::Text => text(scene, &bodies, &cycle, out).map_err(CommandError::from),
    };
    saved.and(shown)
}

fn describe(cycle: &PairCycle) -> PairOutput {
    let position = |p: &PairAtPhase| PairPosition {
        phase: p.phase,
        transmission_error_um: p.deflection * 1e6,
        tangent_stiffness_n_per_m: p.step_tangent,
        pairs: p.pairs.iter().map(PairLoad::of).collect(),
    };
    PairOutput {
        mesh: cycle.kind.name().into(),
        normal_force_n: cycle.force,
        mean_secant_stiffness_n_per_m: cycle.mean_secant_stiffness(),
        mean_tangent_stiffness_n_per_m: cycle.mean_tangent_stiffness(),
        transmission_error_mean_um: cycle.mean_deflection() * 1e6,
        transmission_error_peak_to_peak_um: cycle.peak_to_peak() * 1e6,
        effective_contact_ratio: cycle.effective_contact_ratio(),
        positions: cycle.positions.iter().map(position).collect(),
    }
}

fn csv(cycle: &PairCycle, out: &mut dyn Write) -> Result<(), CommandError> {
    let row = |p: &PairAtPhase, l: &ToothPairLoad| {
        let own = [p.phase, p.deflection * 1e6, p.step_tangent].map(|x| x.to_string());
        let mut row = Vec::from(own);
        row.extend([l.index.to_string(), l.force.to_string(), l.peak_pressure.to_string()]);
        row
    };
    let rows = cycle.positions.iter().flat_map(|p| p.pairs.iter().map(move |l| row(p, l)));
    let header = [
        "phase",
        "transmission_error_um",
        "tangent_stiffness_n_per_m",
        "pair",
        "force_n",
        "peak_pressure_pa",
    ];
    output::csv(out, &header, rows)
}

fn text(
    scene: &Scene,
    bodies: &Bodies,
    cycle: &PairCycle,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    writeln!(out, "{}", scene.title)?;
    let name = cycle.kind.name();
    let (count, force) = (cycle.positions.len(), cycle.force);
    writeln!(out, "{name} mesh under {force:.2} N, {count} positions of the mesh cycle")?;
    // N/(mm µm)
    let per_width = |k: f64| k / bodies.geometry.face_width * 1e-9;
    for (what, k) in [
        ("mean secant stiffness F/δ", cycle.mean_secant_stiffness()),
        ("mean tangent stiffness ΔF/Δδ, 1 % step", cycle.mean_tangent_stiffness()),
    ] {
        writeln!(out, "{what}: {:.2}e6 N/m ({:.2} N/(mm µm))", k * 1e-6, per_width(k))?;
    }
    let (mean, range) = (cycle.mean_deflection() * 1e6, cycle.peak_to_peak() * 1e6);
    writeln!(out, "transmission error: mean {mean:.3} µm, peak to peak {range:.3} µm")?;
    writeln!(out, "effective contact ratio: {:.4}", cycle.effective_contact_ratio())?;
    let header = ["phase", "δ µm", "ΔF/Δδ 1e6 N/m", "pairs: force N (peak pressure MPa)"];
    let mut table = output::table(&header, &[0, 1, 2]);
    // About 20 rows; the other formats give every position.
    let step = count.div_ceil(20);
    for p in cycle.positions.iter().step_by(step) {
        let pairs: Vec<String> = p
            .pairs
            .iter()
            .map(|l| format!("{}: {:.0} ({:.0})", l.index, l.force, l.peak_pressure * 1e-6))
            .collect();
        table.add_row(vec![
            format!("{:.4}", p.phase),
            format!("{:.4}", p.deflection * 1e6),
            format!("{:.1}", p.step_tangent * 1e-6),
            pairs.join(", "),
        ]);
    }
    writeln!(out, "{table}")?;
    writeln!(out, "contact iterations: {}", cycle.iterations())
}
