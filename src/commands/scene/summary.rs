//! What a scene describes: `scene check`.

use fe_contact::FeError;
use fe_contact::statics::{estimate, within_memory};
use gearset::involute::roll_length_at;
use gearset::{Gear, Geometry, Mesh, MeshKind, Phasing};
use scene::{LoadCase, Remarks, Scene, SceneKind, Verb};
use schemars::JsonSchema;
use serde::Serialize;

use super::motion::MotionSummary;
use crate::commands::modes::ClosedForm;
use crate::output::word;

/// What a scene describes, with the quantities that follow from it: `scene check --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SceneSummary {
    pub(super) title: String,
    pub(super) kind: String,
    pub(super) source: Option<String>,
    pub(super) planet_positions_deg: Vec<f64>,
    pub(super) planet_position_steps: Option<Vec<i64>>,
    pub(super) center_distance_mm: Option<f64>,
    pub(super) base_pitch_mm: Option<f64>,
    pub(super) gears: Vec<GearSummary>,
    pub(super) meshes: Vec<MeshSummary>,
    /// γ, path start to path start, cycles.
    pub(super) gamma: Option<f64>,
    /// Sun mesh phases as they follow in time at the operating point, relative to planet 0, cycles.
    pub(super) sun_mesh_phases: Option<Vec<f64>>,
    /// Ring mesh phases in the same way, relative to planet 0's sun mesh, cycles.
    pub(super) ring_mesh_phases: Option<Vec<f64>>,
    pub(super) mesh_frequency_hz: Option<f64>,
    pub(super) carrier_speed_rpm: Option<f64>,
    /// Speeds and torques at the operating point.
    pub(super) motion: Option<MotionSummary>,
    /// Values of keys that the file leaves out and that follow from others.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) chosen: Vec<ChosenSummary>,
    /// What was taken for zero within the rounding of the digits written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) rounding: Vec<String>,
    pub(super) limits: Vec<String>,
    /// Keys in the file of which no verb that runs uses the value.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) idle: Vec<String>,
    /// Finite-element bodies of the gears; null if they cannot be meshed.
    pub(super) fe_bodies: Option<FeBodiesSummary>,
    /// Allowed values that are unlikely.
    pub(super) warnings: Vec<WarningSummary>,
    /// Every verb that reads a scene, `sweep` at each fidelity.
    pub(super) verbs: Vec<VerbSummary>,
}

/// A value that the file leaves out.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ChosenSummary {
    pub(super) key: String,
    /// In the unit of the key, numbers to five decimals or digits.
    pub(super) value: String,
    /// Where it comes from.
    pub(super) why: String,
}

/// Size of the finite-element bodies of the gears.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct FeBodiesSummary {
    pub(super) degrees_of_freedom: u64,
    /// Estimate of the largest memory while they are made, MB.
    pub(super) memory_mb: f64,
}

/// An allowed value that is unlikely.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct WarningSummary {
    pub(super) key: String,
    pub(super) value: String,
    pub(super) what: String,
    /// The slip that would explain it.
    pub(super) likely: String,
}

/// What a verb needs of the scene.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct VerbSummary {
    pub(super) verb: String,
    /// Whether it runs on the scene, with arguments where `lacks` names them.
    pub(super) runs: bool,
    pub(super) lacks: Vec<LackSummary>,
}

/// A key that is absent or unfit for the verb.
#[derive(Debug, PartialEq, Serialize, JsonSchema)]
pub(super) struct LackSummary {
    pub(super) key: String,
    pub(super) why: String,
    /// Argument that stands in for the key.
    pub(super) argument: Option<String>,
}

#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct GearSummary {
    pub(super) gear: String,
    pub(super) teeth: u32,
    pub(super) base_diameter_mm: f64,
    pub(super) tip_diameter_mm: f64,
    pub(super) root_diameter_mm: f64,
    pub(super) form_diameter_mm: f64,
    pub(super) tooth_thickness_at_tip_mm: f64,
    pub(super) fillet_radius_mm: f64,
    pub(super) tip_relief: Option<ReliefSummary>,
}

/// Tip relief of a gear.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ReliefSummary {
    /// linear or parabolic.
    pub(super) shape: String,
    /// At the tip circle, along the line of action.
    pub(super) amount_um: f64,
    pub(super) start_diameter_mm: f64,
    pub(super) start_roll_length_mm: f64,
    /// Relieved share of the roll length from form circle to tip circle.
    pub(super) relieved_share: f64,
}

#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct MeshSummary {
    pub(super) mesh: String,
    pub(super) pressure_angle_deg: f64,
    pub(super) operating_module_mm: f64,
    pub(super) contact_ratio: f64,
    pub(super) backlash_mm: f64,
}

