//! Steady states over speed.

use std::collections::HashSet;
use std::f64::consts::TAU;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use experiments::sweep::{Coordinate, Part};

use super::super::absurd::{Sized, absurd, unknown_planets};
use super::super::balance::{Force, PARTING_TOLERANCE, TOLERANCE, imbalance};
use super::super::contradiction::{Columns, Contradiction, counted};
use super::super::facts::{Facts, SceneFacts};
use super::super::merged::{PlanetRow, merged};
use super::super::repeated::Repeated;
use crate::results::rows::StateRow;

/// Largest part by which mesh frequency and speed may disagree: a number printed with three digits.
const FREQUENCY_TOLERANCE: f64 = 0.005;

/// Phases of this size are within ±2π as printed with two digits.
const LARGEST_PHASE: f64 = TAU + 0.01;

/// Columns of a harmonic.
const NUMBERS: Columns = &["amplitude", "phase_rad"];

/// What cannot be true in `steady_states.csv`.
pub(in crate::results) fn steady_states(
    path: &Path,
    rows: &[StateRow],
    facts: &mut Facts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let mut rows: Vec<&StateRow> = rows.iter().collect();
    rows.sort_by(|a, b| {
        let torque = a.sun_torque_nm.total_cmp(&b.sun_torque_nm);
        let turns = (a.sun_turns.map(|turns| turns as u8)).cmp(&b.sun_turns.map(|t| t as u8));
        a.scene.id.cmp(&b.scene.id).then(torque).then(turns).then(a.line.cmp(&b.line))
    });
    let same_sweep = |a: &&StateRow, b: &&StateRow| {
        a.scene.id == b.scene.id && a.sun_torque_nm == b.sun_torque_nm && a.sun_turns == b.sun_turns
    };
    for rows in rows.chunk_by(same_sweep) {
        let facts = facts.about(&rows[0].scene);
        found.extend(one_sweep(path, rows, &facts));
    }
    found
}

/// The rows of one scene under one torque in one sense, in the order of the file.
fn one_sweep(path: &Path, rows: &[&StateRow], facts: &SceneFacts) -> Vec<Contradiction> {
    let mut found = Vec::new();
    found.extend(unknown_planets(path, facts.planets, rows.iter().map(|r| (r.line, r.part))));
    let repeated = Repeated::of(rows.iter().map(|row| row.keyed()));
    let one_speed = at_one_speed(path, rows, &repeated);
    let negative = not_positive(path, rows);
    if one_speed.is_none() {
        found.extend(repeated.contradictions(
            path,
            NUMBERS,
            "speed, body, coordinate and harmonic",
            "keep the right row, or tell sweeps apart by a column `chain`",
        ));
    }
    if one_speed.is_none() && negative.is_none() {
        found.extend(speed_against_frequency(path, rows, facts));
    }
    let has_one_speed = one_speed.is_some();
    found.extend(one_speed);
    found.extend(negative);
    found.extend(in_degrees(path, rows));
    let sized: Vec<Sized> = rows.iter().map(|row| row.sized()).collect();
    let absurd = absurd(path, &["amplitude"], facts, &sized);
    if absurd.is_none() && !has_one_speed && !repeated.differs() {
        found.extend(unbalanced(path, rows, facts));
    }
    found.extend(absurd);
    let of_planets = rows.iter().filter(|row| row.part.planet().is_some());
    let of_planets: Vec<PlanetRow> = of_planets.map(|row| row.of_planet()).collect();
    found.extend(merged(path, NUMBERS, facts, &of_planets));
    found
}

/// One speed with results that no single speed can have.
fn at_one_speed(path: &Path, rows: &[&StateRow], repeated: &Repeated) -> Option<Contradiction> {
    let (first, last) = (rows.first()?, rows.last()?);
    if rows.iter().any(|row| row.speed_rpm != first.speed_rpm) {
        return None;
    }
    let frequency = |row: &&&StateRow| row.mesh_frequency_hz != first.mesh_frequency_hz;
    let other = rows.iter().find(frequency);
    if other.is_none() && !repeated.differs() {
        return None;
    }
    let why = match other {
        Some(_) => "with several mesh frequencies",
        None => "with several numbers for one body, coordinate and harmonic",
    };
    let statement = format!("all {} rows are at {} rpm, {why}", rows.len(), first.speed_rpm);
    let lines = [first.line, other.map_or(last.line, |row| row.line)];
    Some(Contradiction::new(
        path,
        lines,
        &["speed_rpm"],
        statement,
        "give every row the speed that it was found at",
    ))
}

fn not_positive(path: &Path, rows: &[&StateRow]) -> Option<Contradiction> {
    let is_wrong = |row: &&&StateRow| row.mesh_frequency_hz <= 0.0 || row.speed_rpm <= 0.0;
    let wrong: Vec<_> = rows.iter().filter(is_wrong).collect();
    let (first, last) = (wrong.first()?, wrong.last()?);
    let (column, what, value, unit): (Columns, _, _, _) = match first.mesh_frequency_hz <= 0.0 {
        true => (&["mesh_frequency_hz"], "mesh frequency", first.mesh_frequency_hz, "Hz"),
        false => (&["speed_rpm"], "speed", first.speed_rpm, "rpm"),
    };
    let statement = format!("the {what} is {value} {unit} ({} so)", counted(wrong.len(), "row"));
    let remedy = "give magnitudes above 0, and the sense of rotation as `sun_turns`";
    Some(Contradiction::new(path, [first.line, last.line], column, statement, remedy))
}

