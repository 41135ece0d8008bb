//! Natural frequencies.

use std::path::Path;

use super::super::contradiction::Contradiction;
use super::super::facts::{Facts, SceneFacts};
use super::super::frequency_factor::factor;
use crate::model_kind::ModelKind;
use crate::results::rows::ModeRow;

/// Coordinates of a body in the plane.
const COORDINATES: usize = 3;

/// What cannot be true in `modes.csv`.
pub(in crate::results) fn modes(
    path: &Path,
    rows: &[ModeRow],
    kind: Option<ModelKind>,
    facts: &mut Facts,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    for rows in by_scene(rows) {
        let facts = facts.about(&rows[0].scene);
        let twice = listed_twice(path, &rows, kind, &facts);
        if twice.is_none() && matches!(kind, Some(ModelKind::Lumped | ModelKind::Torsional)) {
            found.extend(too_many(path, &rows, &facts));
        }
        found.extend(twice);
        found.extend(off_by_a_factor(path, &rows, &facts));
    }
    found
}

/// Rows of each scene, in the order of the file.
pub(in crate::results) fn by_scene(rows: &[ModeRow]) -> Vec<Vec<&ModeRow>> {
    let mut list: Vec<Vec<&ModeRow>> = Vec::new();
    for row in rows {
        match list.iter_mut().find(|rows| rows[0].scene.id == row.scene.id) {
            Some(rows) => rows.push(row),
            None => list.push(vec![row]),
        }
    }
    list
}

/// Modes more often than their type allows.
fn listed_twice(
    path: &Path,
    rows: &[&ModeRow],
    kind: Option<ModelKind>,
    facts: &SceneFacts,
) -> Option<Contradiction> {
    let most = |mode_type: &str| match mode_type {
        // Planets against one another: N − 1 modes of rotations alone.
        _ if kind == Some(ModelKind::Torsional) => Some(facts.planets.saturating_sub(1).max(1)),
        "rotational" => Some(1),
        "translational" => Some(2),
        "planet" => Some(facts.planets.saturating_sub(3).max(1)),
        _ => None,
    };
    let mut groups: Vec<Vec<&ModeRow>> = Vec::new();
    for row in rows.iter().filter(|row| row.frequency_hz > 0.0) {
        let is_same = |group: &&mut Vec<&ModeRow>| {
            group[0].frequency_hz == row.frequency_hz && group[0].mode_type == row.mode_type
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    let is_beyond = |group: &&Vec<&ModeRow>| {
        let count: usize = group.iter().map(|row| row.times()).sum();
        let mode_type = group[0].mode_type.as_deref().unwrap_or_default();
        group.len() > 1 && most(mode_type).is_some_and(|most| count > most)
    };
    let beyond: Vec<_> = groups.iter().filter(is_beyond).collect();
    // Without types, a list in which every frequency occurs twice is one of two copies of each mode.
    let untyped = rows.iter().all(|row| row.mode_type.is_none());
    let first = match beyond.first() {
        Some(group) => group,
        None if untyped && groups.len() > 1 && groups.iter().all(|g| g.len() % 2 == 0) => {
            groups.first()?
        }
        None => return None,
    };
    let lines = [first[0].line, first[1].line];
    let listed = match groups.iter().all(|group| group.len() > 1) {
        true => "every mode is listed more than once".to_owned(),
        false => format!(
            "a {} mode of {} Hz is listed {} times",
            first[0].mode_type.as_deref().unwrap_or_default(),
            first[0].frequency_hz,
            first.len(),
        ),
    };
    let statement = format!(
        "{listed}, rotational modes are single, translational ones pairs, planet modes N − 3 of a frequency"
    );
    let remedy = "list each mode once; where two are as near as this, give more digits";
    Some(Contradiction::new(path, lines, &["frequency_hz"], statement, remedy))
}

/// More modes than a model of rigid bodies has coordinates.
fn too_many(path: &Path, rows: &[&ModeRow], facts: &SceneFacts) -> Option<Contradiction> {
    let most = COORDINATES * (facts.planets + COORDINATES);
    let count: usize = rows.iter().map(|row| row.times()).sum();
    let statement = format!(
        "{count} modes, and {} planets with carrier, ring and sun have {most} coordinates",
        facts.planets
    );
    let remedy = "leave out what is no mode, or say `kind = \"fe_contact\"` in results.toml";
    let lines = [rows.first()?.line, rows.last()?.line];
    (count > most).then(|| Contradiction::new(path, lines, &["multiplicity"], statement, remedy))
}

/// Frequencies in another unit than the title of the column says.
fn off_by_a_factor(path: &Path, rows: &[&ModeRow], facts: &SceneFacts) -> Option<Contradiction> {
    let moving: Vec<&&ModeRow> = rows.iter().filter(|row| row.frequency_hz > 0.0).collect();
    let mut listed_hz = Vec::new();
    for row in &moving {
        listed_hz
            .extend(std::iter::repeat_n(row.frequency_hz, row.times().min(facts.lumped_hz.len())));
    }
    let (by, guess) = factor(&listed_hz, &facts.lumped_hz)?;
    let count = moving.len();
    let statement = format!(
        "frequencies of `{}` as they stand are not those of the lumped model, all {count} agree after × {by}: {guess}",
        rows[0].scene.scene.title
    );
    let remedy = "give them in Hz, or call the column `frequency_khz` or `omega_rad_per_s`";
    Some(Contradiction::new(
        path,
        [moving[0].line, moving[count - 1].line],
        &["frequency_hz"],
        statement,
        remedy,
    ))
}
