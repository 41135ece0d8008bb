//! Whether a folder with the data set is what it says.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

use super::class::Class;
use super::package::{HASHES, package, sha256};
use super::quantity::Quantity;
use super::row::Row;
use super::score::correct_digits;
use super::table::{CertifiedValues, TABLES, read_rows};
use super::{DATA_SET_VERSION, RowError};

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 50_000_000;

/// Most findings of one table that are listed.
const MOST_LISTED: usize = 20;

/// One thing that is not as it was published.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Alteration {
    /// File, and line where there is one.
    pub place: String,
    /// What is wrong.
    pub statement: String,
}

impl fmt::Display for Alteration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.statement)
    }
}

/// What is altered in a folder; nothing of one that is whole.
///
/// Hashes first, then every table: columns and their order, ids, units, ranges, routes, scenes, and each value beside
/// that of the version which this program has.
pub fn altered(folder: &Path) -> Vec<Alteration> {
    let mut found = hashes(folder);
    for name in TABLES {
        let path = folder.join(format!("{name}.csv"));
        let text = match scene::read_text(&path, MOST_BYTES) {
            Ok(text) => text,
            Err(error) => {
                found.push(at(format!("{name}.csv"), format!("cannot be read: {error}")));
                continue;
            }
        };
        match columns(name, &text) {
            Some(wrong) => found.push(wrong),
            None => found.extend(table(name, &path, &text)),
        }
    }
    found
}

fn at(place: impl Into<String>, statement: impl Into<String>) -> Alteration {
    Alteration { place: place.into(), statement: statement.into() }
}

fn hashes(folder: &Path) -> Vec<Alteration> {
    let list = match scene::read_text(&folder.join(HASHES), MOST_BYTES) {
        Ok(list) => list,
        Err(error) => return vec![at(HASHES, format!("cannot be read: {error}"))],
    };
    let mut found = Vec::new();
    let listed: BTreeMap<&str, &str> = list
        .lines()
        .filter_map(|line| line.split_once("  "))
        .map(|(hash, file)| (file, hash))
        .collect();
    let files = package(&[]);
    for (file, text) in files.iter().filter(|(file, _)| file != HASHES) {
        let expected = sha256(text.as_bytes());
        match (std::fs::read(folder.join(file)), listed.get(file.as_str())) {
            (Err(error), _) => found.push(at(file.as_str(), format!("cannot be read: {error}"))),
            (Ok(_), None) => found.push(at(HASHES, format!("has no line of {file}"))),
            (Ok(bytes), Some(listed)) => {
                let hash = sha256(&bytes);
                if hash != **listed {
                    found.push(at(file.as_str(), not_listed()));
                } else if hash != expected {
                    let version = format!(
                        "is not that of version {DATA_SET_VERSION}, though {HASHES} has its hash"
                    );
                    found.push(at(file.as_str(), version));
                }
            }
        }
    }
    // Files that only some programs write, as Parquet: their hash is all that is known of them.
    for (file, hash) in listed.iter().filter(|(file, _)| files.iter().all(|(f, _)| f != *file)) {
        match std::fs::read(folder.join(file)) {
            Err(error) => found.push(at(*file, format!("cannot be read: {error}"))),
            Ok(bytes) if sha256(&bytes) != **hash => found.push(at(*file, not_listed())),
            Ok(_) => {}
        }
    }
    found
}

fn not_listed() -> String {
    format!("is not the file of which {HASHES} has the hash")
}

/// Columns that are not those of a table, in their order.
fn columns(name: &str, text: &str) -> Option<Alteration> {
    let titles = text.lines().next().unwrap_or_default();
    let path = format!("dataset/{name}.csv");
    let shipped = epicyclic_data::FILES.iter().find(|(file, _)| *file == path)?;
    let expected = shipped.1.lines().next().unwrap_or_default();
    let statement = format!("columns are `{titles}`, and those of the data set are `{expected}`");
    (titles != expected).then(|| at(format!("{name}.csv:1"), statement))
}

fn table(name: &str, path: &Path, text: &str) -> Vec<Alteration> {
    let rows = match read_rows(path, text) {
        Ok(rows) => rows,
        Err(RowError::Line { line, reason, .. }) => {
            return vec![at(format!("{name}.csv:{line}"), reason)];
        }
    };
    let values = CertifiedValues::shipped();
    let mut found = Vec::new();
    let mut ids = BTreeSet::new();
    for (k, row) in rows.iter().enumerate() {
        let place = format!("{name}.csv:{}", k + 2);
        if !ids.insert(row.id.as_str()) {
            found.push(at(&place, format!("`{}` is there twice", row.id)));
        }
        let faults =
            faults(row).or_else(|| values.row(&row.id).and_then(|kept| differs(row, kept)));
        match (faults, values.row(&row.id)) {
            (Some(fault), _) => found.push(at(&place, format!("`{}`: {fault}", row.id))),
            (None, None) => {
                found.push(at(&place, format!("`{}` is not in version {DATA_SET_VERSION}", row.id)))
            }
            _ => {}
        }
    }
    let shipped = values.tables.iter().find(|(table, _)| *table == name);
    let missing: Vec<&str> = shipped
        .map_or(&[][..], |(_, rows)| rows)
        .iter()
        .map(|row| row.id.as_str())
        .filter(|id| !ids.contains(id))
        .collect();
    if let Some(first) = missing.first() {
        found.push(at(
            format!("{name}.csv"),
            format!("{} rows are missing, the first `{first}`", missing.len()),
        ));
    }
    if found.len() > MOST_LISTED {
        let more = found.len() - MOST_LISTED;
        found.truncate(MOST_LISTED);
        found.push(at(format!("{name}.csv"), format!("and {more} more")));
    }
    found
}

/// What a row cannot be in any version.
fn faults(row: &Row) -> Option<String> {
    let Some(quantity) = Quantity::named(&row.quantity) else {
        return Some(format!("no quantity is called `{}`", row.quantity));
    };
    let name = row.name();
    if row.id != name {
        return Some(format!("its columns make `{name}`"));
    }
    if row.unit != quantity.unit && !quantity.unit.is_empty() {
        return Some(format!(
            "the unit is `{}`, and that of `{}` is `{}`",
            row.unit, row.quantity, quantity.unit
        ));
    }
    let [least, most] = quantity.range;
    if !(least..=most).contains(&row.value) {
        return Some(format!("{} is beyond {least} to {most}", row.value));
    }
    if row.class != Class::C && row.routes.split("; ").count() < 2 {
        return Some(format!("class {} needs two routes", row.class.name()));
    }
    None
}

/// How a row differs from that of this version.
fn differs(row: &Row, kept: &Row) -> Option<String> {
    if row == kept {
        return None;
    }
    if row.value == kept.value {
        return Some("another column differs from the data set's".to_owned());
    }
    let largest = CertifiedValues::shipped().largest(kept);
    let digits = correct_digits(row.value, kept.value, 0.0, largest);
    Some(format!(
        "the value is {}, that of the data set {}: {digits:.1} digits agree",
        row.value, kept.value
    ))
}
