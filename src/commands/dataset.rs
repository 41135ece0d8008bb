//! `dataset` and `dataset check`.

use std::io::Write;
use std::path::Path;

use validation::certified::{CertifiedValues, Class, DATA_SET_VERSION, altered, package};

use crate::arguments::{DataSet, DataSetVerb};
use crate::error::{CommandError, Result, refused, unwritten};
use crate::folder::must_be_empty;

pub(crate) fn run(arguments: &DataSet, out: &mut dyn Write) -> Result<bool> {
    match (&arguments.verb, &arguments.folder) {
        (Some(DataSetVerb::Check { folder }), _) => check(folder, out),
        (None, Some(folder)) => write(folder, out).map(|()| true),
        (None, None) => Err(refused("DIR", "is absent: allowed is a folder")),
    }
}

fn write(folder: &Path, out: &mut dyn Write) -> Result<()> {
    must_be_empty(folder)?;
    let files = package();
    for (name, text) in &files {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(unwritten(parent))?;
        std::fs::write(&path, text).map_err(unwritten(&path))?;
    }
    let values = CertifiedValues::shipped();
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
