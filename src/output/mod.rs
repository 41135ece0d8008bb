//! What every verb prints and saves: text, CSV and JSON of one result.

mod column;
#[cfg(feature = "parquet")]
mod parquet;
mod table;
mod wrapped;

pub(crate) use column::Notation;
pub(crate) use table::Table;
pub(crate) use wrapped::{WIDTH, paragraph};

use std::io::Write;

use serde::Serialize;

use crate::arguments::Format;
use crate::error::Result;

/// A result of a verb. Its JSON is that of `Serialize`.
pub(crate) trait Report: Serialize {
    /// Text for people.
    fn text(&self, out: &mut dyn Write) -> Result<()>;

    /// Its table, for programs.
    fn csv(&self, out: &mut dyn Write) -> Result<()>;
}

/// Writes a result in the format asked for.
pub(crate) fn show(format: Format, report: &impl Report, out: &mut dyn Write) -> Result<()> {
    match format {
        Format::Json => json(out, report),
        Format::Csv => report.csv(out),
        Format::Text => {
            let mut text = Vec::new();
            report.text(&mut text)?;
            Ok(out.write_all(wrapped::wrapped(&String::from_utf8_lossy(&text)).as_bytes())?)
        }
    }
}

/// Writes a value as indented JSON and a newline.
pub(crate) fn json(out: &mut dyn Write, value: &impl Serialize) -> Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    writeln!(out)?;
    Ok(())
}

/// The word by which JSON names a variant without data; empty for anything else.
pub(crate) fn word(variant: &impl Serialize) -> String {
    let value = serde_json::to_value(variant).unwrap_or_default();
    value.as_str().unwrap_or_default().to_owned()
}
