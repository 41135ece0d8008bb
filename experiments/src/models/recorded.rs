//! Tables of results as a model: what is in them is what it answers. `validation::results` reads them from a folder,
//! and [`Recorded::write`] writes one, with a table for each field.

use std::path::{Path, PathBuf};

use gearset::{Facing, MeshKind};
use scene::{LoadCase, Scene};
use serde::Serialize;

use crate::mesh_cycle::MeshCycle;
use crate::mesh_stiffness::MeshStiffness;
use crate::model::{
    MeshStiffnessModel, ModalModel, ModelError, SpeedRequest, StaticModel, SteadyStateModel,
    TorquePeakModel,
};
use crate::natural_mode::NaturalMode;
use crate::sweep::{Part, SteadyState};
use crate::torque::TorquePeak;

/// Torques are the same if they differ by less than this part.
const SAME_TORQUE: f64 = 1e-6;

/// Tables of somebody's results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recorded {
    /// Scene title and mode.
    pub modes: Vec<(String, NaturalMode)>,
    /// Scene title and mesh cycle.
    pub mesh_cycles: Vec<(String, MeshCycle)>,
    /// Scene title and steady state.
    pub steady_states: Vec<(String, SteadyState)>,
    /// Scene title and stiffness of a mesh of planet 0.
    pub mesh_stiffness: Vec<(String, MeshStiffness)>,
    /// Scene title and resonant peak.
    pub torque_peaks: Vec<(String, TorquePeak)>,
}

/// A table that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}", path.display())]
pub struct RecordedError {
    /// The file.
    pub path: PathBuf,
    /// What the writer said.
    #[source]
    source: csv::Error,
}

/// A question that the tables have no answer to.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("no {what} of the scene `{scene}` at {torque_nm} N·m on the sun is recorded")]
pub struct NotRecorded {
    /// Natural modes, a mesh cycle, steady states, mesh stiffness, resonant peaks.
    pub what: &'static str,
    /// Title of the scene.
    pub scene: String,
    /// Torque on the sun, N m.
    pub torque_nm: f64,
}

#[derive(Serialize)]
struct ModeRow {
    scene: String,
    frequency_hz: f64,
    mode_type: String,
    multiplicity: Option<usize>,
}

#[derive(Serialize)]
struct CycleRow {
    scene: String,
    sun_torque_nm: f64,
    position: f64,
    body: String,
    coordinate: String,
    value: f64,
}

#[derive(Serialize)]
struct StateRow {
    scene: String,
    sun_torque_nm: f64,
    speed_rpm: f64,
    mesh_frequency_hz: f64,
    body: String,
    coordinate: String,
    harmonic: usize,
    amplitude: f64,
    phase_rad: f64,
    sun_turns: Option<Facing>,
}

#[derive(Serialize)]
struct StiffnessRow {
    scene: String,
    sun_torque_nm: f64,
    body: String,
    position: f64,
    stiffness_n_per_m: f64,
}

#[derive(Serialize)]
struct PeakRow {
    scene: String,
    sun_torque_nm: f64,
    sun_turns: Option<Facing>,
    body: String,
    coordinate: String,
    harmonic: usize,
    frequency_hz: f64,
    amplitude: f64,
}

/// Writes one table of a folder, if it has rows.
fn save<T: Serialize>(
    folder: &Path,
    name: &str,
    rows: impl Iterator<Item = T>,
) -> Result<(), RecordedError> {
    let path = folder.join(name);
    let failed = |source| RecordedError { path: path.clone(), source };
    let mut rows = rows.peekable();
    if rows.peek().is_none() {
        return Ok(());
    }
    let mut writer = csv::Writer::from_path(&path).map_err(failed)?;
    for row in rows {
        writer.serialize(row).map_err(failed)?;
    }
    writer.flush().map_err(|e| failed(e.into()))
}

