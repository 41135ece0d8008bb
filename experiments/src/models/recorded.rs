//! Results read from files: what somebody else's program or test rig gave.
//!
//! A folder holds up to three CSV tables with a header, columns in any order, further columns ignored:
//!
//! | file | a row is | columns |
//! |---|---|---|
//! | `modes.csv` | a natural frequency | `scene`, `frequency_hz`, `mode_type` (`rotational`, `translational`, `planet`, `mixed`), `multiplicity` (1 if absent) |
//! | `mesh_cycle.csv` | one quantity at one position | `scene`, `sun_torque_nm`, `position` (0 to 1), `body`, `coordinate`, `value` |
//! | `steady_states.csv` | one harmonic at one speed | `scene`, `sun_torque_nm`, `speed_rpm`, `mesh_frequency_hz`, `body`, `coordinate`, `harmonic`, `amplitude`, `phase_rad`, `sun_turns` (as the torque on the sun if absent) |
//!
//! `scene` is the title in the scene file. Bodies are `sun`, `planet_0`, `sun_mesh_0`, `ring_mesh_0` and so on;
//! coordinates are `x`, `y`, `rotation` and `force` in a mesh cycle, `radial`, `tangential`, `rotation` and `force`
//! in steady states, which are written so by `epicyclic sweep --out`; its further coordinates (`translation`,
//! `share`, `contact_loss`, `lowest_force`, `backside_contact`) may be there. `sun_torque_nm` is the torque on the
//! sun; `sun_turns` is `counter_clockwise` or `clockwise`, relative to the carrier. Units are Hz, N m, rpm, m, rad, N.

use std::path::{Path, PathBuf};

use gearset::Facing;
use lumped::ModeType;
use scene::{LoadCase, Scene, read_text};
use serde::{Deserialize, Serialize};

use crate::mesh_cycle::{MeshCycle, RestState};
use crate::model::{ModalModel, ModelError, SpeedRequest, StaticModel, SteadyStateModel};
use crate::natural_mode::NaturalMode;
use crate::sweep::{Coordinate, Line, Part, SteadyState};

/// Torques are the same if they differ by less than this part.
const SAME_TORQUE: f64 = 1e-6;

/// Longest table that is read, bytes: some million rows.
const MOST_BYTES: u64 = 500_000_000;

/// A frequency occurs at most so often, and a set has at most so many planets: more is a slip of the pen, and
/// would be asked for as memory.
const MOST: usize = 1000;

/// Tables of somebody's results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recorded {
    /// Scene title and mode.
    pub modes: Vec<(String, NaturalMode)>,
    /// Scene title and mesh cycle.
    pub mesh_cycles: Vec<(String, MeshCycle)>,
    /// Scene title and steady state.
    pub steady_states: Vec<(String, SteadyState)>,
}

/// Why tables could not be read.
#[derive(Debug, thiserror::Error)]
pub enum RecordedError {
    /// A file that is not there or no CSV, or a row that does not fit.
    #[error("{}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What the reader said, with the line.
        #[source]
        source: csv::Error,
    },
    /// A value that means nothing.
    #[error("{}: {value:?} in column {column}: allowed is {allowed}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
        /// What stands there.
        value: String,
        /// What may stand there.
        allowed: &'static str,
    },
    /// A folder without any table.
    #[error(
        "{}: none of modes.csv, mesh_cycle.csv and steady_states.csv is there",
        path.display()
    )]
    Empty {
        /// The folder.
        path: PathBuf,
    },
}

/// A question that the tables have no answer to.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("no {what} of the scene `{scene}` at {torque_nm} N·m on the sun is recorded")]
pub struct NotRecorded {
    /// Natural modes, a mesh cycle, steady states.
    pub what: &'static str,
    /// Title of the scene.
    pub scene: String,
    /// Torque on the sun, N m.
    pub torque_nm: f64,
}

#[derive(Serialize, Deserialize)]
struct ModeRow {
    scene: String,
    frequency_hz: f64,
    mode_type: String,
    multiplicity: Option<usize>,
}

#[derive(Serialize, Deserialize)]
struct CycleRow {
    scene: String,
    sun_torque_nm: f64,
    position: f64,
    body: String,
    coordinate: String,
    value: f64,
}

