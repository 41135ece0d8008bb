//! Mesh stiffness over the mesh cycle.

use std::path::Path;

use super::super::absurd::unknown_planets;
use super::super::contradiction::{Contradiction, counted};
use super::super::even::uneven;
use super::super::facts::{Facts, SceneFacts};
use super::super::repeated::Repeated;
use crate::results::rows::StiffnessRow;

/// Largest stiffness of a mesh, N/m: steel teeth of a face width of more than 50 m.
const LARGEST: f64 = 1e12;

/// Fewest different numbers that show a mesh cycle.
const FEWEST: usize = 3;

/// What cannot be true in `mesh_stiffness.csv`; `asked` is the least number of positions.
pub(in crate::results) fn mesh_stiffness(
    path: &Path,
    rows: &[StiffnessRow],
    asked: usize,
    facts: &mut Facts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let mut rows: Vec<&StiffnessRow> = rows.iter().collect();
    rows.sort_by(|a, b| {
        let torque = a.sun_torque_nm.total_cmp(&b.sun_torque_nm);
        let place = a.position.total_cmp(&b.position).then(a.line.cmp(&b.line));
        let mesh = a.part.name().cmp(&b.part.name());
        a.scene.id.cmp(&b.scene.id).then(torque).then(mesh).then(place)
    });
    let is_one_cycle = |a: &&StiffnessRow, b: &&StiffnessRow| {
        a.scene.id == b.scene.id && a.sun_torque_nm == b.sun_torque_nm && a.part == b.part
    };
    for rows in rows.chunk_by(is_one_cycle) {
        let facts = facts.about(&rows[0].scene);
        found.extend(one_cycle(path, rows, asked, &facts));
    }
    found
}

/// The rows of one mesh of a scene under one torque, by position.
fn one_cycle(
    path: &Path,
    rows: &[&StiffnessRow],
    asked: usize,
    facts: &SceneFacts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    found.extend(unknown_planets(path, facts.planets, rows.iter().map(|r| (r.line, r.part))));
    let keyed = rows
        .iter()
        .map(|row| (row.line, row.position.to_bits(), [row.stiffness_n_per_m.to_bits(), 0]));
    let repeated = Repeated::of(keyed).contradictions(
        path,
        &["stiffness_n_per_m"],
        "mesh and position",
        "keep the right row",
    );
    let size = not_positive(path, rows).or_else(|| absurd(path, rows, facts));
    match (repeated.is_empty(), &size) {
        (true, None) => {
            let uneven = too_few(path, rows, asked).or_else(|| uneven(path, &points(rows)));
            found.extend(uneven.or_else(|| two_cycles(path, rows)));
        }
        _ => found.extend(repeated),
    }
    found.extend(size);
    found
}

fn not_positive(path: &Path, rows: &[&StiffnessRow]) -> Option<Contradiction> {
    let wrong: Vec<_> = rows.iter().filter(|row| row.stiffness_n_per_m <= 0.0).collect();
    let (first, last) = (wrong.first()?, wrong.last()?);
    let statement = format!(
        "the stiffness of {} is {} N/m at position {} ({} not above 0)",
        first.part.name(),
        first.stiffness_n_per_m,
        first.position,
        counted(wrong.len(), "row")
    );
    let remedy =
        "give k = F/δ with the load F and the deflection δ both positive where flanks press";
    Some(Contradiction::new(
        path,
        [first.line, last.line],
        &["stiffness_n_per_m"],
        statement,
        remedy,
    ))
}

/// Stiffer than any teeth, or so soft that the load of a planet turns the sun by more than a radian.
fn absurd(path: &Path, rows: &[&StiffnessRow], facts: &SceneFacts) -> Option<Contradiction> {
    let least = facts.sun_base_radius.map_or(0.0, |radius| {
        let force = rows[0].sun_torque_nm.abs() / (facts.planets.max(1) as f64 * radius);
        force / radius
    });
    let is_absurd = |row: &&&StiffnessRow| !(least..=LARGEST).contains(&row.stiffness_n_per_m);
    let wrong: Vec<_> = rows.iter().filter(is_absurd).collect();
    let (first, last) = (wrong.first()?, wrong.last()?);
    let what = match first.stiffness_n_per_m > LARGEST {
        true => "more than 1e12 N/m".to_owned(),
        false => format!(
            "with which the load of one planet at {} N·m deflects the mesh by more than the base radius of the sun",
            first.sun_torque_nm
        ),
    };
    let statement = format!(
        "the stiffness of {} is {:e} N/m, {what} ({} of this size)",
        first.part.name(),
        first.stiffness_n_per_m,
        counted(wrong.len(), "row")
    );
    let remedy = "give N/m, or call the column `stiffness_n_per_um` or `stiffness_n_per_mm`";
    Some(Contradiction::new(
        path,
        [first.line, last.line],
        &["stiffness_n_per_m"],
        statement,
        remedy,
    ))
}

/// Positions with their lines.
fn points(rows: &[&StiffnessRow]) -> Vec<(f64, u64)> {
    rows.iter().map(|row| (row.position, row.line)).collect()
}

fn too_few(path: &Path, rows: &[&StiffnessRow], asked: usize) -> Option<Contradiction> {
    let (first, last) = (rows.first()?, rows.last()?);
    let statement = format!(
        "{} of {} in the mesh cycle of `{}` at {} N·m, {asked} are asked for",
        counted(rows.len(), "position"),
        first.part.name(),
        first.scene.scene.title,
        first.sun_torque_nm
    );
    let remedy =
        "give even positions over one cycle, or their number as `positions` in results.toml";
    let lines = [first.line, last.line];
    (rows.len() < asked).then(|| Contradiction::new(path, lines, &["position"], statement, remedy))
}

/// The second half of the cycle repeats the first to the last digit.
fn two_cycles(path: &Path, rows: &[&StiffnessRow]) -> Option<Contradiction> {
    let (first, second) = rows.split_at(rows.len() / 2);
    let mut numbers: Vec<u64> = first.iter().map(|row| row.stiffness_n_per_m.to_bits()).collect();
    let is_same =
        second.iter().map(|row| row.stiffness_n_per_m.to_bits()).eq(numbers.iter().copied());
    numbers.sort_unstable();
    numbers.dedup();
    if !is_same || numbers.len() < FEWEST {
        return None;
    }
    let (a, b) = (first.first()?, second.first()?);
    let statement = format!(
        "stiffnesses of {} from position {} on are those from position {} on: two mesh cycles?",
        a.part.name(),
        b.position,
        a.position
    );
    let remedy = "give one mesh cycle, which is one base pitch of the sun, as positions 0 to 1";
    Some(Contradiction::new(path, [a.line, b.line], &["stiffness_n_per_m"], statement, remedy))
}