impl Recorded {
    /// Writes the tables that are not empty, creating the folder if need be.
    ///
    /// # Errors
    /// [`RecordedError`] if a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), RecordedError> {
        let failed =
            |e: std::io::Error| RecordedError { path: folder.to_owned(), source: e.into() };
        std::fs::create_dir_all(folder).map_err(failed)?;
        let modes = self.modes.iter().map(|(scene, mode)| ModeRow {
            scene: scene.clone(),
            frequency_hz: mode.frequency_hz,
            mode_type: mode.mode_type.name().to_owned(),
            multiplicity: Some(1),
        });
        save(folder, "modes.csv", modes)?;
        let cycles = self.mesh_cycles.iter().flat_map(|(scene, cycle)| {
            cycle.states.iter().flat_map(move |state| {
                let row = move |part: Part, coordinate: &str, value: f64| CycleRow {
                    scene: scene.clone(),
                    sun_torque_nm: cycle.case.sun_torque_nm,
                    position: state.position,
                    body: part.name(),
                    coordinate: coordinate.to_owned(),
                    value,
                };
                let axes = ["x", "y", "rotation"].into_iter().zip(state.sun);
                let mut list: Vec<CycleRow> =
                    axes.map(|(axis, value)| row(Part::SUN, axis, value)).collect();
                let force = |part: fn(usize) -> Part, forces: &[f64]| -> Vec<CycleRow> {
                    forces.iter().enumerate().map(|(n, f)| row(part(n), "force", *f)).collect()
                };
                list.extend(force(Part::SunMesh, &state.sun_mesh_n));
                list.extend(force(Part::RingMesh, &state.ring_mesh_n));
                list
            })
        });
        save(folder, "mesh_cycle.csv", cycles)?;
        let states = self.steady_states.iter().flat_map(|(scene, state)| {
            state.lines.iter().map(move |line| StateRow {
                scene: scene.clone(),
                sun_torque_nm: state.case.sun_torque_nm,
                speed_rpm: state.case.speed_rpm,
                mesh_frequency_hz: state.case.mesh_frequency_hz,
                body: line.part.name(),
                coordinate: line.coordinate.name().to_owned(),
                harmonic: line.harmonic,
                amplitude: line.amplitude,
                phase_rad: line.phase_rad,
                sun_turns: Some(state.case.sun_turns),
            })
        });
        save(folder, "steady_states.csv", states)?;
        let stiffness = self.mesh_stiffness.iter().flat_map(|(scene, found)| {
            found.positions.iter().zip(&found.secant_n_per_m).map(move |(position, k)| {
                let mesh = match found.kind {
                    MeshKind::SunPlanet => Part::SunMesh(0),
                    MeshKind::RingPlanet => Part::RingMesh(0),
                };
                StiffnessRow {
                    scene: scene.clone(),
                    sun_torque_nm: found.case.sun_torque_nm,
                    body: mesh.name(),
                    position: *position,
                    stiffness_n_per_m: *k,
                }
            })
        });
        save(folder, "mesh_stiffness.csv", stiffness)?;
        let peaks = self.torque_peaks.iter().map(|(scene, peak)| PeakRow {
            scene: scene.clone(),
            sun_torque_nm: peak.sun_torque_nm,
            sun_turns: peak.sun_turns,
            body: peak.part.name(),
            coordinate: peak.coordinate.name().to_owned(),
            harmonic: peak.harmonic,
            frequency_hz: peak.frequency_hz,
            amplitude: peak.amplitude,
        });
        save(folder, "torque_peaks.csv", peaks)
    }
}

fn same_torque(a: &LoadCase, b: &LoadCase) -> bool {
    (a.sun_torque_nm - b.sun_torque_nm).abs() <= SAME_TORQUE * b.sun_torque_nm.abs()
}

fn missing(what: &'static str, scene: &Scene, case: &LoadCase) -> ModelError {
    let torque_nm = case.sun_torque_nm;
    NotRecorded { what, scene: scene.title.clone(), torque_nm }.into()
}

impl ModalModel for Recorded {
    fn natural_modes(
        &self,
        scene: &Scene,
        case: &LoadCase,
    ) -> Result<Vec<NaturalMode>, ModelError> {
        let own = self.modes.iter().filter(|(title, _)| *title == scene.title);
        let list: Vec<NaturalMode> = own.map(|(_, mode)| *mode).collect();
        if list.is_empty() { Err(missing("natural modes", scene, case)) } else { Ok(list) }
    }
}

impl StaticModel for Recorded {
    fn mesh_cycle(
        &self,
        scene: &Scene,
        case: &LoadCase,
        positions: usize,
    ) -> Result<MeshCycle, ModelError> {
        let is_own = |(title, cycle): &&(String, MeshCycle)| {
            *title == scene.title
                && same_torque(&cycle.case, case)
                && cycle.states.len() >= positions
        };
        let found = self.mesh_cycles.iter().find(is_own);
        found.map(|(_, cycle)| cycle.clone()).ok_or_else(|| missing("mesh cycle", scene, case))
    }
}

impl SteadyStateModel for Recorded {
    fn steady_states(
        &self,
        scene: &Scene,
        case: &LoadCase,
        request: &SpeedRequest<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        let ends = request.speeds_rpm.first().zip(request.speeds_rpm.last());
        let is_own = |(title, state): &&(String, SteadyState)| {
            *title == scene.title
                && same_torque(&state.case, case)
                && state.case.direction() == case.direction()
                && ends.is_some_and(|(low, high)| (*low..=*high).contains(&state.case.speed_rpm))
        };
        let own = self.steady_states.iter().filter(is_own);
        let list: Vec<SteadyState> = own.map(|(_, state)| state.clone()).collect();
        if list.is_empty() { Err(missing("steady states", scene, case)) } else { Ok(list) }
    }
}

impl MeshStiffnessModel for Recorded {
    fn mesh_stiffness(
        &self,
        scene: &Scene,
        case: &LoadCase,
        kind: MeshKind,
        positions: usize,
    ) -> Result<MeshStiffness, ModelError> {
        let is_asked = |(title, found): &&(String, MeshStiffness)| {
            *title == scene.title
                && same_torque(&found.case, case)
                && found.kind == kind
                && found.positions.len() >= positions
        };
        let found = self.mesh_stiffness.iter().find(is_asked);
        found.map(|(_, found)| found.clone()).ok_or_else(|| missing("mesh stiffness", scene, case))
    }
}

impl TorquePeakModel for Recorded {
    fn torque_peaks(&self, scene: &Scene) -> Result<Vec<TorquePeak>, ModelError> {
        let of_scene = self.torque_peaks.iter().filter(|(title, _)| *title == scene.title);
        Ok(of_scene.map(|(_, peak)| *peak).collect())
    }
}