#[derive(Serialize, Deserialize)]
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
    #[serde(default)]
    sun_turns: Option<Facing>,
}

/// The number of a column, if it is finite.
fn finite(path: &Path, column: &'static str, value: f64) -> Result<f64, RecordedError> {
    if value.is_finite() {
        return Ok(value);
    }
    let path = path.to_owned();
    Err(RecordedError::Value { path, column, value: value.to_string(), allowed: "a finite number" })
}

/// The body of that name, of a planet below [`MOST`].
fn part_named(path: &Path, name: &str) -> Result<Part, RecordedError> {
    let part = Part::named(name).filter(|part| part.planet().is_none_or(|n| n < MOST));
    part.ok_or_else(|| RecordedError::Value {
        path: path.to_owned(),
        column: "body",
        value: name.to_owned(),
        allowed: "carrier, ring, sun, planet_0, sun_mesh_0, ring_mesh_0 and so on, up to number 999",
    })
}

/// Rows of one table of a folder; `None` if there is no such file.
fn rows<T: serde::de::DeserializeOwned>(
    folder: &Path,
    name: &str,
) -> Result<Option<(PathBuf, Vec<T>)>, RecordedError> {
    let path = folder.join(name);
    if !path.exists() {
        return Ok(None);
    }
    let failed = |source| RecordedError::Table { path: path.clone(), source };
    let text = read_text(&path, MOST_BYTES).map_err(|e| failed(e.into()))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let list = reader.deserialize().collect::<Result<Vec<T>, csv::Error>>().map_err(failed)?;
    Ok(Some((path, list)))
}

