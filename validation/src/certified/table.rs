//! Tables of rows, as CSV.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use super::row::Row;

/// Names of the tables that are shipped.
pub const TABLES: [&str; 9] = [
    "geometry",
    "modes",
    "matrices",
    "rules",
    "pairs",
    "mesh_cycle",
    "steady_states",
    "torque_growth",
    "stability",
];

/// Why a table of rows cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RowError {
    /// A line that is no row.
    #[error("{}:{line}: {reason}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: u64,
        /// What is wrong and what is allowed.
        reason: String,
    },
}

/// Reads the rows of a file; `path` is named in messages.
///
/// # Errors
/// [`RowError`] with the first fault.
pub fn read_rows(path: &Path, text: &str) -> Result<Vec<Row>, RowError> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for row in reader.deserialize() {
        let row: Row = row.map_err(|error| RowError::Line {
            path: path.to_owned(),
            line: error.position().map_or(1, csv::Position::line),
            reason: reason(&error),
        })?;
        rows.push(row);
    }
    Ok(rows)
}

/// What is wrong, with the column.
fn reason(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => {
            let column =
                err.field().map_or(String::new(), |field| format!("column {}: ", field + 1));
            format!("{column}{}", err.kind())
        }
        other => format!("{other:?}"),
    }
}

/// Writes rows as CSV, line ends `\n`.
///
/// # Errors
/// What the CSV writer says, which is nothing of memory.
pub fn write_rows(rows: &[Row]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// All rows that are shipped.
#[derive(Debug)]
pub struct CertifiedValues {
    /// Tables by name, in the order of [`TABLES`].
    pub tables: Vec<(&'static str, Vec<Row>)>,
    places: HashMap<String, [usize; 2]>,
    largest: HashMap<String, f64>,
}

impl CertifiedValues {
    /// The shipped tables; one that cannot be read is empty, which a test excludes.
    pub fn shipped() -> &'static Self {
        static SHIPPED: LazyLock<CertifiedValues> = LazyLock::new(|| {
            let table = |name: &'static str| {
                let path = format!("dataset/{name}.csv");
                let text = epicyclic_data::FILES.iter().find(|(file, _)| *file == path);
                (name, read_rows(path.as_ref(), text.map_or("", |t| t.1)).unwrap_or_default())
            };
            CertifiedValues::new(TABLES.map(table).to_vec())
        });
        &SHIPPED
    }

    pub(super) fn new(tables: Vec<(&'static str, Vec<Row>)>) -> Self {
        let (mut places, mut largest) = (HashMap::new(), HashMap::<String, f64>::new());
        for (t, (_, rows)) in tables.iter().enumerate() {
            for (k, row) in rows.iter().enumerate() {
                places.insert(row.id.clone(), [t, k]);
                let magnitude = largest.entry(group(row)).or_default();
                *magnitude = magnitude.max(row.value.abs());
            }
        }
        Self { tables, places, largest }
    }

    /// The row with that id.
    pub fn row(&self, id: &str) -> Option<&Row> {
        let [table, row] = *self.places.get(id)?;
        self.tables.get(table)?.1.get(row)
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.tables.iter().flat_map(|(_, rows)| rows)
    }

    /// Largest magnitude of the quantity of a row in its scene, of its kind of model and unit.
    pub fn largest(&self, row: &Row) -> f64 {
        self.largest.get(&group(row)).copied().unwrap_or_default()
    }
}

fn group(row: &Row) -> String {
    format!("{}.{}.{}.{}", row.kind, row.scene, row.quantity, row.unit)
}
