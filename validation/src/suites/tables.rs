//! Tables 2 and 3: lumped frequencies as published, and with the geometry of Table 1.

use gearset::Scene;
use lumped::NaturalModes;
use serde::Serialize;

use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::{ModeTable, Reference};

use super::modes_of::{by_type, frequencies, modes_of, type_named};

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    for table in [Table::Two, Table::Three] {
        let (_, modes) = modes_of(&scene(table.as_published())?)?;
        checks.extend(rows(reference, table, &modes)?);
        checks.push(types(reference, table, &modes));
    }
    for table in [Table::Two, Table::Three] {
        checks.extend(geometry_consistent(reference, table)?);
    }
    Ok(checks)
}

/// Which of the two tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Table {
    /// Three planets.
    Two,
    /// Four planets.
    Three,
}

impl Table {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Two, Self::Three];

    /// Number in the paper.
    pub fn number(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }

    /// Number of planets in words.
    pub fn planets(self) -> &'static str {
        match self {
            Self::Two => "three",
            Self::Three => "four",
        }
    }

    /// Its scene with consistent geometry.
    pub fn consistent(self) -> PublishedScene {
        match self {
            Self::Two => PublishedScene::Oh58ThreePlanets,
            Self::Three => PublishedScene::Oh58FourPlanets,
        }
    }

    /// Its lumped scene as published.
    pub fn as_published(self) -> PublishedScene {
        match self {
            Self::Two => PublishedScene::Oh58ThreePlanetsAsPublished,
            Self::Three => PublishedScene::Oh58FourPlanetsAsPublished,
        }
    }

    /// What is printed.
    pub fn printed(self, reference: &Reference) -> &ModeTable {
        match self {
            Self::Two => &reference.parker.table2,
            Self::Three => &reference.parker.table3,
        }
    }
}

/// One check a printed row: the k-th frequency of the row's type.
pub(crate) fn rows(
    reference: &Reference,
    table: Table,
    modes: &NaturalModes,
) -> Result<Vec<Check>, ValidationError> {
    let printed = table.printed(reference);
    let mut seen: Vec<&str> = Vec::new();
    let mut checks = Vec::new();
    for (row, (name, &hz)) in printed.mode_type.iter().zip(&printed.lumped_hz).enumerate() {
        let earlier = seen.iter().filter(|s| *s == name).count();
        seen.push(name);
        let actual = frequencies(modes, type_named(name)).get(earlier).copied();
        let id = format!("table{}.lumped.{}", table.number(), row + 1);
        let title = format!("Table {}, lumped model: {name} mode {}", table.number(), earlier + 1);
        let subject = Subject {
            id: &id,
            title: &title,
            kind: ReferenceKind::Published,
            source: &reference.parker.source,
            unit: "Hz",
        };
        let tolerance = reference.tolerance(&id, hz)?;
        checks.push(Check::number(subject, hz, actual.unwrap_or(f64::NAN), tolerance));
    }
    Ok(checks)
}

/// Types of the lowest modes, in order of frequency, as many as the table has rows.
pub(crate) fn types(reference: &Reference, table: Table, modes: &NaturalModes) -> Check {
    let printed = table.printed(reference);
    let mut expected: Vec<(f64, &str)> = printed
        .lumped_hz
        .iter()
        .copied()
        .zip(printed.mode_type.iter().map(String::as_str))
        .collect();
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected: Vec<&str> = expected.into_iter().map(|(_, name)| name).collect();
    let actual: Vec<&str> =
        modes.groups.iter().take(expected.len()).map(|g| g.mode_type.name()).collect();
    let id = format!("table{}.lumped.types", table.number());
    let title = format!("Table {}, lumped model: types by frequency", table.number());
    let subject = Subject {
        id: &id,
        title: &title,
        kind: ReferenceKind::Published,
        source: &reference.parker.source,
        unit: "",
    };
    Check::equal(subject, expected, actual)
}

/// The same model with the operating angles of Table 1 and spacing that can be assembled.
fn geometry_consistent(reference: &Reference, table: Table) -> Result<Vec<Check>, ValidationError> {
    let (which, expected) = match table {
        Table::Two => {
            (PublishedScene::Oh58ThreePlanets, &reference.parker.recomputed.three_planets)
        }
        Table::Three => {
            (PublishedScene::Oh58FourPlanets, &reference.parker.recomputed.four_planets)
        }
    };
    let set: Scene = scene(which)?;
    let (_, modes) = modes_of(&set)?;
    let mut checks = Vec::new();
    for (mode_type, list) in by_type(expected) {
        let found = frequencies(&modes, mode_type);
        for (i, &hz) in list.iter().enumerate() {
            let name = mode_type.name();
            let id = format!("table{}.geometry_consistent.{name}.{}", table.number(), i + 1);
            let title =
                format!("{} planets, Table 1 geometry: {name} {}", set.planets.count(), i + 1);
            let subject = Subject {
                id: &id,
                title: &title,
                kind: ReferenceKind::OtherCode,
                source: "an independent assembly of the same equations (reference/parker_2000.toml)",
                unit: "Hz",
            };
            let actual = found.get(i).copied().unwrap_or(f64::NAN);
            checks.push(Check::number(subject, hz, actual, reference.tolerance(&id, hz)?));
        }
    }
    Ok(checks)
}
