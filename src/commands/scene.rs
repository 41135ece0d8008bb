//! `scene new` and `scene check`.

use std::io::Write;
use std::path::Path;

use gearset::{
    Geometry, Kinematics, Mesh, MeshKind, Phasing, PlanetPositions, Scene, SceneKind, template,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{Format, Kind, SceneVerb};
use crate::error::CommandError;
use crate::output;

use super::read_scene;

pub(crate) fn run(verb: &SceneVerb, out: &mut dyn Write) -> Result<(), CommandError> {
    match verb {
        SceneVerb::New { path, kind } => new(path, *kind, out),
        SceneVerb::Check { scene, format } => {
            let summary = SceneSummary::of(&read_scene(scene)?);
            match format {
                Format::Json => output::json(out, &summary),
                Format::Text => Ok(summary.write(out)?),
            }
        }
    }
}

fn new(path: &Path, kind: Kind, out: &mut dyn Write) -> Result<(), CommandError> {
    let text = template(match kind {
        Kind::Planetary => SceneKind::Planetary,
        Kind::GearPair => SceneKind::GearPair,
    });
    if path == Path::new("-") {
        return Ok(out.write_all(text.as_bytes())?);
    }
    let failed = |source| CommandError::File { what: "cannot write", path: path.into(), source };
    let mut file = std::fs::File::create_new(path).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    writeln!(out, "wrote {}; try: epicyclic scene check {}", path.display(), path.display())?;
    Ok(())
}

/// What a scene describes, with the quantities that follow from it: `scene check --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SceneSummary {
    title: String,
    kind: String,
    source: Option<String>,
    planet_positions_deg: Vec<f64>,
    planet_position_steps: Option<Vec<i64>>,
    center_distance_mm: Option<f64>,
    base_pitch_mm: Option<f64>,
    gears: Vec<GearSummary>,
    meshes: Vec<MeshSummary>,
    /// γ, path start to path start, cycles.
    gamma: Option<f64>,
    /// Sun mesh phases relative to planet 0, cycles.
    sun_mesh_phases: Option<Vec<f64>>,
    /// Ring mesh phases relative to planet 0's sun mesh, cycles.
    ring_mesh_phases: Option<Vec<f64>>,
    mesh_frequency_hz: Option<f64>,
    carrier_speed_rpm: Option<f64>,
    limits: Vec<String>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct GearSummary {
    gear: String,
    teeth: u32,
    base_diameter_mm: f64,
    tip_diameter_mm: f64,
    root_diameter_mm: f64,
    form_diameter_mm: f64,
    tooth_thickness_at_tip_mm: f64,
    fillet_radius_mm: f64,
}

#[derive(Debug, Serialize, JsonSchema)]
struct MeshSummary {
    mesh: String,
    pressure_angle_deg: f64,
    operating_module_mm: f64,
    contact_ratio: f64,
    backlash_mm: f64,
}

impl SceneSummary {
    fn of(scene: &Scene) -> Self {
        let geometry = Geometry::from_scene(scene).ok();
        let kinematics = Kinematics::from_scene(scene).ok();
        let geometry = geometry.as_ref();
        let phasing = geometry.and_then(|g| Phasing::new(g, &scene.planets));
        let phasing = phasing.filter(|_| scene.kind == SceneKind::Planetary);
        let phases = phasing.as_ref().map(|p| p.phases(0.0, gearset::Facing::CounterClockwise));
        let relative = |list: &[f64], zero: f64| {
            list.iter().map(|p| (p - zero).rem_euclid(1.0)).collect::<Vec<_>>()
        };
        let zero = phases.as_ref().map_or(0.0, |p| p.sun_planet[0]);
        Self {
            title: scene.title.clone(),
            kind: match scene.kind {
                SceneKind::Planetary => "planetary".into(),
                SceneKind::GearPair => "gear_pair".into(),
            },
            source: scene.source.clone(),
            planet_positions_deg: scene.planets.psi_rad.iter().map(|p| p.to_degrees()).collect(),
            planet_position_steps: scene.planets.steps.clone(),
            center_distance_mm: geometry.map(|g| 1e3 * g.center_distance),
            base_pitch_mm: geometry.map(|g| 1e3 * g.base_pitch),
            gears: geometry.map(gears).unwrap_or_default(),
            meshes: geometry.map(meshes).unwrap_or_default(),
            gamma: phasing.as_ref().map(Phasing::gamma),
            sun_mesh_phases: phases.as_ref().map(|p| relative(&p.sun_planet, zero)),
            ring_mesh_phases: phases.as_ref().map(|p| relative(&p.ring_planet, zero)),
            mesh_frequency_hz: kinematics.as_ref().map(|k| k.mesh_frequency_hz),
            carrier_speed_rpm: kinematics.as_ref().map(|k| k.speeds_rpm.carrier),
            limits: scene.limits(),
        }
    }

    fn write(&self, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(out, "{} ({}): a valid scene", self.title, self.kind)?;
        if let Some(source) = &self.source {
            writeln!(out, "source: {source}")?;
        }
        let degrees: Vec<_> =
            self.planet_positions_deg.iter().map(|d| format!("{d:.4}°")).collect();
        writeln!(out, "planets: {} at {}", degrees.len(), degrees.join(", "))?;
        if let Some(steps) = &self.planet_position_steps {
            writeln!(out, "in assembly steps: {steps:?}")?;
        }
        if let (Some(a), Some(p)) = (self.center_distance_mm, self.base_pitch_mm) {
            writeln!(out, "centre distance {a:.4} mm, base pitch {p:.5} mm")?;
        }
        if !self.gears.is_empty() {
            let header = ["gear", "Z", "base mm", "tip mm", "root mm", "form mm", "tip land mm"];
            let mut table = output::table(&header, &[1, 2, 3, 4, 5, 6]);
            for g in &self.gears {
                let mm = |x: f64| format!("{x:.4}");
                table.add_row(vec![
                    g.gear.clone(),
                    g.teeth.to_string(),
                    mm(g.base_diameter_mm),
                    mm(g.tip_diameter_mm),
                    mm(g.root_diameter_mm),
                    mm(g.form_diameter_mm),
                    mm(g.tooth_thickness_at_tip_mm),
                ]);
            }
            writeln!(out, "{table}")?;
            let header = ["mesh", "angle °", "module mm", "contact ratio", "backlash mm"];
            let mut table = output::table(&header, &[1, 2, 3, 4]);
            for m in &self.meshes {
                table.add_row(vec![
                    m.mesh.clone(),
                    format!("{:.4}", m.pressure_angle_deg),
                    format!("{:.4}", m.operating_module_mm),
                    format!("{:.4}", m.contact_ratio),
                    format!("{:.4}", m.backlash_mm),
                ]);
            }
            writeln!(out, "{table}")?;
        }
        if let (Some(gamma), Some(sun), Some(ring)) =
            (self.gamma, &self.sun_mesh_phases, &self.ring_mesh_phases)
        {
            let list =
                |p: &[f64]| p.iter().map(|x| format!("{x:.5}")).collect::<Vec<_>>().join(", ");
            writeln!(out, "γ = {gamma:.5} cycles")?;
            writeln!(out, "sun mesh phases:  {}", list(sun))?;
            writeln!(out, "ring mesh phases: {}", list(ring))?;
        }
        if let (Some(f), Some(n)) = (self.mesh_frequency_hz, self.carrier_speed_rpm) {
            writeln!(out, "mesh frequency {f:.2} Hz, carrier at {n:.2} rpm")?;
        }
        for limit in &self.limits {
            writeln!(out, "note: {limit}")?;
        }
        Ok(())
    }
}

fn gears(geometry: &Geometry) -> Vec<GearSummary> {
    [
        ("sun", geometry.sun.as_ref()),
        ("planet", Some(&geometry.planet)),
        ("ring", geometry.ring.as_ref()),
    ]
    .into_iter()
    .filter_map(|(name, gear)| Some((name, gear?)))
    .map(|(name, gear)| GearSummary {
        gear: name.to_owned(),
        teeth: gear.teeth,
        base_diameter_mm: 2e3 * gear.base_radius,
        tip_diameter_mm: 2e3 * gear.tip_radius,
        root_diameter_mm: 2e3 * gear.root_radius,
        form_diameter_mm: 2e3 * gear.form_radius(),
        tooth_thickness_at_tip_mm: 1e3 * gear.tooth_thickness(gear.tip_radius),
        fillet_radius_mm: 1e3 * gear.fillet_radius,
    })
    .collect()
}

fn meshes(geometry: &Geometry) -> Vec<MeshSummary> {
    let summary = |mesh: &Mesh| MeshSummary {
        mesh: mesh.kind.name().to_owned(),
        pressure_angle_deg: mesh.pressure_angle.to_degrees(),
        operating_module_mm: 1e3 * mesh.operating_module,
        contact_ratio: mesh.contact_ratio,
        backlash_mm: 1e3 * geometry.backlash(mesh.kind).unwrap_or(f64::NAN),
    };
    [MeshKind::SunPlanet, MeshKind::RingPlanet]
        .into_iter()
        .filter_map(|kind| geometry.mesh(kind).map(summary))
        .collect()
}

/// Positions for people, `0°, -88.57°, …`.
pub(crate) fn degrees(positions: &PlanetPositions) -> String {
    let each: Vec<_> =
        positions.psi_rad.iter().map(|psi| format!("{:.2}°", psi.to_degrees())).collect();
    each.join(", ")
}
