//! What `sweep` prints and writes.

use std::io::Write;

use experiments::sweep::{Part, Response, SteadySettings, Sweep, SweepPoint};
use gearset::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::CommandError;
use crate::output;

/// A sweep as JSON.
#[derive(Debug, Serialize, JsonSchema)]
pub struct SweepOutput {
    /// Scene.
    scene: String,
    /// Name of the fidelity or model.
    fidelity: String,
    /// Version of the program.
    version: String,
    /// Torque on the sun, N·m.
    torque_nm: f64,
    /// Steps in a mesh cycle.
    steps_per_cycle: u32,
    /// Largest change of a steady state from cycle to cycle, over its peak-to-peak vibration.
    tolerance: f64,
    /// Largest number of mesh cycles integrated at one speed.
    most_cycles: usize,
    /// Highest harmonic.
    harmonics: usize,
    /// Cycles over which energy between harmonics is measured.
    between_cycles: usize,
    /// Points by chain.
    chains: Vec<ChainOutput>,
}

/// One chain.
#[derive(Debug, Serialize, JsonSchema)]
struct ChainOutput {
    /// Name.
    name: String,
    /// Points in the order they were computed in.
    points: Vec<SweepPoint>,
}

/// The JSON file beside the table of a sweep.
#[derive(Debug, Serialize)]
pub(super) struct Sidecar<'a> {
    #[serde(flatten)]
    head: serde_json::Map<String, serde_json::Value>,
    /// The scene file.
    scene_file: &'a str,
    columns: [(&'static str, &'static str); 14],
    points: Vec<PointHead<'a>>,
}

/// A point without its harmonics.
#[derive(Debug, Serialize)]
struct PointHead<'a> {
    chain: &'a str,
    speed_rpm: f64,
    mesh_frequency_hz: f64,
    cycles: usize,
    residual: f64,
    is_steady: bool,
    between_harmonics: Option<f64>,
    backside_contact: f64,
    times_load_doubled: usize,
    kinematic_rest_m: Option<f64>,
    kinematic_rest_share: Option<f64>,
}

const COLUMNS: [(&str, &str); 14] = [
    ("scene", "title of the scene"),
    ("fidelity", "fidelity of the fidelity ladder"),
    ("torque_nm", "torque on the sun, N m"),
    ("speed_rpm", "speed of the input member, rpm"),
    ("mesh_frequency_hz", "mesh frequency, Hz"),
    ("chain", "chain of the plan: up, down, or about a peak"),
    ("body", "carrier, ring, sun, planet_n, sun_mesh_n, ring_mesh_n"),
    (
        "coordinate",
        "radial, tangential (m; central bodies: towards planet 0), rotation (rad), force (N), share and contact_loss (1)",
    ),
    ("harmonic", "harmonic of the mesh frequency; 0 is the mean"),
    ("amplitude", "amplitude in the unit of the next column"),
    ("unit", "unit"),
    ("phase_rad", "phase of A cos(2 pi l f_m t + phase), t from position 0, rad"),
    ("cycles", "mesh cycles marched"),
    ("residual", "change of the last two cycles over the largest peak-to-peak vibration"),
];

impl SweepOutput {
    pub(super) fn new(
        scene: &Scene,
        torque_nm: f64,
        settings: &SteadySettings,
        sweep: &Sweep,
    ) -> Self {
        let chain = |(name, points): &(String, Vec<SweepPoint>)| ChainOutput {
            name: name.clone(),
            points: points.clone(),
        };
        Self {
            scene: scene.title.clone(),
            fidelity: sweep.fidelity.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            torque_nm,
            steps_per_cycle: scene.dynamics.steps_per_cycle,
            tolerance: settings.tolerance,
            most_cycles: settings.most_cycles,
            harmonics: settings.harmonics,
            between_cycles: settings.between_cycles,
            chains: sweep.chains.iter().map(chain).collect(),
        }
    }

