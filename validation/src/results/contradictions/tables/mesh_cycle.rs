//! A mesh cycle at rest.

use std::collections::HashSet;
use std::path::Path;

use experiments::sweep::{Coordinate, Part};

use super::super::absurd::{Sized, absurd, unknown_planets};
use super::super::balance::{Force, TOLERANCE, imbalance};
use super::super::contradiction::{Contradiction, counted};
use super::super::even::uneven;
use super::super::facts::{Facts, SceneFacts};
use super::super::merged::{PlanetRow, merged};
use super::super::repeated::Repeated;
use crate::results::rows::CycleRow;

/// What cannot be true in `mesh_cycle.csv`; `asked` is the least number of positions.
pub(in crate::results) fn mesh_cycle(
    path: &Path,
    rows: &[CycleRow],
    asked: usize,
    facts: &mut Facts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let mut rows: Vec<&CycleRow> = rows.iter().collect();
    rows.sort_by(|a, b| {
        let torque = a.sun_torque_nm.total_cmp(&b.sun_torque_nm);
        let place = a.position.total_cmp(&b.position).then(a.line.cmp(&b.line));
        a.scene.id.cmp(&b.scene.id).then(torque).then(place)
    });
    let same_cycle = |a: &&CycleRow, b: &&CycleRow| {
        a.scene.id == b.scene.id && a.sun_torque_nm == b.sun_torque_nm
    };
    for rows in rows.chunk_by(same_cycle) {
        let facts = facts.about(&rows[0].scene);
        found.extend(one_cycle(path, rows, asked, &facts));
    }
    found
}

/// The rows of one scene under one torque, by position.
fn one_cycle(
    path: &Path,
    rows: &[&CycleRow],
    asked: usize,
    facts: &SceneFacts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    found.extend(unknown_planets(path, facts.planets, rows.iter().map(|r| (r.line, r.part))));
    let key = |row: &&CycleRow| {
        let key = (row.position.to_bits(), row.part, row.coordinate);
        (row.line, key, [row.value.to_bits(), 0])
    };
    let repeated = Repeated::of(rows.iter().map(key));
    found.extend(repeated.contradictions(
        path,
        &["value"],
        "position, body and coordinate",
        "keep the right row",
    ));
    found.extend(positions(path, rows, asked));
    let sized: Vec<Sized> = rows.iter().map(|row| row.sized()).collect();
    let absurd = absurd(path, &["value"], facts, &sized);
    if absurd.is_none() && !repeated.differs() {
        found.extend(unbalanced(path, &without_repeats(rows), facts));
    }
    found.extend(absurd);
    found.extend(against_the_torque(path, rows, facts));
    let of_planets = rows.iter().filter(|row| row.part.planet().is_some());
    let of_planets: Vec<PlanetRow> = of_planets.map(|row| row.of_planet()).collect();
    found.extend(merged(path, &["value"], facts, &of_planets));
    found
}

/// The first row of every position, body and coordinate.
fn without_repeats<'r>(rows: &[&'r CycleRow]) -> Vec<&'r CycleRow> {
    let mut seen = HashSet::new();
    let is_first =
        |row: &&&CycleRow| seen.insert((row.position.to_bits(), row.part, row.coordinate));
    rows.iter().filter(is_first).copied().collect()
}

