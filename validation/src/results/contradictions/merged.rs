//! Two planets with the numbers of one.

use std::collections::HashMap;
use std::path::Path;

use experiments::sweep::Part;

use super::contradiction::{Columns, Contradiction};
use super::facts::SceneFacts;

/// Fewest different numbers that say something about a planet.
const FEWEST: usize = 3;

/// A number of a row about a planet, and in what it differs from other rows of this planet's part.
pub(super) struct PlanetRow {
    pub(super) line: u64,
    pub(super) part: Part,
    /// Everything else that the row is about.
    pub(super) about: [u64; 3],
    /// Bits of the numbers.
    pub(super) numbers: [u64; 2],
}

/// Two planets whose every row agrees to the last bit.
pub(super) fn merged(
    path: &Path,
    columns: Columns,
    facts: &SceneFacts,
    rows: &[PlanetRow],
) -> Option<Contradiction> {
    let of_planet = |n: usize| {
        let own = rows.iter().filter(|row| row.part.planet() == Some(n));
        own.map(|row| ((kind(row.part), row.about), row)).collect::<HashMap<_, _>>()
    };
    let planets: Vec<_> = (0..facts.planets).map(of_planet).collect();
    for (b, of_b) in planets.iter().enumerate() {
        for (a, of_a) in planets.iter().enumerate().take(b) {
            if facts.are_in_phase(a, b) || of_a.len() != of_b.len() {
                continue;
            }
            let same = |(key, row): (&(u8, [u64; 3]), &&PlanetRow)| {
                of_b.get(key).is_some_and(|other| other.numbers == row.numbers)
            };
            let mut numbers: Vec<u64> = of_a.values().map(|row| row.numbers[0]).collect();
            numbers.sort_unstable();
            numbers.dedup();
            if numbers.len() < FEWEST || !of_a.iter().all(same) {
                continue;
            }
            let Some(first) = of_a.values().min_by_key(|row| row.line) else { continue };
            let second = of_b.get(&(kind(first.part), first.about)).map_or(first.line, |r| r.line);
            let statement =
                format!("planets {a} and {b} have the same numbers in all {} rows", of_a.len());
            let remedy = "give every planet the numbers of its own place and phase";
            return Some(Contradiction::new(
                path,
                [first.line, second],
                columns,
                statement,
                remedy,
            ));
        }
    }
    None
}

fn kind(part: Part) -> u8 {
    match part {
        Part::CARRIER | Part::RING | Part::SUN => 0,
        Part::Body(_) => 1,
        Part::SunMesh(_) => 2,
        Part::RingMesh(_) => 3,
    }
}
