//! `mesh_cycle.csv`.

use std::path::Path;
use std::sync::Arc;

use experiments::sweep::Part;

use super::SceneNames;
use super::named::{cycle_position, fitting_unit, part};
use crate::results::known_scenes::KnownScene;
use crate::results::table::{Column, Content, Quantity, Remark, Table, TableError};

/// Longest table that is read, bytes: some million rows.
const MOST_BYTES: u64 = 500_000_000;

const COORDINATES: &[&str] = &["x", "y", "rotation", "force"];

const COLUMNS: [Column; 6] = [
    Column::optional("scene", Content::Title),
    Column::required("sun_torque_nm", Content::Number(Quantity::Torque)),
    Column::required("position", Content::Number(Quantity::CyclePart)),
    Column::required("body", Content::Text),
    Column::required("coordinate", Content::Choice(COORDINATES)),
    Column::required("value", Content::Number(Quantity::ByRow)),
];

/// One quantity at one position of the mesh cycle at rest: columns `scene`, `sun_torque_nm`, `position`, `body`,
/// `coordinate`, `value`; all but the first are required.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleRow {
    /// Line of the file.
    pub line: u64,
    /// What the row is about.
    pub scene: Arc<KnownScene>,
    /// Torque on the sun, N m, counter-clockwise positive.
    pub sun_torque_nm: f64,
    /// Position in the mesh cycle, 0 to 1.
    pub position: f64,
    /// Body or mesh.
    pub part: Part,
    /// `x`, `y`, `rotation` or `force`.
    pub coordinate: &'static str,
    /// Displacement (m), rotation (rad) or force (N).
    pub value: f64,
}

impl CycleRow {
    /// Reads the table.
    pub(in crate::results) fn read(
        path: &Path,
        mut names: SceneNames<'_>,
    ) -> Result<(Vec<Self>, Vec<Remark>), TableError> {
        let table = Table::read(path, &COLUMNS, MOST_BYTES)?;
        let row = |row: &_| {
            let number = |column| table.number(row, column).unwrap_or_default();
            let word = table.text(row, "coordinate").unwrap_or_default();
            fitting_unit(&table, row, "value", word)?;
            Ok(Self {
                line: row.line,
                scene: names.scene(&table, row)?,
                sun_torque_nm: number("sun_torque_nm"),
                position: cycle_position(&table, row)?,
                part: part(&table, row)?,
                coordinate: COORDINATES.iter().find(|known| **known == word).unwrap_or(&""),
                value: number("value"),
            })
        };
        let rows = table.rows.iter().map(row).collect::<Result<_, _>>()?;
        Ok((rows, table.remarks))
    }
}
