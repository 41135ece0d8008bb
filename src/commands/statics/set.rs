//! `static` of a whole set.

use std::io::Write;

use experiments::auto::Choice;
use fe_contact::statics::{Imperfections, MeshState, SetCycle, SetState, StaticSet};
use gearset::{Member, MemberTorques};
use scene::{LoadCase, Scene};
use schemars::JsonSchema;
use serde::Serialize;

use super::pair_load::PairLoad;
use super::solver::solver;
use crate::arguments::Static;
use crate::commands::auto_choice;
use crate::error::{Result, fe_refused, unfit};
#[cfg(feature = "charts")]
use crate::figures;
use crate::inputs::{Working, bodies};
use crate::output::{self, Notation, Report, Table};

/// `static --format json` of a whole set. Displacements in the carrier frame, counter-clockwise.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SetOutput {
    /// One entry for each torque; none where `auto` chose the lumped model, which has no positions.
    torques: Vec<TorqueOutput>,
    /// With `fidelity = "auto"`: the settings chosen, why, and the transmission error with its estimated error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    auto: Option<Choice>,
    #[serde(skip)]
    title: String,
}

/// One mesh cycle under one torque.
#[derive(Debug, Serialize, JsonSchema)]
struct TorqueOutput {
    /// On the sun.
    sun_torque_nm: f64,
    /// Shift of the phase of planet 0's sun mesh by windup; positions count from where this mesh starts its
    /// path of contact under load.
    loaded_phase_shift_cycles: f64,
    /// Root mean square about the mean over the cycle.
    sun_rotation_rms_urad: f64,
    /// Root mean square of |(x, y) − mean| over the cycle.
    sun_translation_rms_um: f64,
    /// External torques on the central members, means over the mesh cycle, counter-clockwise: one of them acts, the
    /// supports of the others react.
    member_torques_nm: MemberTorques,
    /// Member that the torque acts on: the one that turns without support.
    torque_acts_on: &'static str,
    /// r_b · rotation of that member (of a carrier: the base radii of sun and ring times its rotation).
    transmission_error_mean_um: f64,
    transmission_error_peak_to_peak_um: f64,
    /// Part of the mesh cycle in which backside flanks of any mesh press.
    backside_contact: f64,
    /// All 2N meshes: sun meshes, then ring meshes.
    meshes: Vec<MeshSummary>,
    /// Evenly spaced positions from 0, where planet 0's sun mesh is at phase 0.
    positions: Vec<SetPosition>,
    work: Work,
    /// Whether what the linearisation leaves is worth a warning.
    #[serde(skip)]
    is_beyond_linear: bool,
}

/// One mesh over the cycle.
#[derive(Debug, Serialize, JsonSchema)]
struct MeshSummary {
    mesh: String,
    planet: usize,
    mean_force_n: f64,
    least_force_n: f64,
    largest_force_n: f64,
    /// Mean of F over rigid approach along the line of action.
    mean_secant_stiffness_n_per_m: f64,
    mean_tangent_stiffness_n_per_m: f64,
}

/// One position.
#[derive(Debug, Serialize, JsonSchema)]
struct SetPosition {
    position: f64,
    sun: Displacement,
    carrier: Displacement,
    ring: Displacement,
    /// x radial, y tangential.
    planets: Vec<Displacement>,
    meshes: Vec<MeshPosition>,
    /// Meshes whose backside flanks touch; phases count in the mirrored mesh.
    backside_flanks: Vec<MeshPosition>,
}

/// Displacement of a race.
#[derive(Debug, Serialize, JsonSchema)]
struct Displacement {
    x_um: f64,
    y_um: f64,
    rotation_urad: f64,
}

/// One mesh at one position.
#[derive(Debug, Serialize, JsonSchema)]
struct MeshPosition {
    mesh: String,
    planet: usize,
    phase: f64,
    force_n: f64,
    approach_um: f64,
    tangent_stiffness_n_per_m: f64,
    pairs: Vec<PairLoad>,
}

