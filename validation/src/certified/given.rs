//! Somebody's results as rows, and their scores.

use std::collections::HashMap;

use serde::Serialize;

use crate::check::{Check, ReferenceKind, Status, Value};
use crate::model_kind::ModelKind;
use crate::results::{
    CycleRow, GivenMatrix, MatrixKind, ModeRow, PeakRow, ResultsFolder, RuleRow, StateRow,
    StiffnessRow,
};

use super::row::Row;
use super::score::correct_digits;
use super::table::CertifiedValues;

/// Values of a results folder as rows of class C, one after the other, for tables may be large: ids are those of the
/// data set where it has the same value of that kind of model.
pub fn given_rows(folder: &ResultsFolder, kind: ModelKind) -> impl Iterator<Item = Row> + '_ {
    let kind = kind.name();
    let stiffness = move |row: &StiffnessRow| Row {
        sun_torque_nm: Some(row.sun_torque_nm),
        position: Some(row.position),
        ..Row::new(&row.scene.id, kind, "mesh_stiffness", &row.part.name(), row.stiffness_n_per_m)
    };
    let matrices = folder.matrices.iter().flat_map(move |set| {
        set.each().flat_map(move |(which, given)| entries(&set.scene.id, which, given, kind))
    });
    let rows = modes(&folder.modes, kind)
        .into_iter()
        .chain(folder.mesh_cycle.iter().map(move |row| at_rest(row, kind)))
        .chain(folder.steady_states.iter().map(move |row| turning(row, kind)))
        .chain(folder.mesh_stiffness.iter().map(stiffness))
        .chain(peaks(&folder.torque_peaks, kind))
        .chain(matrices)
        .chain(folder.rules.iter().flat_map(excited));
    let program = folder.manifest.program.as_deref().unwrap_or("results");
    let version = folder.manifest.version.as_deref().unwrap_or_default();
    rows.map(move |mut row| {
        row.id = row.name();
        row.routes = program.to_owned();
        row.version = version.to_owned();
        row
    })
}

/// Kinds of modes that a harmonic excites, a row each.
fn excited(rule: &RuleRow) -> [Row; 3] {
    let kinds = rule.excites;
    [
        ("rotational", kinds.rotational),
        ("translational", kinds.translational),
        ("planet", kinds.planet),
    ]
    .map(|(name, is_excited)| {
        let value = f64::from(u8::from(is_excited));
        let row = Row::new(&rule.scene.id, "geometry", "excites", name, value);
        Row { harmonic: Some(rule.harmonic as u32), ..row }
    })
}

/// Rigid-body motion is below this, Hz.
const RIGID_HZ: f64 = 1.0;

/// Frequencies of one type that differ by no more than this part are one that occurs twice.
const SAME: f64 = 1e-6;

/// Modes count upwards within their scene and type; rigid-body motion that the data set has and a list leaves out
/// counts too.
fn modes(listed: &[ModeRow], kind: &str) -> Vec<Row> {
    let mut listed: Vec<&ModeRow> = listed.iter().collect();
    listed.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let mut numbers: HashMap<(&str, Option<&str>), (u32, f64)> = HashMap::new();
    let values = CertifiedValues::shipped();
    let mut rows = Vec::new();
    for mode in listed {
        let key = (mode.scene.id.as_str(), mode.mode_type.as_deref());
        let subject = mode.mode_type.as_deref().unwrap_or_default();
        let row = Row::new(&mode.scene.id, kind, "frequency", subject, mode.frequency_hz);
        let left_out = || {
            let lowest = values.row(&Row { number: Some(1), ..row.clone() }.name());
            let is_rigid = lowest.is_some_and(|lowest| lowest.value < RIGID_HZ);
            (u32::from(is_rigid && mode.frequency_hz >= RIGID_HZ), f64::NAN)
        };
        let (number, last_hz) = numbers.entry(key).or_insert_with(left_out);
        // A frequency that is listed again is that of the same number.
        if (mode.frequency_hz - *last_hz).abs() <= SAME * mode.frequency_hz {
            continue;
        }
        (*number, *last_hz) = (*number + 1, mode.frequency_hz);
        rows.push(Row { number: Some(*number), ..row });
    }
    rows
}

/// Peaks of one quantity, harmonic and torque count upwards in frequency.
fn peaks(listed: &[PeakRow], kind: &str) -> Vec<Row> {
    let mut listed: Vec<&PeakRow> = listed.iter().collect();
    listed.sort_by(|a, b| a.peak.frequency_hz.total_cmp(&b.peak.frequency_hz));
    let mut counts = HashMap::<String, u32>::new();
    let row = |row: &PeakRow| {
        let peak = &row.peak;
        let mut found = Row {
            coordinate: peak.coordinate.name().to_owned(),
            harmonic: Some(peak.harmonic as u32),
            sun_torque_nm: Some(peak.sun_torque_nm),
            unit: peak.coordinate.unit().to_owned(),
            ..Row::new(&row.scene.id, kind, "peak_amplitude", &peak.part.name(), peak.amplitude)
        };
        let count = counts.entry(found.name()).or_default();
        *count += 1;
        found.number = Some(*count);
        found
    };
    listed.into_iter().map(row).collect()
}