/// Fewer positions than asked for, or a quantity that is not there at every position.
fn positions<'r>(path: &Path, rows: &[&'r CycleRow], asked: usize) -> Option<Contradiction> {
    let cycle: Vec<&[&'r CycleRow]> = rows.chunk_by(|a, b| a.position == b.position).collect();
    let (first, last) = (rows.first()?, rows.last()?);
    if cycle.len() < asked {
        let statement = format!(
            "{} in the mesh cycle of `{}` at {} N·m, {asked} are asked for",
            counted(cycle.len(), "position"),
            first.scene.scene.title,
            first.sun_torque_nm
        );
        let remedy =
            "give even positions over one cycle, or their number as `positions` in results.toml";
        return Some(Contradiction::new(
            path,
            [first.line, last.line],
            &["position"],
            statement,
            remedy,
        ));
    }
    let points: Vec<(f64, u64)> = cycle.iter().map(|s| (s[0].position, s[0].line)).collect();
    if let Some(uneven) = uneven(path, &points) {
        return Some(uneven);
    }
    let is_there = |state: &[&CycleRow], row: &CycleRow| {
        state.iter().any(|r| r.part == row.part && r.coordinate == row.coordinate)
    };
    let first = cycle.first()?;
    let lacking = |from: &[&'r CycleRow], state: &[&'r CycleRow]| {
        from.iter().find(|row| !is_there(state, row)).map(|row| (*row, state[0]))
    };
    let mut states = cycle.iter();
    let (row, other) =
        states.find_map(|state| lacking(first, state).or_else(|| lacking(state, first)))?;
    let statement = format!(
        "{} of {} is given at position {} and not at {}",
        row.coordinate,
        row.part.name(),
        row.position,
        other.position
    );
    let remedy = "give every quantity at every position";
    Some(Contradiction::new(path, [row.line, other.line], &["position"], statement, remedy))
}

/// A sun that turns against its torque, on average over the cycle.
fn against_the_torque(
    path: &Path,
    rows: &[&CycleRow],
    facts: &SceneFacts,
) -> Option<Contradiction> {
    let is_rotation = |row: &&&CycleRow| row.part == Part::SUN && row.coordinate == "rotation";
    let turns: Vec<&&CycleRow> = rows.iter().filter(is_rotation).collect();
    let (first, last) = (turns.first()?, turns.last()?);
    let mean = turns.iter().map(|row| row.value).sum::<f64>() / turns.len() as f64;
    let statement = format!(
        "the sun turns by {mean:e} rad on average under {} N·m, against its torque",
        first.sun_torque_nm
    );
    let remedy =
        "give torque and rotation counter-clockwise positive, the rotation from the unloaded place";
    let is_against = facts.sun_alone_turns && mean * first.sun_torque_nm < 0.0;
    is_against
        .then(|| Contradiction::new(path, [first.line, last.line], &["value"], statement, remedy))
}

/// The worst imbalance over the cycle.
fn unbalanced(path: &Path, rows: &[&CycleRow], facts: &SceneFacts) -> Option<Contradiction> {
    let state = |rows: &[&CycleRow]| {
        let forces: Vec<Force> = rows
            .iter()
            .filter(|row| row.coordinate == "force")
            .map(|row| (row.line, row.part, row.value))
            .collect();
        let found = imbalance(facts, rows[0].sun_torque_nm, &forces, TOLERANCE)?;
        Some((rows[0].position, found))
    };
    let states = rows.chunk_by(|a, b| a.position == b.position).filter_map(state);
    // The first of equal ones: the last from the end.
    let (position, worst) =
        states.rev().max_by(|(_, a), (_, b)| a.missed_nm().total_cmp(&b.missed_nm()))?;
    Some(worst.contradiction(path, &["value"], &format!("at position {position}")))
}

impl CycleRow {
    fn sized(&self) -> Sized {
        let coordinate = match self.coordinate {
            "rotation" => Coordinate::Rotation,
            "force" => Coordinate::Force,
            _ => Coordinate::Translation,
        };
        Sized {
            line: self.line,
            part: self.part,
            coordinate,
            value: self.value,
            sun_torque_nm: self.sun_torque_nm,
        }
    }

    fn of_planet(&self) -> PlanetRow {
        PlanetRow {
            line: self.line,
            part: self.part,
            about: [self.position.to_bits(), self.sized().coordinate as u64, axis(self.coordinate)],
            numbers: [self.value.to_bits(), 0],
        }
    }
}

/// Tells the two translations apart.
fn axis(coordinate: &str) -> u64 {
    u64::from(coordinate == "y")
}