/// Iterations and residuals of the result.
#[derive(Debug, Serialize, JsonSchema)]
struct Work {
    equilibrium_iterations: usize,
    /// Factorisations or pivots of the contact solver.
    contact_iterations: usize,
    /// Largest imbalance of force or moment on any race, over the load.
    worst_residual: f64,
    /// Largest error that the linearisation about the mean loaded configuration leaves in the approach of a
    /// tooth pair, µm.
    kinematic_rest_um: f64,
    /// The same over the transmission error's peak-to-peak value.
    kinematic_rest_share: Option<f64>,
}

pub(super) fn run(
    arguments: &Static,
    scene: &Scene,
    torques: &[f64],
    auto: Option<Choice>,
    out: &mut dyn Write,
) -> Result<()> {
    let path = &arguments.scene;
    let working = Working::new("meshing the bodies and solving the positions");
    let bodies = bodies(path, scene, arguments.large)?;
    let solver = solver(arguments.solver);
    let mut cycles = Vec::new();
    for torque in torques {
        let load = LoadCase::standing(*torque);
        let set = StaticSet::new(scene, &bodies, load.sense(), Imperfections::default())
            .map_err(fe_refused(path))?;
        let chosen = auto.as_ref().and_then(|choice| choice.settings.positions);
        let positions = chosen.map_or(arguments.position_count(), |n| n as usize);
        cycles.push(set.cycle(load.sun_load_nm(), positions, solver).map_err(fe_refused(path))?);
    }
    drop(working);
    let radius = bodies.geometry.sun.as_ref().map(|sun| sun.base_radius);
    let radius = radius.ok_or_else(|| unfit(path, "`geometry.sun` is absent"))?;
    let loaded = scene.loaded_member().map_err(|e| unfit(path, e))?;
    let saved: Result<()> = Ok(());
    #[cfg(feature = "charts")]
    let saved = arguments.figures.as_ref().map_or(saved, |folder| {
        Ok(figures::save(&figures::of_set_cycles(&scene.title, &cycles, radius), folder)?)
    });
    let torques = cycles.iter().map(|c| describe(c, (radius, loaded))).collect();
    let result = SetOutput { torques, auto, title: scene.title.clone() };
    // What was computed is shown also where its figures cannot be saved.
    saved.and(output::show(arguments.format, &result, out))
}

impl SetOutput {
    /// The answer of the lumped model, which has no positions to show.
    pub(super) fn of_lumped(scene: &Scene, choice: Choice) -> Self {
        Self { torques: Vec::new(), auto: Some(choice), title: scene.title.clone() }
    }
}

