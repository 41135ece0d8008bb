//! What `branches` prints.

use std::io::Write;

use experiments::branches::{Branch, BranchEnd, BranchPointKind, BranchSettings};
use experiments::sweep::{Part, Response};
use gearset::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::CommandError;
use crate::output;

/// A branch as JSON.
#[derive(Debug, Serialize, JsonSchema)]
pub struct BranchesOutput {
    /// Scene.
    scene: String,
    /// Version of the program.
    version: String,
    /// Torque on the sun, N·m.
    sun_torque_nm: f64,
    /// Factor on every damping of the scene.
    damping_factor: f64,
    /// Steps in a mesh cycle.
    steps_per_cycle: u32,
    /// Least and greatest speed, rpm.
    speeds_rpm: [f64; 2],
    /// Speed at which the branch was begun, rpm.
    start_rpm: f64,
    /// Highest harmonic.
    harmonics: usize,
    /// Speeds of the folds in order along the branch, rpm.
    folds_rpm: Vec<f64>,
    #[serde(flatten)]
    branch: Branch,
}

impl BranchesOutput {
    pub(super) fn new(
        scene: &Scene,
        sun_torque_nm: f64,
        damping_factor: f64,
        settings: &BranchSettings,
        branch: Branch,
    ) -> Self {
        Self {
            scene: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            sun_torque_nm,
            damping_factor,
            steps_per_cycle: scene.dynamics.steps_per_cycle,
            speeds_rpm: settings.speeds_rpm,
            start_rpm: settings.start_rpm,
            harmonics: settings.harmonics,
            folds_rpm: branch.folds().map(|p| p.state.case.speed_rpm).collect(),
            branch,
        }
    }

    /// The tidy table.
    pub(super) fn write_csv(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let mut writer = csv::Writer::from_writer(out);
        for row in self.branch.rows(&self.scene) {
            writer.serialize(row)?;
        }
        Ok(writer.flush()?)
    }

    /// One line per point in order along the branch, then a legend and why it ends.
    pub(super) fn text(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let (scene, fidelity) = (&self.scene, &self.branch.fidelity);
        let torque = self.sun_torque_nm;
        writeln!(out, "{scene}: {fidelity}, {torque} N·m on the sun\n")?;
        let header = [
            "rpm",
            "point",
            "stable",
            "μ",
            "rotation µrad",
            "l",
            "translation µm",
            "l",
            "lowest N",
            "no contact",
            "grazing",
            "residual",
        ];
        let mut table = output::table(&header, &[0, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
        for p in &self.branch.points {
            let rotation = Response::Rotation(Part::Sun).strongest(&p.state, self.harmonics);
            let translation = Response::Translation(Part::Sun).strongest(&p.state, self.harmonics);
            table.add_row([
                format!("{:.3}", p.state.case.speed_rpm),
                match p.kind {
                    BranchPointKind::Regular => String::new(),
                    other => other.name().replace('_', " "),
                },
                if p.is_stable { "yes".into() } else { "no".into() },
                format!("{:.4}", p.largest_multiplier()),
                format!("{:.3}", 1e6 * rotation.0),
                rotation.1.to_string(),
                format!("{:.4}", 1e6 * translation.0),
                if translation.0 > 1e-12 { translation.1.to_string() } else { "–".into() },
                format!("{:.0}", p.lowest_force_n),
                output::share(p.contact_loss),
                p.grazing_margin.map_or("–".into(), |margin| format!("{margin:.3}")),
                format!("{:.0e}", p.residual),
            ]);
        }
        writeln!(out, "{table}")?;
        writeln!(out, "{LEGEND}")?;
        for (end, words) in self.branch.ends.iter().zip(["first", "last"]) {
            match end {
                BranchEnd::Bound => {}
                BranchEnd::Closed => writeln!(out, "The branch is closed.")?,
                BranchEnd::MostPoints => {
                    writeln!(
                        out,
                        "It goes on beyond its {words} point: --max-points was reached."
                    )?;
                }
                BranchEnd::Stuck(why) => {
                    writeln!(out, "It could not be followed beyond its {words} point: {why}.")?;
                }
            }
        }
        Ok(())
    }
}

/// Below the table: what each column is.
const LEGEND: &str = "\
points are in order along the branch, which turns back in speed at folds
μ: size of the largest Floquet multiplier, below 1 if the motion is stable
rotation, translation: the sun's strongest harmonic, and its number l as a multiple of the mesh frequency
lowest N: lowest force of any mesh during a cycle, N
no contact: largest part of the time in which a mesh carries nothing; – for never
grazing: least of lowest over mean force of the meshes that never part; – where all part";
