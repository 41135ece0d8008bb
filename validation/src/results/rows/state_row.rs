//! `steady_states.csv`.

use std::path::Path;
use std::sync::Arc;

use experiments::sweep::{Coordinate, Part};
use gearset::Facing;

use super::SceneNames;
use super::named::{fitting_unit, part, sun_turns};
use crate::results::known_scenes::KnownScene;
use crate::results::table::{Column, Content, Quantity, Remark, Table, TableError};

/// Longest table that is read, bytes: some million rows.
const MOST_BYTES: u64 = 500_000_000;

/// Highest harmonic that is read.
const MOST_HARMONICS: usize = 10_000;

const COORDINATES: &[&str] = &[
    "radial",
    "tangential",
    "rotation",
    "translation",
    "force",
    "share",
    "contact_loss",
    "lowest_force",
    "backside_contact",
];

const COLUMNS: [Column; 11] = [
    Column::optional("scene", Content::Title),
    Column::required("sun_torque_nm", Content::Number(Quantity::Torque)),
    Column::required("speed_rpm", Content::Number(Quantity::Speed)),
    Column::required("mesh_frequency_hz", Content::Number(Quantity::Frequency)),
    Column::required("body", Content::Text),
    Column::required("coordinate", Content::Choice(COORDINATES)),
    Column::required("harmonic", Content::Count(0, MOST_HARMONICS)),
    Column::required("amplitude", Content::Number(Quantity::ByRow)),
    Column::required("phase_rad", Content::Number(Quantity::Angle)),
    Column::optional("sun_turns", Content::Choice(&["counter_clockwise", "clockwise"])),
    Column::optional("chain", Content::Text),
];

/// One harmonic of one quantity at one speed: columns `scene`, `sun_torque_nm`, `speed_rpm`, `mesh_frequency_hz`,
/// `body`, `coordinate`, `harmonic`, `amplitude`, `phase_rad`, `sun_turns`, `chain`; the first and the last two may be
/// absent.
#[derive(Debug, Clone, PartialEq)]
pub struct StateRow {
    /// Line of the file.
    pub line: u64,
    /// What the row is about.
    pub scene: Arc<KnownScene>,
    /// Torque on the sun, N m, counter-clockwise positive.
    pub sun_torque_nm: f64,
    /// Speed of the driven member, rpm.
    pub speed_rpm: f64,
    /// Mesh frequency, Hz.
    pub mesh_frequency_hz: f64,
    /// Body or mesh.
    pub part: Part,
    /// Quantity.
    pub coordinate: Coordinate,
    /// Harmonic of the mesh frequency; 0 is the mean.
    pub harmonic: usize,
    /// Amplitude in m, rad, N or 1, as the quantity has it.
    pub amplitude: f64,
    /// Phase φ of A cos(2π l f_m t + φ), rad.
    pub phase_rad: f64,
    /// Sense in which the sun turns relative to the carrier, if it is given.
    pub sun_turns: Option<Facing>,
    /// Which of several sweeps over the same speeds.
    pub chain: Option<Arc<str>>,
}

impl StateRow {
    /// Reads the table.
    pub(in crate::results) fn read(
        path: &Path,
        mut names: SceneNames<'_>,
    ) -> Result<(Vec<Self>, Vec<Remark>), TableError> {
        let table = Table::read(path, &COLUMNS, MOST_BYTES)?;
        let mut chains: Vec<Arc<str>> = Vec::new();
        let row = |row: &_| {
            let number = |column| table.number(row, column).unwrap_or_default();
            let word = table.text(row, "coordinate").unwrap_or_default();
            fitting_unit(&table, row, "amplitude", word)?;
            let refuse = || table.refusal(row, "coordinate", word, &COORDINATES.join(", "));
            let coordinate = Coordinate::named(word).ok_or_else(refuse)?;
            let chain = table.text(row, "chain").map(|name| {
                let known = chains.iter().find(|chain| &***chain == name).cloned();
                known.unwrap_or_else(|| {
                    let chain: Arc<str> = name.into();
                    chains.push(chain.clone());
                    chain
                })
            });
            Ok(Self {
                line: row.line,
                scene: names.scene(&table, row)?,
                sun_torque_nm: number("sun_torque_nm"),
                speed_rpm: number("speed_rpm"),
                mesh_frequency_hz: number("mesh_frequency_hz"),
                part: part(&table, row)?,
                coordinate,
                harmonic: table.count(row, "harmonic").unwrap_or_default(),
                amplitude: number("amplitude"),
                phase_rad: number("phase_rad"),
                sun_turns: sun_turns(&table, row),
                chain,
            })
        };
        let rows = table.rows.iter().map(row).collect::<Result<_, _>>()?;
        Ok((rows, table.remarks))
    }
}
