//! `static` of one mesh alone.

use std::io::Write;
use std::path::Path;

use fe_contact::contact::hertz;
use fe_contact::statics::{Bodies, PairAtPhase, PairCycle, pair_cycle};
use gearset::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{Static, TableFormat};
use crate::error::CommandError;
use crate::output;

use super::figure::{Curve, Labels, chart};
use super::picture::Picture;
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
    /// Even phases from 0, where pair 0 starts the theoretical path of contact.
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

pub(super) fn run(
    arguments: &Static,
    scene: &Scene,
    force: f64,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let path = &arguments.scene;
    let kind = scene.pair.ok_or_else(|| unfit(path, "`mesh` is absent"))?;
    let bodies = Bodies::new(scene).map_err(fe_refused(path))?;
    let solver = statics::solver(arguments.solver);
    let positions = arguments.positions as usize;
    let cycle = pair_cycle(&bodies, kind, force, positions, solver).map_err(fe_refused(path))?;
    if let Some(folder) = &arguments.figures {
        draw(scene, &cycle, folder)?;
    }
    match arguments.format {
        TableFormat::Json => output::json(out, &describe(&cycle)),
        TableFormat::Csv => Ok(csv(&cycle, out)?),
        TableFormat::Text => Ok(text(scene, &bodies, &cycle, out)?),
    }
}

fn describe(cycle: &PairCycle) -> PairOutput {
    let position = |p: &PairAtPhase| PairPosition {
        phase: p.phase,
        transmission_error_um: p.deflection * 1e6,
        tangent_stiffness_n_per_m: p.step_tangent,
        pairs: p
            .pairs
            .iter()
            .map(|l| PairLoad {
                index: l.index,
                force_n: l.force,
                peak_pressure_pa: l.peak_pressure,
            })
            .collect(),
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

fn csv(cycle: &PairCycle, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(
        out,
        "phase,transmission_error_um,tangent_stiffness_n_per_m,pair,force_n,peak_pressure_pa"
    )?;
    for p in &cycle.positions {
        for l in &p.pairs {
            let (te, k) = (p.deflection * 1e6, p.step_tangent);
            writeln!(out, "{},{te},{k},{},{},{}", p.phase, l.index, l.force, l.peak_pressure)?;
        }
    }
    Ok(())
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
    // A screenful; the other formats hold every position.
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
    let factorisations: usize = cycle.positions.iter().map(|p| p.iterations).sum();
    writeln!(out, "contact iterations: {factorisations}")
}

/// Stiffness and load sharing over the cycle, pressure where one pair stands mid-path.
fn draw(scene: &Scene, cycle: &PairCycle, folder: &Path) -> Result<(), CommandError> {
    let about = format!("{}, {} mesh, {:.0} N", scene.title, cycle.kind.name(), cycle.force);
    let over = |f: &dyn Fn(&PairAtPhase) -> f64| -> Vec<(f64, f64)> {
        cycle.positions.iter().map(|p| (p.phase, f(p))).collect()
    };
    let stiffness = chart(
        &Labels {
            title: "Mesh stiffness over the mesh cycle",
            subtitle: about.clone(),
            x: "phase, mesh cycles",
            y: "stiffness, 1e6 N/m",
        },
        &[
            Curve::new("secant F/δ", over(&|p| cycle.force / p.deflection * 1e-6)),
            Curve::new("tangent ΔF/Δδ", over(&|p| p.step_tangent * 1e-6)).dashed(),
        ],
    );
    stiffness.save(folder, "mesh_stiffness")?;
    let error = chart(
        &Labels {
            title: "Transmission error",
            subtitle: about.clone(),
            x: "phase, mesh cycles",
            y: "δ, µm",
        },
        &[Curve::new("", over(&|p| p.deflection * 1e6))],
    );
    error.save(folder, "transmission_error")?;
    // One tooth pair followed from its first to its last touch.
    let mut shares: Vec<(f64, f64)> = Vec::new();
    for p in &cycle.positions {
        for l in &p.pairs {
            shares.push((p.phase + l.index as f64, l.force * 1e-3));
        }
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let sharing = chart(
        &Labels {
            title: "Load of one tooth pair on its way",
            subtitle: about.clone(),
            x: "base pitches from the start of the path of contact",
            y: "force, kN",
        },
        &[Curve::new("", shares)],
    );
    sharing.save(folder, "load_sharing")?;
    let heaviest = cycle.positions.iter().max_by(|a, b| largest(a).total_cmp(&largest(b)));
    if let Some(p) = heaviest {
        pressure(p, about).save(folder, "pressure")?;
    }
    Ok(())
}

fn largest(p: &PairAtPhase) -> f64 {
    p.pairs.iter().map(|l| l.force).fold(0.0, f64::max)
}

/// Pressure of the heaviest pair with its fitted ellipse.
fn pressure(p: &PairAtPhase, about: String) -> Picture {
    let forces = &p.answer.pair_forces;
    let k = (0..forces.len()).max_by(|a, b| forces[*a].total_cmp(&forces[*b])).unwrap_or(0);
    let cells = &p.table.pairs[k];
    let own = &p.answer.cell_forces[cells.first..cells.first + cells.x.len()];
    let area = cells.width * p.table.face_width;
    let pressures: Vec<f64> = own.iter().map(|f| f / area).collect();
    let points = cells.x.iter().zip(&pressures).map(|(x, p)| (x * 1e3, p * 1e-6)).collect();
    let mut curves = vec![Curve::new("cells", points)];
    if let Some(fit) = hertz::fit(&cells.x, &pressures) {
        let reach = 0.5 * cells.width * cells.x.len() as f64;
        let ellipse = (0..=200)
            .map(|i| -reach + 2.0 * reach * f64::from(i) / 200.0)
            .map(|x| (x * 1e3, fit.pressure(x) * 1e-6))
            .collect();
        curves.push(Curve::new("ellipse fitted to p²", ellipse).dashed());
    }
    let (phase, index) = (p.phase, cells.index);
    chart(
        &Labels {
            title: "Contact pressure",
            subtitle: format!("{about}; pair {index} at phase {phase:.3}"),
            x: "along the flank, mm",
            y: "pressure, MPa",
        },
        &curves,
    )
}
