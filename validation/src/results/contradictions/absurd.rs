//! Numbers that no gear set can have, and planets that it does not have.

use std::path::Path;

use experiments::sweep::{Coordinate, Part};

use super::contradiction::{Columns, Contradiction, counted};
use super::facts::SceneFacts;

/// Largest rotation about the mean motion, rad.
const LARGEST_ROTATION: f64 = 1.0;

/// Largest force of a mesh in parts of the torque over the base radius.
const LARGEST_FORCE: f64 = 1000.0;

/// A number of a row.
pub(super) struct Sized {
    pub(super) line: u64,
    pub(super) part: Part,
    pub(super) coordinate: Coordinate,
    pub(super) value: f64,
    pub(super) sun_torque_nm: f64,
}

/// Numbers beyond every bound, as one contradiction.
pub(super) fn absurd(
    path: &Path,
    column: Columns,
    facts: &SceneFacts,
    rows: &[Sized],
) -> Option<Contradiction> {
    let radius = facts.sun_base_radius?;
    let bound = |row: &Sized| match row.coordinate {
        Coordinate::Radial | Coordinate::Tangential | Coordinate::Translation => {
            Some((radius, "the base radius of the sun"))
        }
        Coordinate::Rotation => Some((LARGEST_ROTATION, "a rotation of one radian")),
        Coordinate::Force | Coordinate::LowestForce if row.sun_torque_nm != 0.0 => {
            let largest = LARGEST_FORCE * row.sun_torque_nm.abs() / radius;
            Some((largest, "a thousand times the torque over the base radius of the sun"))
        }
        Coordinate::Share | Coordinate::ContactLoss | Coordinate::BacksideContact => {
            Some((1.0 + 1e-6, "the whole"))
        }
        _ => None,
    };
    let beyond = |row: &&Sized| bound(row).is_some_and(|(bound, _)| row.value.abs() > bound);
    let found: Vec<&Sized> = rows.iter().filter(beyond).collect();
    let (first, last) = (found.first()?, found.last()?);
    let (_, what) = bound(first)?;
    let statement = format!(
        "{} of {} is {:e} {}, more than {what} ({} of this size)",
        first.coordinate.name(),
        first.part.name(),
        first.value,
        first.coordinate.unit(),
        counted(found.len(), "row"),
    );
    let remedy = "give displacements in m, rotations in rad, forces in N, or the unit in the title of the column";
    Some(Contradiction::new(path, [first.line, last.line], column, statement, remedy))
}

/// Rows of planets that the set does not have.
pub(super) fn unknown_planets(
    path: &Path,
    planets: usize,
    rows: impl Iterator<Item = (u64, Part)>,
) -> Option<Contradiction> {
    let beyond = |(_, part): &(u64, Part)| part.planet().is_some_and(|n| n >= planets);
    let found: Vec<(u64, Part)> = rows.filter(beyond).collect();
    let (first, last) = (found.first()?, found.last()?);
    let statement = format!("`{}` in a set of {}", first.1.name(), counted(planets, "planet"));
    let remedy = format!("number planets from 0 to {}", planets.saturating_sub(1));
    Some(Contradiction::new(path, [first.0, last.0], &["body"], statement, remedy))
}
