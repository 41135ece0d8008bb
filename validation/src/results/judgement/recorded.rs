//! Tables as a model that answers what they hold.

use experiments::models::Recorded;
use experiments::sweep::{Line, Part, SteadyState};
use experiments::{MeshCycle, MeshStiffness, NaturalMode, RestState};
use gearset::MeshKind;
use lumped::ModeType;
use scene::LoadCase;

use crate::results::folder::ResultsFolder;
use crate::results::rows::{CycleRow, ModeRow, StateRow, StiffnessRow};

impl ResultsFolder {
    /// The tables as a model. Of a scene whose modes have no types no modes are there, for suites ask by type.
    pub fn recorded(&self) -> Recorded {
        self.recorded_with(&self.modes)
    }

    /// The same with other modes.
    pub(in crate::results) fn recorded_with(&self, modes: &[ModeRow]) -> Recorded {
        let mut recorded = Recorded::default();
        let untyped = untyped(modes);
        let is_typed = |row: &&ModeRow| !untyped.iter().any(|(id, _)| *id == row.scene.id);
        modes.iter().filter(is_typed).for_each(|row| take_mode(&mut recorded, row));
        let mut rows: Vec<&CycleRow> = self.mesh_cycle.iter().collect();
        rows.sort_by(|a, b| a.position.total_cmp(&b.position));
        rows.into_iter().for_each(|row| take_rest(&mut recorded, row));
        let mut rows: Vec<&StateRow> = self.steady_states.iter().collect();
        rows.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
        rows.into_iter().for_each(|row| take_line(&mut recorded, row));
        let mut rows: Vec<&StiffnessRow> = self.mesh_stiffness.iter().collect();
        rows.sort_by(|a, b| a.position.total_cmp(&b.position));
        rows.into_iter().for_each(|row| take_stiffness(&mut recorded, row));
        let peaks = self.torque_peaks.iter();
        recorded.torque_peaks =
            peaks.map(|row| (row.scene.scene.title.clone(), row.peak)).collect();
        recorded
    }
}

/// Ids of scenes with modes of which some have no type, and the line of the first of these.
pub(super) fn untyped(modes: &[ModeRow]) -> Vec<(&str, u64)> {
    let mut scenes: Vec<(&str, u64)> = Vec::new();
    for row in modes.iter().filter(|row| mode_type(row).is_none()) {
        if !scenes.iter().any(|(id, _)| *id == row.scene.id) {
            scenes.push((row.scene.id.as_str(), row.line));
        }
    }
    scenes
}

fn mode_type(row: &ModeRow) -> Option<ModeType> {
    let name = row.mode_type.as_deref()?;
    ModeType::ALL.into_iter().find(|known| known.name() == name)
}

fn take_mode(recorded: &mut Recorded, row: &ModeRow) {
    let Some(mode_type) = mode_type(row) else { return };
    let mode = NaturalMode { frequency_hz: row.frequency_hz, mode_type };
    let modes = std::iter::repeat_n((row.scene.scene.title.clone(), mode), row.times());
    recorded.modes.extend(modes);
}

fn take_rest(recorded: &mut Recorded, row: &CycleRow) {
    let title = &row.scene.scene.title;
    let is_same = |(scene, cycle): &(String, MeshCycle)| {
        scene == title && cycle.case.sun_torque_nm == row.sun_torque_nm
    };
    let cycles = &mut recorded.mesh_cycles;
    let at = cycles.iter().position(is_same).unwrap_or_else(|| {
        let case = LoadCase::standing(row.sun_torque_nm);
        cycles.push((title.clone(), MeshCycle { case, states: Vec::new() }));
        cycles.len() - 1
    });
    let states = &mut cycles[at].1.states;
    // Rows come by position, those of several scenes and torques side by side.
    if states.last().is_none_or(|state| state.position != row.position) {
        states.push(RestState { position: row.position, ..RestState::default() });
    }
    let Some(state) = states.last_mut() else { return };
    match (row.part, row.coordinate) {
        (Part::SUN, "x") => state.sun[0] = row.value,
        (Part::SUN, "y") => state.sun[1] = row.value,
        (Part::SUN, "rotation") => state.sun[2] = row.value,
        (Part::SunMesh(n), "force") => put(&mut state.sun_mesh_n, n, row.value),
        (Part::RingMesh(n), "force") => put(&mut state.ring_mesh_n, n, row.value),
        // More than is asked for.
        _ => {}
    }
}

/// Meshes of planet 0 alone are asked for.
fn take_stiffness(recorded: &mut Recorded, row: &StiffnessRow) {
    let kind = match row.part {
        Part::SunMesh(0) => MeshKind::SunPlanet,
        Part::RingMesh(0) => MeshKind::RingPlanet,
        _ => return,
    };
    let title = &row.scene.scene.title;
    let is_same = |(scene, found): &(String, MeshStiffness)| {
        scene == title && found.case.sun_torque_nm == row.sun_torque_nm && found.kind == kind
    };
    let list = &mut recorded.mesh_stiffness;
    let at = list.iter().position(is_same).unwrap_or_else(|| {
        let case = LoadCase::standing(row.sun_torque_nm);
        let (positions, secant_n_per_m) = (Vec::new(), Vec::new());
        list.push((title.clone(), MeshStiffness { case, kind, positions, secant_n_per_m }));
        list.len() - 1
    });
    list[at].1.positions.push(row.position);
    list[at].1.secant_n_per_m.push(row.stiffness_n_per_m);
}

fn take_line(recorded: &mut Recorded, row: &StateRow) {
    let line = Line {
        part: row.part,
        coordinate: row.coordinate,
        harmonic: row.harmonic,
        amplitude: row.amplitude,
        phase_rad: row.phase_rad,
    };
    let mut case = LoadCase::turning(row.sun_torque_nm, row.speed_rpm, row.mesh_frequency_hz);
    case.sun_turns = row.sun_turns.unwrap_or(case.sun_turns);
    let title = &row.scene.scene.title;
    let is_same = |(scene, state): &&mut (String, SteadyState)| {
        scene == title
            && state.case.sun_torque_nm == case.sun_torque_nm
            && state.case.speed_rpm == case.speed_rpm
            && state.case.sun_turns == case.sun_turns
    };
    // The newest first: rows come by speed.
    match recorded.steady_states.iter_mut().rev().find(is_same) {
        Some((_, state)) => state.lines.push(line),
        None => {
            recorded.steady_states.push((title.clone(), SteadyState { case, lines: vec![line] }))
        }
    }
}

/// Sets the number of planet n, and what is between it and the last to no number.
fn put(list: &mut Vec<f64>, n: usize, value: f64) {
    if list.len() <= n {
        list.resize(n + 1, f64::NAN);
    }
    list[n] = value;
}