/// f_m against the speed of the driven member.
fn speed_against_frequency(
    path: &Path,
    rows: &[&StateRow],
    facts: &SceneFacts,
) -> Option<Contradiction> {
    let per_rpm = facts.mesh_frequency_per_rpm_hz?;
    let is_wrong = |row: &&&StateRow| {
        let expected = per_rpm * row.speed_rpm;
        (row.mesh_frequency_hz - expected).abs() > FREQUENCY_TOLERANCE * expected
    };
    let wrong: Vec<_> = rows.iter().filter(is_wrong).collect();
    let (first, last) = (wrong.first()?, wrong.last()?);
    let statement = format!(
        "the mesh frequency is {} Hz at {} rpm, the teeth of the scene make it {:.2} Hz ({} so)",
        first.mesh_frequency_hz,
        first.speed_rpm,
        per_rpm * first.speed_rpm,
        counted(wrong.len(), "row"),
    );
    let remedy = "give the speed of the driven member of the scene, and Z_s |n_s − n_c|/60 as mesh frequency";
    let columns = &["mesh_frequency_hz", "speed_rpm"];
    Some(Contradiction::new(path, [first.line, last.line], columns, statement, remedy))
}

fn in_degrees(path: &Path, rows: &[&StateRow]) -> Option<Contradiction> {
    let wrong: Vec<_> = rows.iter().filter(|row| row.phase_rad.abs() > LARGEST_PHASE).collect();
    let (first, last) = (wrong.first()?, wrong.last()?);
    let largest = wrong.iter().map(|row| row.phase_rad.abs()).fold(0.0, f64::max);
    let guess = if largest <= 360.0 { ": degrees?" } else { "" };
    let statement =
        format!("phases beyond ±2π ({}, up to {largest}){guess}", counted(wrong.len(), "row"));
    let remedy = "give them in rad within ±2π, or call the column `phase_deg`";
    let column = &["phase_rad"];
    Some(Contradiction::new(path, [first.line, last.line], column, statement, remedy))
}

/// The worst imbalance of mean forces over the speeds.
///
/// Tables hold the forces of the driving flanks: where backside flanks press too, these carry more than the torque.
fn unbalanced(path: &Path, rows: &[&StateRow], facts: &SceneFacts) -> Option<Contradiction> {
    use Coordinate::{BacksideContact, ContactLoss, Force as MeshForce};
    let is_mean = |row: &&&StateRow| {
        row.harmonic == 0 && matches!(row.coordinate, MeshForce | ContactLoss | BacksideContact)
    };
    let mut means: Vec<&StateRow> = rows.iter().filter(is_mean).copied().collect();
    means.sort_by(|a, b| {
        let speed = a.speed_rpm.total_cmp(&b.speed_rpm);
        speed.then(a.chain.cmp(&b.chain)).then(a.line.cmp(&b.line))
    });
    let mut seen = HashSet::new();
    means.retain(|row| seen.insert(row.keyed().1));
    let state = |rows: &[&StateRow]| {
        let has = |what: Coordinate| rows.iter().any(|r| r.coordinate == what && r.amplitude > 0.0);
        if has(BacksideContact) {
            return None;
        }
        let tolerance = if has(ContactLoss) { PARTING_TOLERANCE } else { TOLERANCE };
        let forces = rows.iter().filter(|row| row.coordinate == MeshForce);
        let force = |row: &&StateRow| (row.line, row.part, row.amplitude * row.phase_rad.cos());
        let forces: Vec<Force> = forces.map(force).collect();
        Some((rows[0].speed_rpm, imbalance(facts, rows[0].sun_torque_nm, &forces, tolerance)?))
    };
    let same_state =
        |a: &&StateRow, b: &&StateRow| a.speed_rpm == b.speed_rpm && a.chain == b.chain;
    // The first of equal ones: the last from the end.
    let states = means.chunk_by(same_state).filter_map(state).rev();
    let (speed, worst) = states.max_by(|(_, a), (_, b)| a.missed_nm().total_cmp(&b.missed_nm()))?;
    Some(worst.contradiction(path, NUMBERS, &format!("on average at {speed} rpm")))
}

/// Sweep, speed, body or mesh, quantity and harmonic of a row.
type Key<'r> = (Option<&'r str>, u64, Part, Coordinate, usize);

impl StateRow {
    /// Line, what the row is about, and bits of its numbers.
    fn keyed(&self) -> (u64, Key<'_>, [u64; 2]) {
        let chain = self.chain.as_deref();
        let key = (chain, self.speed_rpm.to_bits(), self.part, self.coordinate, self.harmonic);
        (self.line, key, [self.amplitude.to_bits(), self.phase_rad.to_bits()])
    }

    fn sized(&self) -> Sized {
        Sized {
            line: self.line,
            part: self.part,
            coordinate: self.coordinate,
            value: self.amplitude,
            sun_torque_nm: self.sun_torque_nm,
        }
    }

    fn of_planet(&self) -> PlanetRow {
        let coordinate = self.coordinate as u64;
        let mut chain = DefaultHasher::new();
        self.chain.hash(&mut chain);
        PlanetRow {
            line: self.line,
            part: self.part,
            about: [
                self.speed_rpm.to_bits(),
                (coordinate << 32) | self.harmonic as u64,
                chain.finish(),
            ],
            numbers: [self.amplitude.to_bits(), self.phase_rad.to_bits()],
        }
    }
}
