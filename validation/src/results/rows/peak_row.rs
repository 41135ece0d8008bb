//! `torque_peaks.csv`.

use std::path::Path;
use std::sync::Arc;

use experiments::sweep::Coordinate;
use experiments::torque::TorquePeak;

use super::SceneNames;
use super::named::{fitting_unit, part, sun_turns};
use crate::results::known_scenes::KnownScene;
use crate::results::table::{Column, Content, Quantity, Remark, Table, TableError};

/// Longest table that is read, bytes.
const MOST_BYTES: u64 = 50_000_000;

/// Highest harmonic that is read.
const MOST_HARMONICS: usize = 10_000;

const COORDINATES: &[&str] = &["translation", "rotation", "radial", "tangential", "force"];

const COLUMNS: [Column; 8] = [
    Column::optional("scene", Content::Title),
    Column::required("sun_torque_nm", Content::Number(Quantity::Torque)),
    Column::optional("sun_turns", Content::Choice(&["counter_clockwise", "clockwise"])),
    Column::required("body", Content::Text),
    Column::required("coordinate", Content::Choice(COORDINATES)),
    Column::required("harmonic", Content::Count(1, MOST_HARMONICS)),
    Column::required("frequency_hz", Content::Number(Quantity::Frequency)),
    Column::required("amplitude", Content::Number(Quantity::ByRow)),
];

/// A resonant peak under one torque: columns `scene`, `sun_torque_nm`, `sun_turns`, `body`, `coordinate`, `harmonic`,
/// `frequency_hz`, `amplitude`; the first and the third may be absent.
#[derive(Debug, Clone, PartialEq)]
pub struct PeakRow {
    /// Line of the file.
    pub line: u64,
    /// What the row is about.
    pub scene: Arc<KnownScene>,
    /// What it says.
    pub peak: TorquePeak,
}

impl PeakRow {
    /// Reads the table.
    pub(in crate::results) fn read(
        path: &Path,
        mut names: SceneNames<'_>,
    ) -> Result<(Vec<Self>, Vec<Remark>), TableError> {
        let table = Table::read(path, &COLUMNS, MOST_BYTES)?;
        let row = |row: &_| {
            let number = |column| table.number(row, column).unwrap_or_default();
            let word = table.text(row, "coordinate").unwrap_or_default();
            fitting_unit(&table, row, "amplitude", word)?;
            let refuse = || table.refusal(row, "coordinate", word, &COORDINATES.join(", "));
            let peak = TorquePeak {
                sun_torque_nm: number("sun_torque_nm"),
                sun_turns: sun_turns(&table, row),
                part: part(&table, row)?,
                coordinate: Coordinate::named(word).ok_or_else(refuse)?,
                harmonic: table.count(row, "harmonic").unwrap_or_default(),
                frequency_hz: number("frequency_hz"),
                amplitude: number("amplitude"),
            };
            Ok(Self { line: row.line, scene: names.scene(&table, row)?, peak })
        };
        let rows = table.rows.iter().map(row).collect::<Result<_, _>>()?;
        Ok((rows, table.remarks))
    }
}
