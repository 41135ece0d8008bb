//! The tidy table of a sweep as Parquet, by columns.

use std::sync::Arc;

use experiments::sweep::{Sweep, TableRow};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use crate::error::CommandError;

/// A column of the table.
enum Column {
    Text(fn(&TableRow) -> &str),
    Number(fn(&TableRow) -> f64),
    Count(fn(&TableRow) -> usize),
    OptionalNumber(fn(&TableRow) -> Option<f64>),
    OptionalCount(fn(&TableRow) -> Option<usize>),
}

use Column::{Count, Number, OptionalCount, OptionalNumber, Text};

/// Named and ordered as in the CSV.
const COLUMNS: [(&str, Column); 21] = [
    ("scene", Text(|row| &row.scene)),
    ("fidelity", Text(|row| &row.fidelity)),
    ("sun_torque_nm", Number(|row| row.sun_torque_nm)),
    ("speed_rpm", Number(|row| row.speed_rpm)),
    ("mesh_frequency_hz", Number(|row| row.mesh_frequency_hz)),
    ("chain", Text(|row| &row.chain)),
    ("body", Text(|row| &row.body)),
    ("coordinate", Text(|row| &row.coordinate)),
    ("harmonic", Count(|row| row.harmonic)),
    ("amplitude", Number(|row| row.amplitude)),
    ("unit", Text(|row| &row.unit)),
    ("phase_rad", Number(|row| row.phase_rad)),
    ("cycles", Count(|row| row.cycles)),
    ("residual", Number(|row| row.residual)),
    ("repeats_after", OptionalCount(|row| row.repeats_after)),
    ("attracts", Text(|row| &row.attracts)),
    ("multiplier", OptionalNumber(|row| row.multiplier)),
    ("multiplier_kind", Text(|row| &row.multiplier_kind)),
    ("mode_type", Text(|row| &row.mode_type)),
    ("start", Text(|row| &row.start)),
    ("sun_turns", Text(|row| &row.sun_turns)),
];

/// The table as one row group.
pub(super) fn parquet(sweep: &Sweep, scene: &str) -> Result<Vec<u8>, CommandError> {
    let rows: Vec<TableRow> = sweep.rows(scene).collect();
    bytes(&rows).map_err(|e| CommandError::Output(std::io::Error::other(e)))
}

fn bytes(rows: &[TableRow]) -> Result<Vec<u8>, ParquetError> {
    let field = |(name, column): &(&str, Column)| match column {
        Text(_) => format!("REQUIRED BYTE_ARRAY {name} (UTF8);"),
        Number(_) => format!("REQUIRED DOUBLE {name};"),
        Count(_) => format!("REQUIRED INT64 {name};"),
        OptionalNumber(_) => format!("OPTIONAL DOUBLE {name};"),
        OptionalCount(_) => format!("OPTIONAL INT64 {name};"),
    };
    let fields: String = COLUMNS.iter().map(field).collect();
    let schema = Arc::new(parse_message_type(&format!("message sweep {{{fields}}}"))?);
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::default())?;
    let mut group = writer.next_row_group()?;
    for (_, column) in &COLUMNS {
        let Some(mut own) = group.next_column()? else { break };
        match (own.untyped(), column) {
            (ColumnWriter::ByteArrayColumnWriter(own), Text(of)) => {
                let values: Vec<ByteArray> = rows.iter().map(|r| of(r).into()).collect();
                own.write_batch(&values, None, None)?;
            }
            (ColumnWriter::DoubleColumnWriter(own), Number(of)) => {
                let values: Vec<f64> = rows.iter().map(of).collect();
                own.write_batch(&values, None, None)?;
            }
            (ColumnWriter::Int64ColumnWriter(own), Count(of)) => {
                let values: Vec<i64> = rows.iter().map(|r| of(r) as i64).collect();
                own.write_batch(&values, None, None)?;
            }
            (ColumnWriter::DoubleColumnWriter(own), OptionalNumber(of)) => {
                let values: Vec<f64> = rows.iter().filter_map(of).collect();
                let present: Vec<i16> = rows.iter().map(|r| of(r).is_some().into()).collect();
                own.write_batch(&values, Some(&present), None)?;
            }
            (ColumnWriter::Int64ColumnWriter(own), OptionalCount(of)) => {
                let values: Vec<i64> = rows.iter().filter_map(|r| Some(of(r)? as i64)).collect();
                let present: Vec<i16> = rows.iter().map(|r| of(r).is_some().into()).collect();
                own.write_batch(&values, Some(&present), None)?;
            }
            _ => return Err(ParquetError::General("a column of another type".into())),
        }
        own.close()?;
    }
    group.close()?;
    writer.into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    #[test]
    fn what_is_written_can_be_read() {
        let row = |speed_rpm: f64, harmonic| TableRow {
            scene: "a set".into(),
            fidelity: "quasi-static".into(),
            sun_torque_nm: 1130.0,
            speed_rpm,
            mesh_frequency_hz: 0.5 * speed_rpm,
            chain: "up_00".into(),
            body: "sun".into(),
            coordinate: "rotation".into(),
            harmonic,
            amplitude: 1e-6 * speed_rpm,
            unit: "rad".into(),
            phase_rad: -0.25,
            cycles: 40,
            residual: 1e-9,
            repeats_after: (harmonic != 2).then_some(1),
            attracts: "by_multipliers".into(),
            multiplier: (harmonic != 2).then_some(0.9),
            multiplier_kind: "fold".into(),
            mode_type: "rotational".into(),
            start: "rest".into(),
            sun_turns: "counter_clockwise".into(),
        };
        let rows = [row(800.0, 1), row(900.0, 2), row(1000.0, 3)];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.parquet");
        std::fs::write(&path, bytes(&rows).unwrap()).unwrap();
        let reader = SerializedFileReader::try_from(path.as_path()).unwrap();
        let found: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(found.len(), rows.len());
        for (found, row) in found.iter().zip(&rows) {
            assert_eq!(found.get_string(0).unwrap(), &row.scene);
            assert_eq!(found.get_double(3).unwrap(), row.speed_rpm);
            assert_eq!(found.get_long(8).unwrap() as usize, row.harmonic);
            assert_eq!(found.get_double(9).unwrap(), row.amplitude);
            assert_eq!(found.get_string(10).unwrap(), &row.unit);
            assert_eq!(found.get_long(14).ok().map(|n| n as usize), row.repeats_after);
            assert_eq!(found.get_double(16).ok(), row.multiplier);
            assert_eq!(found.get_string(19).unwrap(), &row.start);
        }
    }
}
