//! `mesh_stiffness.csv`.

use std::path::Path;
use std::sync::Arc;

use experiments::sweep::Part;

use super::SceneNames;
use super::named::{cycle_position, part};
use crate::results::known_scenes::KnownScene;
use crate::results::table::{Column, Content, Quantity, Remark, Table, TableError};

/// Longest table that is read, bytes.
const MOST_BYTES: u64 = 50_000_000;

const COLUMNS: [Column; 5] = [
    Column::optional("scene", Content::Title),
    Column::required("sun_torque_nm", Content::Number(Quantity::Torque)),
    Column::required("body", Content::Text),
    Column::required("position", Content::Number(Quantity::CyclePart)),
    Column::required("stiffness_n_per_m", Content::Number(Quantity::Stiffness)).or_called(&[
        "secant_stiffness",
        "mesh_stiffness",
        "k",
    ]),
];

/// Secant stiffness of one mesh at one position of the mesh cycle: columns `scene`, `sun_torque_nm`, `body`,
/// `position`, `stiffness_n_per_m`; all but the first are required.
#[derive(Debug, Clone, PartialEq)]
pub struct StiffnessRow {
    /// Line of the file.
    pub line: u64,
    /// What the row is about.
    pub scene: Arc<KnownScene>,
    /// Torque on the sun, N m, counter-clockwise positive, not 0.
    pub sun_torque_nm: f64,
    /// Mesh.
    pub part: Part,
    /// Phase of planet 0's sun mesh, 0 to 1.
    pub position: f64,
    /// k = F/δ, N/m.
    pub stiffness_n_per_m: f64,
}

impl StiffnessRow {
    /// Reads the table.
    pub(in crate::results) fn read(
        path: &Path,
        mut names: SceneNames<'_>,
    ) -> Result<(Vec<Self>, Vec<Remark>), TableError> {
        let table = Table::read(path, &COLUMNS, MOST_BYTES)?;
        let row = |row: &_| {
            let number = |column| table.number(row, column).unwrap_or_default();
            let part = part(&table, row)?;
            if !matches!(part, Part::SunMesh(_) | Part::RingMesh(_)) {
                let allowed = "a mesh: sun_mesh_0, ring_mesh_0 and so on";
                return Err(table.refusal(row, "body", &part.name(), allowed));
            }
            let sun_torque_nm = number("sun_torque_nm");
            if sun_torque_nm == 0.0 {
                let allowed = "a torque other than 0, for k is the load over the deflection";
                return Err(table.refusal(row, "sun_torque_nm", "0", allowed));
            }
            Ok(Self {
                line: row.line,
                scene: names.scene(&table, row)?,
                sun_torque_nm,
                part,
                position: cycle_position(&table, row)?,
                stiffness_n_per_m: number("stiffness_n_per_m"),
            })
        };
        let rows = table.rows.iter().map(row).collect::<Result<_, _>>()?;
        Ok((rows, table.remarks))
    }
}
