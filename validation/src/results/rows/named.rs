//! What rows are about: a scene, a body or mesh, a quantity.

use std::collections::HashMap;
use std::sync::Arc;

use experiments::sweep::{Coordinate, Part};
use gearset::Facing;

use super::MOST;
use crate::results::known_scenes::{KnownScene, KnownScenes};
use crate::results::table::{Dimension, Row, Table, TableError};

/// Scenes of one table by the names that it calls them by.
pub(crate) struct SceneNames<'k> {
    known: &'k KnownScenes,
    /// Name of the scene where a row has none.
    standard: Option<&'k str>,
    found: HashMap<String, Arc<KnownScene>>,
}

impl<'k> SceneNames<'k> {
    /// Of a table whose rows are about the scene `standard` unless they name one.
    pub(crate) fn new(known: &'k KnownScenes, standard: Option<&'k str>) -> Self {
        Self { known, standard, found: HashMap::new() }
    }

    /// The scene of a row.
    pub(super) fn scene(
        &mut self,
        table: &Table,
        row: &Row,
    ) -> Result<Arc<KnownScene>, TableError> {
        let Some(name) = table.text(row, "scene").or(self.standard) else {
            let allowed = "an id, file or title of a scene, here or as `scene` in results.toml";
            return Err(table.refusal(row, "scene", "", allowed));
        };
        if let Some(scene) = self.found.get(name) {
            return Ok(scene.clone());
        }
        let found = self.known.find(name);
        let scene = found.map_err(|e| table.refusal(row, "scene", name, &e.to_string()))?;
        self.found.insert(name.to_owned(), scene.clone());
        Ok(scene)
    }
}

/// The body or mesh of a row.
pub(super) fn part(table: &Table, row: &Row) -> Result<Part, TableError> {
    let name = table.text(row, "body").unwrap_or_default();
    let part = Part::named(&name.to_lowercase());
    part.filter(|part| part.planet().is_none_or(|n| n < MOST)).ok_or_else(|| {
        let allowed = "carrier, ring, sun, planet_0, sun_mesh_0, ring_mesh_0 and so on, up to 999";
        table.refusal(row, "body", name, allowed)
    })
}

/// Positions are told apart to one part in so many of a cycle.
const PLACES: f64 = 1e7;

/// The position of a row in the mesh cycle, 0 to 1.
pub(super) fn cycle_position(table: &Table, row: &Row) -> Result<f64, TableError> {
    let position = table.number(row, "position").unwrap_or_default();
    match (0.0..=1.0).contains(&position) {
        // Rows of one position need not agree in their last digits.
        true => Ok((position * PLACES).round() / PLACES),
        false => {
            let allowed = "a part of the mesh cycle, 0 to 1";
            Err(table.refusal(row, "position", &position.to_string(), allowed))
        }
    }
}

/// The sense in which the sun turns, where the row says so.
pub(super) fn sun_turns(table: &Table, row: &Row) -> Option<Facing> {
    table.text(row, "sun_turns").map(|word| match word {
        "clockwise" => Facing::Clockwise,
        _ => Facing::CounterClockwise,
    })
}

/// Refuses a unit in the title of a column of numbers that does not fit the quantity of the row.
pub(super) fn fitting_unit(
    table: &Table,
    row: &Row,
    column: &str,
    coordinate: &str,
) -> Result<(), TableError> {
    let Some(given) = table.dimension(column) else { return Ok(()) };
    let of_row = match Coordinate::named(coordinate) {
        Some(Coordinate::Rotation) => Some(Dimension::Angle),
        Some(Coordinate::Force | Coordinate::LowestForce) => Some(Dimension::Force),
        Some(Coordinate::Share | Coordinate::ContactLoss | Coordinate::BacksideContact) => None,
        _ => Some(Dimension::Length),
    };
    match of_row == Some(given) {
        true => Ok(()),
        false => {
            let allowed = "a unit in its title only where all rows are displacements, all rotations or all forces; \
                           without one, numbers are in m, rad and N";
            Err(table.refusal(row, column, coordinate, allowed))
        }
    }
}