fn describe(cycle: &SetCycle, (radius, loaded): (f64, Member)) -> TorqueOutput {
    let (rotation, translation) = cycle.sun_rms();
    let error = cycle.transmission_error(radius);
    let summary = |(i, m): (usize, &MeshState)| {
        let force = cycle.mesh_force(i);
        MeshSummary {
            mesh: m.kind.name().into(),
            planet: m.planet,
            mean_force_n: force.mean,
            least_force_n: force.least,
            largest_force_n: force.largest,
            mean_secant_stiffness_n_per_m: cycle.mesh_secant_stiffness(i).mean,
            mean_tangent_stiffness_n_per_m: cycle.mesh_tangent_stiffness(i).mean,
        }
    };
    let displacement = |[x, y, theta]: [f64; 3]| Displacement {
        x_um: x * 1e6,
        y_um: y * 1e6,
        rotation_urad: theta * 1e6,
    };
    let mesh = |m: &MeshState| MeshPosition {
        mesh: m.kind.name().into(),
        planet: m.planet,
        phase: m.phase,
        force_n: m.force,
        approach_um: m.approach * 1e6,
        tangent_stiffness_n_per_m: m.tangent,
        pairs: m.pairs.iter().map(PairLoad::of).collect(),
    };
    let position = |s: &SetState| SetPosition {
        position: s.position,
        carrier: displacement(s.central[0]),
        ring: displacement(s.central[1]),
        sun: displacement(s.central[2]),
        planets: s.planets.iter().map(|p| displacement(*p)).collect(),
        meshes: s.meshes.iter().map(mesh).collect(),
        backside_flanks: s.backside.iter().filter(|m| m.force > 0.0).map(mesh).collect(),
    };
    let of_gears = |of: fn(&SetState) -> f64| -cycle.range(of).mean;
    let ring = of_gears(|s| s.reactions.ring_nm);
    let carrier = of_gears(|s| s.reactions.carrier_nm);
    let rest = cycle.kinematic_rest(radius);
    let (equilibrium_iterations, contact_iterations) = cycle.iterations();
    TorqueOutput {
        sun_torque_nm: cycle.torque_nm,
        loaded_phase_shift_cycles: cycle.lead,
        sun_rotation_rms_urad: rotation * 1e6,
        sun_translation_rms_um: translation * 1e6,
        // In equilibrium they sum to nothing.
        member_torques_nm: MemberTorques { sun: -(ring + carrier), ring, carrier },
        torque_acts_on: loaded.name(),
        transmission_error_mean_um: error.mean * 1e6,
        transmission_error_peak_to_peak_um: error.peak_to_peak() * 1e6,
        backside_contact: cycle.backside_contact(),
        meshes: cycle.states[0].meshes.iter().enumerate().map(summary).collect(),
        positions: cycle.states.iter().map(position).collect(),
        work: Work {
            equilibrium_iterations,
            contact_iterations,
            worst_residual: cycle.worst_residual(),
            kinematic_rest_um: 1e6 * rest.largest,
            kinematic_rest_share: rest.share,
        },
        is_beyond_linear: rest.is_worth_a_warning(),
    }
}

/// A tooth pair of a mesh at a position under a torque.
type Row<'r> = (&'r TorqueOutput, &'r SetPosition, &'r MeshPosition, &'r PairLoad);

fn pairs<'r>() -> Table<'r, Row<'r>> {
    Table::<Row<'r>>::new()
        .column("sun_torque_nm", "", |(torque, ..)| torque.sun_torque_nm)
        .column("position", "", |(_, position, ..)| position.position)
        .column("mesh", "", |(_, _, mesh, _)| &mesh.mesh)
        .column("planet", "", |(_, _, mesh, _)| mesh.planet)
        .column("phase", "", |(_, _, mesh, _)| mesh.phase)
        .column("mesh_force_n", "", |(_, _, mesh, _)| mesh.force_n)
        .column("pair", "", |(.., load)| load.index)
        .column("force_n", "", |(.., load)| load.force_n)
        .column("peak_pressure_pa", "", |(.., load)| load.peak_pressure_pa)
        .column("sun_x_um", "", |(_, position, ..)| position.sun.x_um)
        .column("sun_y_um", "", |(_, position, ..)| position.sun.y_um)
        .column("sun_rotation_urad", "", |(_, position, ..)| position.sun.rotation_urad)
}

fn meshes<'r>() -> Table<'r, &'r MeshSummary> {
    use Notation::{Fixed, Plain};
    Table::<&MeshSummary>::new()
        .words("mesh", Plain, |m| &m.mesh)
        .key()
        .words("planet", Plain, |m| m.planet)
        .key()
        .words("mean N", Fixed(1), |m| m.mean_force_n)
        .words("least N", Fixed(1), |m| m.least_force_n)
        .words("largest N", Fixed(1), |m| m.largest_force_n)
        .words("secant 1e6 N/m", Fixed(1), |m| 1e-6 * m.mean_secant_stiffness_n_per_m)
        .words("tangent 1e6 N/m", Fixed(1), |m| 1e-6 * m.mean_tangent_stiffness_n_per_m)
}