impl SceneSummary {
    pub(super) fn new(scene: &Scene, remarks: Remarks) -> Self {
        let geometry = scene.tooth_geometry().ok();
        let kinematics = scene.kinematics().ok();
        let mesh_frequency_hz = LoadCase::of_scene(scene).ok().map(|case| case.mesh_frequency_hz);
        let geometry = geometry.as_ref();
        let phasing = geometry.and_then(|g| Phasing::new(g, &scene.planets));
        let phasing = phasing.filter(|_| scene.kind == SceneKind::Planetary);
        let case = LoadCase::of_scene(scene).unwrap_or(LoadCase::standing(0.0));
        let phases = phasing.as_ref().map(|p| p.phases(0.0, case.sense()));
        let direction = case.direction().sign();
        let relative = |list: &[f64], zero: f64| {
            // Not −0.
            let in_time = |phase: &f64| (direction * (phase - zero)).rem_euclid(1.0) + 0.0;
            list.iter().map(in_time).collect::<Vec<_>>()
        };
        let zero = phases.as_ref().map_or(0.0, |p| p.sun_planet[0]);
        let size = estimate(scene);
        let refusal = within_memory(scene).err();
        // Bodies that have a size lack nothing but memory.
        let refusal = refusal.as_ref().map(|why| (why, size.as_ref().ok().map(|_| "--large")));
        Self {
            title: scene.title.clone(),
            kind: word(&scene.kind),
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
            mesh_frequency_hz,
            carrier_speed_rpm: kinematics.as_ref().map(|k| k.speeds_rpm.carrier),
            motion: MotionSummary::new(scene),
            chosen: remarks.chosen.into_iter().map(chosen).collect(),
            rounding: remarks.notes,
            limits: scene.limits(),
            idle: remarks.idle,
            fe_bodies: size.as_ref().ok().map(|found| FeBodiesSummary {
                degrees_of_freedom: found.bodies.iter().map(|b| b.unknowns).sum(),
                memory_mb: 1e-6 * found.peak_bytes as f64,
            }),
            warnings: remarks
                .warnings
                .into_iter()
                .chain(scene::warnings(scene))
                .map(warning)
                .collect(),
            verbs: Verb::ALL.into_iter().map(|verb| needs(scene, verb, refusal)).collect(),
        }
    }
}

fn chosen(chosen: scene::Chosen) -> ChosenSummary {
    let scene::Chosen { key, value, why } = chosen;
    ChosenSummary { key, value, why }
}

fn warning(w: scene::Warning) -> WarningSummary {
    let scene::Warning { key, value, what, likely } = w;
    WarningSummary { key, value, what, likely }
}

/// What a verb lacks; `refusal`: why the finite-element bodies are not made, and the argument with which they are.
fn needs(
    scene: &Scene,
    verb: Verb,
    refusal: Option<(&FeError, Option<&'static str>)>,
) -> VerbSummary {
    let mut lacks = scene.lacks(verb);
    let is_on_bodies = !matches!(verb, Verb::Modes | Verb::Rules | Verb::Compare);
    let is_complete = lacks.iter().all(|lack| lack.argument.is_some());
    if let (true, true, Some((why, argument))) = (is_on_bodies, is_complete, refusal) {
        lacks.push(scene::Lack { key: "fe_contact".into(), why: why.to_string(), argument });
    }
    let is_on_closed_forms =
        matches!(verb, Verb::Modes | Verb::Compare) && scene.has_closed_forms();
    if let (true, true, Err(why)) = (is_on_closed_forms, lacks.is_empty(), ClosedForm::new(scene)) {
        lacks.push(scene::Lack { key: "lumped".into(), why, argument: None });
    }
    let summary = |lack: &scene::Lack| LackSummary {
        key: lack.key.clone(),
        why: lack.why.clone(),
        argument: lack.argument.map(str::to_owned),
    };
    VerbSummary {
        verb: verb.name().to_owned(),
        runs: lacks.iter().all(|lack| lack.argument.is_some()),
        lacks: lacks.iter().map(summary).collect(),
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
        tip_relief: relief(gear),
    })
    .collect()
}

fn meshes(geometry: &Geometry) -> Vec<MeshSummary> {
    let summary = |mesh: &Mesh| MeshSummary {
        mesh: mesh.kind.name().to_owned(),
        pressure_angle_deg: mesh.pressure_angle.to_degrees(),
        operating_module_mm: 1e3 * mesh.operating_module,
        contact_ratio: mesh.contact_ratio,
        backlash_mm: 1e3 * backlash(geometry, mesh.kind),
    };
    [MeshKind::SunPlanet, MeshKind::RingPlanet]
        .into_iter()
        .filter_map(|kind| geometry.mesh(kind).map(summary))
        .collect()
}

/// Backlash, m, without the rounding errors of one that is 0.
fn backlash(geometry: &Geometry, kind: MeshKind) -> f64 {
    let backlash = geometry.backlash(kind).unwrap_or(f64::NAN);
    if backlash.abs() < 1e-12 { 0.0 } else { backlash }
}

fn relief(gear: &Gear) -> Option<ReliefSummary> {
    let relief = gear.tip_relief?;
    let start = roll_length_at(gear.base_radius, relief.start_radius_m);
    let (tip, form) = (gear.tip_roll_length(), gear.form_roll_length().unwrap_or(0.0));
    Some(ReliefSummary {
        shape: word(&relief.shape),
        amount_um: 1e6 * relief.amount_m,
        start_diameter_mm: 2e3 * relief.start_radius_m,
        start_roll_length_mm: 1e3 * start,
        relieved_share: (tip - start) / (tip - form),
    })
}
