//! Resonant peaks over torque.

use std::path::Path;

use super::super::absurd::{Sized, absurd, unknown_planets};
use super::super::contradiction::{Columns, Contradiction, counted};
use super::super::facts::{Facts, SceneFacts};
use super::super::merged::{PlanetRow, merged};
use super::super::repeated::Repeated;
use crate::results::rows::PeakRow;

/// What cannot be true in `torque_peaks.csv`.
pub(in crate::results) fn torque_peaks(
    path: &Path,
    rows: &[PeakRow],
    facts: &mut Facts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let mut rows: Vec<&PeakRow> = rows.iter().collect();
    rows.sort_by(|a, b| a.scene.id.cmp(&b.scene.id).then(a.line.cmp(&b.line)));
    for rows in rows.chunk_by(|a, b| a.scene.id == b.scene.id) {
        let facts = facts.about(&rows[0].scene);
        found.extend(one_scene(path, rows, &facts));
    }
    found
}

/// The rows of one scene, in the order of the file.
fn one_scene(path: &Path, rows: &[&PeakRow], facts: &SceneFacts) -> Vec<Contradiction> {
    let mut found = Vec::new();
    let parts = rows.iter().map(|row| (row.line, row.peak.part));
    found.extend(unknown_planets(path, facts.planets, parts));
    let keyed = rows.iter().map(|row| {
        let peak = &row.peak;
        let turns = peak.sun_turns.map(|turns| turns as u8);
        let state = (peak.sun_torque_nm.to_bits(), turns, peak.frequency_hz.to_bits());
        (
            row.line,
            (state, peak.part, peak.coordinate, peak.harmonic),
            [peak.amplitude.to_bits(), 0],
        )
    });
    let key = "torque, body, coordinate, harmonic and frequency";
    found.extend(Repeated::of(keyed).contradictions(
        path,
        &["amplitude"],
        key,
        "keep the right row",
    ));
    found.extend(not_positive(path, rows));
    let sized: Vec<Sized> = rows.iter().map(|row| row.sized()).collect();
    found.extend(absurd(path, &["amplitude"], facts, &sized));
    let of_planets = rows.iter().filter(|row| row.peak.part.planet().is_some());
    let of_planets: Vec<PlanetRow> = of_planets.map(|row| row.of_planet()).collect();
    found.extend(merged(path, &["amplitude"], facts, &of_planets));
    found
}

fn not_positive(path: &Path, rows: &[&PeakRow]) -> Option<Contradiction> {
    let is_wrong = |row: &&&PeakRow| row.peak.frequency_hz <= 0.0 || row.peak.amplitude <= 0.0;
    let wrong: Vec<_> = rows.iter().filter(is_wrong).collect();
    let (first, last) = (wrong.first()?, wrong.last()?);
    let (column, what, value, unit): (Columns, _, _, _) = match first.peak.frequency_hz <= 0.0 {
        true => (&["frequency_hz"], "frequency", first.peak.frequency_hz, "Hz"),
        false => (&["amplitude"], "amplitude", first.peak.amplitude, first.peak.coordinate.unit()),
    };
    let statement = format!(
        "the {what} of a peak is {value} {unit} ({} not above 0)",
        counted(wrong.len(), "row")
    );
    let remedy = "give magnitudes above 0, and leave out peaks that are not there";
    Some(Contradiction::new(path, [first.line, last.line], column, statement, remedy))
}

impl PeakRow {
    fn sized(&self) -> Sized {
        Sized {
            line: self.line,
            part: self.peak.part,
            coordinate: self.peak.coordinate,
            value: self.peak.amplitude,
            sun_torque_nm: self.peak.sun_torque_nm,
        }
    }

    fn of_planet(&self) -> PlanetRow {
        let peak = &self.peak;
        PlanetRow {
            line: self.line,
            part: peak.part,
            about: [
                peak.sun_torque_nm.to_bits(),
                ((peak.coordinate as u64) << 32) | peak.harmonic as u64,
                peak.frequency_hz.to_bits() ^ peak.sun_turns.map_or(2, |turns| turns as u64),
            ],
            numbers: [peak.amplitude.to_bits(), 0],
        }
    }
}