    /// Scene, settings, version and tolerances beside the table.
    pub(super) fn sidecar<'a>(&'a self, scene_file: &'a str) -> Sidecar<'a> {
        let mut head = serde_json::Map::new();
        head.insert("scene".into(), self.scene.clone().into());
        head.insert("fidelity".into(), self.fidelity.clone().into());
        head.insert("version".into(), self.version.clone().into());
        head.insert("torque_nm".into(), self.torque_nm.into());
        head.insert("steps_per_cycle".into(), self.steps_per_cycle.into());
        head.insert("tolerance".into(), self.tolerance.into());
        head.insert("most_cycles".into(), self.most_cycles.into());
        head.insert("harmonics".into(), self.harmonics.into());
        head.insert("between_cycles".into(), self.between_cycles.into());
        let points = self.chains.iter().flat_map(|chain| {
            chain.points.iter().map(|p| PointHead {
                chain: &chain.name,
                speed_rpm: p.state.case.speed_rpm,
                mesh_frequency_hz: p.state.case.mesh_frequency_hz,
                cycles: p.cycles,
                residual: p.residual,
                is_steady: p.is_steady,
                between_harmonics: p.between,
                backside_contact: p.backside_contact,
                times_load_doubled: p.size,
                kinematic_rest_m: p.kinematic_rest_m,
                kinematic_rest_share: p.kinematic_rest_share,
            })
        });
        Sidecar { head, scene_file, columns: COLUMNS, points: points.collect() }
    }
}

/// The tidy table.
pub(super) fn write_csv(
    sweep: &Sweep,
    scene: &str,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let mut writer = csv::Writer::from_writer(out);
    for row in sweep.rows(scene) {
        writer.serialize(row)?;
    }
    Ok(writer.flush()?)
}

/// One line per speed: strongest harmonics of the sun's motion, contact loss, cycles and residual.
pub(super) fn text(result: &SweepOutput, out: &mut dyn Write) -> Result<(), CommandError> {
    writeln!(out, "{}: {}, {} N·m on the sun\n", result.scene, result.fidelity, result.torque_nm)?;
    let header = [
        "chain",
        "rpm",
        "f_m Hz",
        "rotation µrad",
        "l",
        "translation µm",
        "l",
        "no contact",
        "cycles",
        "residual",
    ];
    let mut table = output::table(&header, &[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    let (mut unsteady, mut beyond) = (0, 0);
    for chain in &result.chains {
        for p in &chain.points {
            let rotation = Response::Rotation(Part::Sun).strongest(&p.state, result.harmonics);
            let translation =
                Response::Translation(Part::Sun).strongest(&p.state, result.harmonics);
            unsteady += usize::from(!p.is_steady);
            beyond += usize::from(p.is_beyond_linear);
            table.add_row([
                chain.name.clone(),
                format!("{:.1}", p.state.case.speed_rpm),
                format!("{:.1}", p.state.case.mesh_frequency_hz),
                format!("{:.3}", 1e6 * rotation.0),
                rotation.1.to_string(),
                format!("{:.4}", 1e6 * translation.0),
                if translation.0 > 1e-12 { translation.1.to_string() } else { "–".into() },
                output::share(p.state.largest_contact_loss()),
                p.cycles.to_string(),
                format!("{:.0e}", p.residual),
            ]);
        }
    }
    writeln!(out, "{table}")?;
    writeln!(
        out,
        "Sun's strongest harmonic l of the mesh frequency; no contact: largest part of a cycle in which a mesh carries nothing."
    )?;
    if beyond > 0 {
        writeln!(
            out,
            "Warning: at {beyond} of these speeds approaches of tooth pairs are off their linear form about the mean loaded configuration by more than 1 % of the sun's motion; `dynamics.kinematics` = \"exact\" sweeps without it, slowly."
        )?;
    }
    if unsteady > 0 {
        writeln!(
            out,
            "{unsteady} of these do not repeat from cycle to cycle within {} cycles: see their residuals.",
            result.most_cycles
        )?;
    }
    Ok(())
}
