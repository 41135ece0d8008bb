//! `static` of one mesh alone.

use std::io::Write;

use fe_contact::statics::{Bodies, PairAtPhase, PairCycle, pair_cycle};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use super::pair_load::PairLoad;
use super::solver::solver;
use crate::arguments::Static;
use crate::error::{Result, fe_refused, unfit};
#[cfg(feature = "charts")]
use crate::figures;
use crate::inputs::{Working, bodies};
use crate::output::{self, Notation, Report, Table};

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
    #[serde(skip)]
    title: String,
    #[serde(skip)]
    face_width_m: f64,
    /// Iterations of the contact solver.
    #[serde(skip)]
    iterations: usize,
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

pub(super) fn run(
    arguments: &Static,
    scene: &Scene,
    force: f64,
    out: &mut dyn Write,
) -> Result<()> {
    let path = &arguments.scene;
    let kind = scene.pair.ok_or_else(|| unfit(path, "`mesh` is absent"))?;
    let working = Working::new("meshing the bodies and solving the positions");
    let bodies = bodies(path, scene, arguments.large)?;
    let solver = solver(arguments.solver);
    let positions = arguments.position_count();
    let cycle = pair_cycle(&bodies, kind, force, positions, solver).map_err(fe_refused(path))?;
    drop(working);
    let saved: Result<()> = Ok(());
    #[cfg(feature = "charts")]
    let saved = arguments.figures.as_ref().map_or(saved, |folder| {
        Ok(figures::save(&figures::of_pair_cycle(&scene.title, &cycle), folder)?)
    });
    // What was computed is shown also where its figures cannot be saved.
    saved.and(output::show(arguments.format, &describe(scene, &bodies, &cycle), out))
}

fn describe(scene: &Scene, bodies: &Bodies, cycle: &PairCycle) -> PairOutput {
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
        title: scene.title.clone(),
        face_width_m: bodies.geometry.face_width,
        iterations: cycle.iterations(),
    }
}

/// A position in text, one of its tooth pairs in files.
type Row<'r> = (&'r PairPosition, Option<&'r PairLoad>);

fn table<'r>() -> Table<'r, Row<'r>> {
    use Notation::Fixed;
    let pairs = |(position, _): &Row<'r>| {
        let pair = |l: &PairLoad| {
            format!("{}: {:.0} ({:.0})", l.index, l.force_n, l.peak_pressure_pa * 1e-6)
        };
        position.pairs.iter().map(pair).collect::<Vec<_>>().join(", ")
    };
    Table::<Row<'r>>::new()
        .column("phase", "", |(p, _)| p.phase)
        .shown("phase", Fixed(4))
        .column("transmission_error_um", "", |(p, _)| p.transmission_error_um)
        .shown("δ µm", Fixed(4))
        .column("tangent_stiffness_n_per_m", "", |(p, _)| p.tangent_stiffness_n_per_m)
        .scaled("ΔF/Δδ 1e6 N/m", 1e-6, Fixed(1))
        .words("pairs: force N (peak pressure MPa)", Notation::Plain, pairs)
        .column("pair", "", |(_, load)| load.map(|l| l.index))
        .column("force_n", "", |(_, load)| load.map(|l| l.force_n))
        .column("peak_pressure_pa", "", |(_, load)| load.map(|l| l.peak_pressure_pa))
}

impl Report for PairOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let rows = self.positions.iter().flat_map(|p| p.pairs.iter().map(move |l| (p, Some(l))));
        table().csv(rows, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}", self.title)?;
        let count = self.positions.len();
        writeln!(
            out,
            "{} mesh under {:.2} N, {count} positions of the mesh cycle",
            self.mesh, self.normal_force_n
        )?;
        for (what, k) in [
            ("mean secant stiffness F/δ", self.mean_secant_stiffness_n_per_m),
            ("mean tangent stiffness ΔF/Δδ, 1 % step", self.mean_tangent_stiffness_n_per_m),
        ] {
            // N/(mm µm)
            let per_width = k / self.face_width_m * 1e-9;
            writeln!(out, "{what}: {:.2}e6 N/m ({per_width:.2} N/(mm µm))", k * 1e-6)?;
        }
        writeln!(
            out,
            "transmission error: mean {:.3} µm, peak to peak {:.3} µm",
            self.transmission_error_mean_um, self.transmission_error_peak_to_peak_um
        )?;
        writeln!(out, "effective contact ratio: {:.4}", self.effective_contact_ratio)?;
        // About 20 rows; the other formats give every position.
        let step = count.div_ceil(20);
        table().text(self.positions.iter().step_by(step).map(|p| (p, None)), out)?;
        Ok(writeln!(out, "contact iterations: {}", self.iterations)?)
    }
}