/// Motion of the sun under several torques, beside that under the first.
fn torques<'r>(first: &'r TorqueOutput) -> Table<'r, &'r TorqueOutput> {
    use Notation::{Fixed, Plain};
    // A cycle of one position and a sun that stays put have no ratio.
    let over = |value: f64, first: f64| (first > 0.0).then_some(value / first);
    Table::<&TorqueOutput>::new()
        .words("torque N·m", Plain, |t| t.sun_torque_nm)
        .words("rotation µrad", Fixed(4), |t| t.sun_rotation_rms_urad)
        .words("translation µm", Fixed(4), |t| t.sun_translation_rms_um)
        .words("rotation ÷ first", Fixed(3), move |t| {
            over(t.sun_rotation_rms_urad, first.sun_rotation_rms_urad)
        })
        .words("translation ÷ first", Fixed(3), move |t| {
            over(t.sun_translation_rms_um, first.sun_translation_rms_um)
        })
}

impl Report for SetOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let rows = self.torques.iter().flat_map(|torque| {
            let meshes = torque.positions.iter().flat_map(|p| p.meshes.iter().map(move |m| (p, m)));
            meshes.flat_map(move |(p, m)| m.pairs.iter().map(move |load| (torque, p, m, load)))
        });
        pairs().csv(rows, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}", self.title)?;
        if let Some(choice) = &self.auto {
            auto_choice::write(choice, out)?;
        }
        for torque in &self.torques {
            torque.text(out)?;
        }
        match self.torques.as_slice() {
            [first, _, ..] => Ok(torques(first).text(&self.torques, out)?),
            _ => Ok(()),
        }
    }
}

impl TorqueOutput {
    fn text(&self, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(
            out,
            "{} N·m on the sun, {} positions of the mesh cycle",
            self.sun_torque_nm,
            self.positions.len()
        )?;
        meshes().text(&self.meshes, out)?;
        writeln!(
            out,
            "torques, mean: sun {:.1}, ring {:.1}, carrier {:.1} N·m; it acts on the {}, the supports of the others react",
            self.member_torques_nm.sun,
            self.member_torques_nm.ring,
            self.member_torques_nm.carrier,
            self.torque_acts_on
        )?;
        writeln!(
            out,
            "transmission error r_b θ of the {}: mean {:.3} µm, peak to peak {:.4} µm",
            self.torque_acts_on,
            self.transmission_error_mean_um,
            self.transmission_error_peak_to_peak_um
        )?;
        writeln!(
            out,
            "sun about its mean: rotation {:.4} µrad RMS, translation {:.4} µm RMS",
            self.sun_rotation_rms_urad, self.sun_translation_rms_um
        )?;
        if self.backside_contact > 0.0 {
            let percent = 100.0 * self.backside_contact;
            writeln!(out, "backside flanks press in {percent:.1} % of the mesh cycle")?;
        } else {
            writeln!(out, "no backside flank presses")?;
        }
        writeln!(
            out,
            "windup moves the sun mesh of planet 0 by {:.4} mesh cycles, from which positions count; linear kinematics about the mean leave {:.1e} µm",
            self.loaded_phase_shift_cycles, self.work.kinematic_rest_um
        )?;
        if self.is_beyond_linear {
            let share = self.work.kinematic_rest_share;
            let of_what = share.map_or("large".into(), |share| {
                format!("{:.1} % of the transmission error", 100.0 * share)
            });
            writeln!(
                out,
                "Warning: that is {of_what}; stiffer bearings or a smaller torque keep it small."
            )?;
        }
        let Work { equilibrium_iterations, contact_iterations, worst_residual, .. } = self.work;
        writeln!(
            out,
            "{equilibrium_iterations} equilibrium and {contact_iterations} contact iterations, imbalance {worst_residual:.0e} of the load"
        )
    }
}
