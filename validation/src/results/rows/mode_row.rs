//! `modes.csv`.

use std::path::Path;
use std::sync::Arc;

use super::vector_entry::vector_column;
use super::{MOST, SceneNames, VectorEntry};
use crate::compare::ListedMode;
use crate::results::known_scenes::KnownScene;
use crate::results::table::{Column, Content, Quantity, Remark, Row, Table, TableError};

/// Longest table that is read, bytes: also all vectors of 64 planets in 17 digits.
const MOST_BYTES: u64 = 1_000_000;

const COLUMNS: [Column; 4] = [
    Column::optional("scene", Content::Title),
    Column::required("frequency_hz", Content::Number(Quantity::Frequency)).or_called(&[
        "omega",
        "natural_frequency",
        "f",
    ]),
    Column::optional(
        "mode_type",
        Content::Choice(&["rotational", "translational", "planet", "mixed"]),
    )
    .or_called(&["type"]),
    Column::optional("multiplicity", Content::Count(1, MOST)),
];

/// A natural frequency: columns `scene`, `frequency_hz`, `mode_type`, `multiplicity`, and a column for each coordinate
/// of its vector, such as `planet_0_radial`; only the second is required.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeRow {
    /// Line of the file.
    pub line: u64,
    /// What the row is about.
    pub scene: Arc<KnownScene>,
    /// Natural frequency, Hz, 0 of rigid-body motion.
    pub frequency_hz: f64,
    /// `rotational`, `translational`, `planet` or `mixed`, if it is known.
    pub mode_type: Option<String>,
    /// How many modes have that frequency, if the table says so.
    pub multiplicity: Option<usize>,
    /// Vector of the mode in the author's coordinates; empty if there is none.
    pub vector: Vec<VectorEntry>,
}

impl ModeRow {
    /// How many modes the row stands for: one unless the table says otherwise.
    pub fn times(&self) -> usize {
        self.multiplicity.unwrap_or(1)
    }

    /// The row as a list of frequencies has it.
    pub fn listed(&self) -> ListedMode {
        ListedMode {
            frequency_hz: self.frequency_hz,
            mode_type: self.mode_type.clone(),
            multiplicity: self.multiplicity,
        }
    }

    /// Reads the table.
    pub(in crate::results) fn read(
        path: &Path,
        mut names: SceneNames<'_>,
    ) -> Result<(Vec<Self>, Vec<Remark>), TableError> {
        let is_vector = |title: &str| vector_column(title).is_some();
        let table = Table::read_with(path, &COLUMNS, is_vector, MOST_BYTES)?;
        let columns: Vec<_> =
            table.further.iter().filter_map(|title| vector_column(title)).collect();
        let row = |row: &Row| {
            let frequency_hz = table.number(row, "frequency_hz").unwrap_or_default();
            if frequency_hz < 0.0 {
                let value = frequency_hz.to_string();
                return Err(table.refusal(row, "frequency_hz", &value, "0 or above"));
            }
            let entries = columns.iter().zip(&row.further);
            let entry = |(&(body, axis), value): (&(_, _), &Option<f64>)| {
                Some(VectorEntry { body, axis, value: (*value)? })
            };
            Ok(Self {
                vector: entries.filter_map(entry).collect(),
                line: row.line,
                scene: names.scene(&table, row)?,
                frequency_hz,
                mode_type: table.text(row, "mode_type").map(str::to_owned),
                multiplicity: table.count(row, "multiplicity"),
            })
        };
        let rows = table.rows.iter().map(row).collect::<Result<_, _>>()?;
        Ok((rows, table.remarks))
    }
}
