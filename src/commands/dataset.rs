//! `dataset` and `dataset check`.

use std::io::Write;
use std::path::Path;

#[cfg(feature = "parquet")]
use validation::certified::Row;
use validation::certified::{CertifiedValues, Class, DATA_SET_VERSION, altered, package};

use crate::arguments::{DataSet, DataSetVerb};
use crate::error::{CommandError, Result, refused, unwritten};
use crate::folder::must_be_empty;
#[cfg(feature = "parquet")]
use crate::output::Table;

pub(crate) fn run(arguments: &DataSet, out: &mut dyn Write) -> Result<bool> {
    match (&arguments.verb, &arguments.folder) {
        (Some(DataSetVerb::Check { folder }), _) => check(folder, out),
        (None, Some(folder)) => write(folder, out).map(|()| true),
        (None, None) => Err(refused("DIR", "is absent: allowed is a folder")),
    }
}

fn write(folder: &Path, out: &mut dyn Write) -> Result<()> {
    must_be_empty(folder)?;
    let values = CertifiedValues::shipped();
    let sweeps = sweeps(values)?;
    let mut files = package(&sweeps)
        .into_iter()
        .map(|(name, text)| (name, text.into_bytes()))
        .collect::<Vec<_>>();
    files.extend(sweeps);
    for (name, bytes) in &files {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(unwritten(parent))?;
        std::fs::write(&path, bytes).map_err(unwritten(&path))?;
    }
    let count = |class: Class| values.rows().filter(|row| row.class == class).count();
    let [a, b, c] = Class::ALL.map(count);
    writeln!(
        out,
        "wrote version {DATA_SET_VERSION} into {}: {} files, {a} certified values (class A), {b} of class B, {c} of \
         class C",
        folder.display(),
        files.len()
    )?;
    Ok(())
}

/// The table of sweeps as Parquet, columns as in CSV.
#[cfg(feature = "parquet")]
fn sweeps(values: &CertifiedValues) -> Result<Vec<(String, Vec<u8>)>> {
    const NAME: &str = "steady_states";
    let table = Table::<&Row>::new()
        .column("id", "", |row| row.id.clone())
        .column("quantity", "", |row| row.quantity.clone())
        .column("scene", "", |row| row.scene.clone())
        .column("kind", "", |row| row.kind.clone())
        .column("subject", "", |row| row.subject.clone())
        .column("coordinate", "", |row| row.coordinate.clone())
        .column("number", "", |row| row.number)
        .column("harmonic", "", |row| row.harmonic)
        .column("sun_torque_nm", "", |row| row.sun_torque_nm)
        .column("speed_rpm", "", |row| row.speed_rpm)
        .column("position", "", |row| row.position)
        .column("approach_um", "", |row| row.approach_um)
        .column("value", "", |row| row.value)
        .column("unit", "", |row| row.unit.clone())
        .column("uncertainty", "", |row| row.uncertainty)
        .column("class", "", |row| row.class.name())
        .column("routes", "", |row| row.routes.clone())
        .column("source", "", |row| row.source.clone())
        .column("version", "", |row| row.version.clone());
    let tables = values.tables.iter().filter(|(name, _)| *name == NAME);
    let rows: Vec<&Row> = tables.flat_map(|(_, rows)| rows).collect();
    let bytes = table.parquet(NAME, &rows).map_err(std::io::Error::other)?;
    Ok(vec![(format!("{NAME}.parquet"), bytes)])
}

/// No Parquet without the feature.
#[cfg(not(feature = "parquet"))]
fn sweeps(_: &CertifiedValues) -> Result<Vec<(String, Vec<u8>)>> {
    Ok(Vec::new())
}

fn check(folder: &Path, out: &mut dyn Write) -> Result<bool> {
    if !folder.is_dir() {
        let reason = "is no folder: allowed is one that `epicyclic dataset DIR` wrote".to_owned();
        return Err(CommandError::Results { path: folder.to_owned(), reason });
    }
    let found = altered(folder);
    for alteration in &found {
        writeln!(out, "{alteration}")?;
    }
    match found.len() {
        0 => {
            let rows = CertifiedValues::shipped().rows().count();
            writeln!(out, "version {DATA_SET_VERSION}: {rows} values, nothing altered")?;
        }
        _ => writeln!(out, "altered: write the data set again with `epicyclic dataset DIR`")?,
    }
    Ok(found.is_empty())
}
