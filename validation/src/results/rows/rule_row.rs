//! `rules.csv`.

use std::path::Path;
use std::sync::Arc;

use gearset::AllowedKinds;

use super::SceneNames;
use crate::results::known_scenes::KnownScene;
use crate::results::table::{Column, Content, Remark, Table, TableError};

/// Longest table that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

/// Highest harmonic that is read.
const MOST_HARMONICS: usize = 1000;

const COLUMNS: [Column; 3] = [
    Column::optional("scene", Content::Title),
    Column::required("harmonic", Content::Count(1, MOST_HARMONICS)),
    Column::required("excites", Content::Text),
];

/// Which kinds of modes a harmonic of the mesh frequency can excite: columns `scene`, `harmonic`, `excites`, the last
/// with any of `rotational`, `translational`, `planet`, or `none`; the first may be absent.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleRow {
    /// Line of the file.
    pub line: u64,
    /// What the row is about.
    pub scene: Arc<KnownScene>,
    /// Harmonic l of the mesh frequency.
    pub harmonic: usize,
    /// Kinds of modes that it can excite.
    pub excites: AllowedKinds,
}

impl RuleRow {
    /// Reads the table.
    pub(in crate::results) fn read(
        path: &Path,
        mut names: SceneNames<'_>,
    ) -> Result<(Vec<Self>, Vec<Remark>), TableError> {
        let table = Table::read(path, &COLUMNS, MOST_BYTES)?;
        let row = |row: &_| {
            let text = table.text(row, "excites").unwrap_or_default();
            let words = text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
            let mut excites =
                AllowedKinds { rotational: false, translational: false, planet: false };
            for word in words {
                match word.to_lowercase().as_str() {
                    "rotational" => excites.rotational = true,
                    "translational" => excites.translational = true,
                    "planet" => excites.planet = true,
                    "none" => {}
                    _ => {
                        let allowed = "rotational, translational, planet, several of them, or none";
                        return Err(table.refusal(row, "excites", text, allowed));
                    }
                }
            }
            Ok(Self {
                line: row.line,
                scene: names.scene(&table, row)?,
                harmonic: table.count(row, "harmonic").unwrap_or_default(),
                excites,
            })
        };
        let rows = table.rows.iter().map(row).collect::<Result<_, _>>()?;
        Ok((rows, table.remarks))
    }
}