/// Writes one table of a folder, if it has rows.
fn save<T: Serialize>(
    folder: &Path,
    name: &str,
    rows: impl Iterator<Item = T>,
) -> Result<(), RecordedError> {
    let path = folder.join(name);
    let failed = |source| RecordedError::Table { path: path.clone(), source };
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
    /// Reads the tables of a folder.
    ///
    /// # Errors
    /// [`RecordedError`] if there is none, or one cannot be read.
    pub fn read(folder: &Path) -> Result<Self, RecordedError> {
        let mut own = Self::default();
        let modes = rows::<ModeRow>(folder, "modes.csv")?;
        let cycles = rows::<CycleRow>(folder, "mesh_cycle.csv")?;
        let states = rows::<StateRow>(folder, "steady_states.csv")?;
        if modes.is_none() && cycles.is_none() && states.is_none() {
            return Err(RecordedError::Empty { path: folder.to_owned() });
        }
        if let Some((path, list)) = modes {
            for row in list {
                own.take_mode(&path, row)?;
            }
        }
        if let Some((path, mut list)) = cycles {
            list.sort_by(|a, b| a.position.total_cmp(&b.position));
            for row in list {
                own.take_rest(&path, row)?;
            }
        }
        if let Some((path, mut list)) = states {
            list.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
            for row in list {
                own.take_line(&path, row)?;
            }
        }
        Ok(own)
    }

    /// Writes the tables that are not empty, creating the folder if need be.
    ///
    /// # Errors
    /// [`RecordedError::Table`] if a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), RecordedError> {
        let failed =
            |e: std::io::Error| RecordedError::Table { path: folder.to_owned(), source: e.into() };
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
        save(folder, "steady_states.csv", states)
    }

    fn take_mode(&mut self, path: &Path, row: ModeRow) -> Result<(), RecordedError> {
        const TYPES: [ModeType; 4] =
            [ModeType::Rotational, ModeType::Translational, ModeType::Planet, ModeType::Mixed];
        let mode_type = TYPES.into_iter().find(|t| t.name() == row.mode_type);
        let mode_type = mode_type.ok_or_else(|| RecordedError::Value {
            path: path.to_owned(),
            column: "mode_type",
            value: row.mode_type.clone(),
            allowed: "rotational, translational, planet or mixed",
        })?;
        let mode = NaturalMode {
            frequency_hz: finite(path, "frequency_hz", row.frequency_hz)?,
            mode_type,
        };
        let count = row.multiplicity.unwrap_or(1);
        if !(1..=MOST).contains(&count) {
            return Err(RecordedError::Value {
                path: path.to_owned(),
                column: "multiplicity",
                value: count.to_string(),
                allowed: "1 to 1000",
            });
        }
        self.modes.extend(std::iter::repeat_n((row.scene, mode), count));
        Ok(())
    }

    fn take_rest(&mut self, path: &Path, row: CycleRow) -> Result<(), RecordedError> {
        finite(path, "sun_torque_nm", row.sun_torque_nm)?;
        finite(path, "position", row.position)?;
        finite(path, "value", row.value)?;
        let part = part_named(path, &row.body)?;
        let case = LoadCase::standing(row.sun_torque_nm);
        let is_own = |(scene, cycle): &(String, MeshCycle)| {
            *scene == row.scene && cycle.case.sun_torque_nm == row.sun_torque_nm
        };
        let at = match self.mesh_cycles.iter().position(is_own) {
            Some(at) => at,
            None => {
                let cycle = MeshCycle { case, states: Vec::new() };
                self.mesh_cycles.push((row.scene.clone(), cycle));
                self.mesh_cycles.len() - 1
            }
        };
        let states = &mut self.mesh_cycles[at].1.states;
        // Rows come by position, those of several scenes and torques side by side.
        let state = match states.last_mut().filter(|s| s.position == row.position) {
            Some(state) => state,
            None => {
                states.push(RestState { position: row.position, ..RestState::default() });
                let at = states.len() - 1;
                &mut states[at]
            }
        };
        match (part, row.coordinate.as_str()) {
            (Part::SUN, "x") => state.sun[0] = row.value,
            (Part::SUN, "y") => state.sun[1] = row.value,
            (Part::SUN, "rotation") => state.sun[2] = row.value,
            (Part::SunMesh(n), "force") => put(&mut state.sun_mesh_n, n, row.value),
            (Part::RingMesh(n), "force") => put(&mut state.ring_mesh_n, n, row.value),
            // More than is asked for.
            _ => {}
        }
        Ok(())
    }

    fn take_line(&mut self, path: &Path, row: StateRow) -> Result<(), RecordedError> {
        for (column, value) in [
            ("sun_torque_nm", row.sun_torque_nm),
            ("speed_rpm", row.speed_rpm),
            ("mesh_frequency_hz", row.mesh_frequency_hz),
            ("amplitude", row.amplitude),
            ("phase_rad", row.phase_rad),
        ] {
            finite(path, column, value)?;
        }
        let part = part_named(path, &row.body)?;
        let coordinate = Coordinate::named(&row.coordinate);
        let coordinate = coordinate.ok_or_else(|| RecordedError::Value {
            path: path.to_owned(),
            column: "coordinate",
            value: row.coordinate.clone(),
            allowed: "radial, tangential, rotation, translation, force, share, contact_loss, lowest_force or backside_contact",
        })?;
        let line = Line {
            part,
            coordinate,
            harmonic: row.harmonic,
            amplitude: row.amplitude,
            phase_rad: row.phase_rad,
        };
        let mut case = LoadCase::turning(row.sun_torque_nm, row.speed_rpm, row.mesh_frequency_hz);
        case.sun_turns = row.sun_turns.unwrap_or(case.sun_turns);
        let is_own = |(scene, state): &(String, SteadyState)| {
            *scene == row.scene
                && state.case.sun_torque_nm == row.sun_torque_nm
                && state.case.speed_rpm == case.speed_rpm
                && state.case.sun_turns == case.sun_turns
        };
        // The newest first: rows come by speed.
        match self.steady_states.iter_mut().rev().find(|own| is_own(own)) {
            Some((_, state)) => state.lines.push(line),
            None => self.steady_states.push((row.scene, SteadyState { case, lines: vec![line] })),
        }
        Ok(())
    }
}

fn put(list: &mut Vec<f64>, n: usize, value: f64) {
    if list.len() <= n {
        list.resize(n + 1, f64::NAN);
    }
    list[n] = value;
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
        _: usize,
    ) -> Result<MeshCycle, ModelError> {
        let is_own = |(title, cycle): &&(String, MeshCycle)| {
            *title == scene.title && same_torque(&cycle.case, case)
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

#[cfg(test)]
mod tests;