/// Entries of a matrix that are not zero, in the convention of its author.
fn entries(scene: &str, which: MatrixKind, given: &GivenMatrix, kind: &str) -> Vec<Row> {
    let quantity = match which {
        MatrixKind::Mass => "mass",
        MatrixKind::Stiffness => "stiffness",
    };
    let (rows, columns) = given.values.shape();
    let places = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let filled = places.filter(|place| given.values[*place] != 0.0);
    filled
        .map(|(i, j)| {
            let subject = format!("row_{} column_{}", i + 1, j + 1);
            Row::new(scene, kind, quantity, &subject, given.values[(i, j)])
        })
        .collect()
}

fn at_rest(row: &CycleRow, kind: &str) -> Row {
    let quantity = match row.coordinate {
        "force" => "mesh_force",
        "rotation" => "rotation",
        _ => "displacement",
    };
    Row {
        coordinate: row.coordinate.to_owned(),
        sun_torque_nm: Some(row.sun_torque_nm),
        position: Some(row.position),
        ..Row::new(&row.scene.id, kind, quantity, &row.part.name(), row.value)
    }
}

fn turning(row: &StateRow, kind: &str) -> Row {
    Row {
        coordinate: row.coordinate.name().to_owned(),
        harmonic: Some(row.harmonic as u32),
        sun_torque_nm: Some(row.sun_torque_nm),
        speed_rpm: Some(row.speed_rpm),
        unit: row.coordinate.unit().to_owned(),
        ..Row::new(&row.scene.id, kind, "amplitude", &row.part.name(), row.amplitude)
    }
}

/// Values that differ by less than this part are one.
const EQUAL: f64 = 1e-9;

/// Correct digits of a judged number: up to what the data set has of its reference as certain, or up to the digits in
/// which a published reference is printed. `None` of words, of bounds and of what another kind of model is shown
/// beside.
pub fn digits_of(check: &Check, kind: ModelKind) -> Option<f64> {
    let (Value::Number(expected), Some(Value::Number(given))) = (&check.expected, &check.actual)
    else {
        return None;
    };
    if !matches!(check.status, Status::Pass | Status::Fail | Status::Miss) || *expected == 0.0 {
        return None;
    }
    let scene = check.id.strip_prefix("lumped_model.").and_then(|id| id.split('.').next());
    let is_reference = |row: &&Row| {
        Some(row.scene.as_str()) == scene
            && row.kind == kind.name()
            && row.quantity == "frequency"
            && (row.value - expected).abs() <= EQUAL * expected.abs()
    };
    let values = CertifiedValues::shipped();
    if let Some(row) = values.rows().find(is_reference) {
        return Some(correct_digits(*given, row.value, row.uncertainty, values.largest(row)));
    }
    let is_printed =
        matches!(check.kind, ReferenceKind::Published | ReferenceKind::HandCalculation);
    let digits = correct_digits(*given, *expected, check.tolerance.absolute, *expected);
    (is_printed && check.tolerance.band.is_none()).then_some(digits)
}

/// How the values of one quantity of a scene agree with the data set.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Score {
    /// Id of the scene.
    pub scene: String,
    /// Name of the quantity.
    pub quantity: String,
    /// The least sure class among the rows.
    pub class: super::Class,
    /// Number of values that the data set has too.
    pub values: usize,
    /// Correct digits of the worst of them.
    pub fewest_digits: f64,
    /// Digits of the middle one.
    pub median_digits: f64,
    /// Id of the worst.
    pub worst: String,
}

/// The row of the data set that a row is held against: that of its id, and of a frequency the nearest of its type, for
/// a list may leave out modes.
fn partner<'v>(given: &Row, values: &'v CertifiedValues) -> Option<&'v Row> {
    if given.quantity != "frequency" {
        return values.row(&given.id);
    }
    let is_like = |row: &&Row| {
        row.quantity == given.quantity
            && row.scene == given.scene
            && row.kind == given.kind
            && (given.subject.is_empty() || row.subject == given.subject)
    };
    let apart = |row: &&Row| (row.value - given.value).abs();
    values.rows().filter(is_like).min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Scores of rows that the data set has too, by scene and quantity.
pub fn scores(given: impl Iterator<Item = Row>) -> Vec<Score> {
    let values = CertifiedValues::shipped();
    let mut groups: Vec<(&Row, Vec<(f64, &Row)>)> = Vec::new();
    for row in given {
        let Some(kept) = partner(&row, values) else { continue };
        let largest = values.largest(kept);
        // Zero by symmetry: nothing but the uncertainty says how near a value must be.
        let is_zero = largest <= kept.uncertainty;
        if is_zero && row.value.abs() <= kept.uncertainty {
            continue;
        }
        let digits = correct_digits(row.value, kept.value, kept.uncertainty, largest);
        let is_same = |(first, _): &&mut (&Row, _)| {
            first.scene == kept.scene && first.quantity == kept.quantity
        };
        match groups.iter_mut().find(is_same) {
            Some((_, list)) => list.push((digits, kept)),
            None => groups.push((kept, vec![(digits, kept)])),
        }
    }
    let score = |(first, mut list): (&Row, Vec<(f64, &Row)>)| {
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        Score {
            scene: first.scene.clone(),
            quantity: first.quantity.clone(),
            class: list.iter().map(|(_, row)| row.class).max().unwrap_or(first.class),
            values: list.len(),
            fewest_digits: list[0].0,
            median_digits: list[list.len() / 2].0,
            worst: list[0].1.id.clone(),
        }
    };
    groups.into_iter().map(score).collect()
}
