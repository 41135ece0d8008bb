//! A table as Parquet, by columns.

use std::sync::Arc;

use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use super::column::{Cell, Column, Kind};
use super::table::Table;

impl<R> Table<'_, R> {
    /// Rows as one row group of a message `name`; every field is optional.
    pub(crate) fn parquet(&self, name: &str, rows: &[R]) -> Result<Vec<u8>, ParquetError> {
        let kind = |kind| match kind {
            Kind::Words => ("BYTE_ARRAY", " (UTF8)"),
            Kind::Number => ("DOUBLE", ""),
            Kind::Count => ("INT64", ""),
            Kind::Flag => ("BOOLEAN", ""),
        };
        let field = |(field, column): (&str, &Column<'_, R>)| {
            let (physical, logical) = kind(column.kind);
            format!("OPTIONAL {physical} {field}{logical};")
        };
        let fields: String = self.named().map(field).collect();
        let schema = Arc::new(parse_message_type(&format!("message {name} {{{fields}}}"))?);
        let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::default())?;
        let mut group = writer.next_row_group()?;
        for (_, column) in self.named() {
            let Some(mut target) = group.next_column()? else { break };
            let cells: Vec<Cell> = rows.iter().map(|row| (column.cell)(row)).collect();
            let present: Vec<i16> = cells.iter().map(|c| (*c != Cell::Nothing).into()).collect();
            let levels = Some(present.as_slice());
            let (mut words, mut numbers, mut counts, mut flags) = (vec![], vec![], vec![], vec![]);
            for cell in &cells {
                match cell {
                    Cell::Words(text) => words.push(ByteArray::from(text.as_str())),
                    Cell::Number(x) => numbers.push(*x),
                    Cell::Count(n) => counts.push(*n),
                    Cell::Flag(is) => flags.push(*is),
                    Cell::Nothing => {}
                }
            }
            match target.untyped() {
                ColumnWriter::ByteArrayColumnWriter(to) => to.write_batch(&words, levels, None)?,
                ColumnWriter::DoubleColumnWriter(to) => to.write_batch(&numbers, levels, None)?,
                ColumnWriter::Int64ColumnWriter(to) => to.write_batch(&counts, levels, None)?,
                ColumnWriter::BoolColumnWriter(to) => to.write_batch(&flags, levels, None)?,
                _ => return Err(ParquetError::General("a column of another type".into())),
            };
            target.close()?;
        }
        group.close()?;
        writer.into_inner()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    #[test]
    fn what_is_written_is_read_again() {
        let table = Table::<(&str, f64, Option<usize>, bool)>::new()
            .column("body", "", |row| row.0)
            .column("speed_rpm", "", |row| row.1)
            .column("repeats_after", "", |row| row.2)
            .column("is_stable", "", |row| row.3);
        let rows = [("sun", 800.5, Some(1), true), ("ring", 900.0, None, false)];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.parquet");
        std::fs::write(&path, table.parquet("sweep", &rows).unwrap()).unwrap();
        let reader = SerializedFileReader::try_from(path.as_path()).unwrap();
        let found: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(found.len(), rows.len());
        for (found, row) in found.iter().zip(&rows) {
            assert_eq!(found.get_string(0).unwrap(), row.0);
            assert_eq!(found.get_double(1).unwrap(), row.1);
            assert_eq!(found.get_long(2).ok().map(|n| n as usize), row.2);
            assert_eq!(found.get_bool(3).unwrap(), row.3);
        }
    }
}
