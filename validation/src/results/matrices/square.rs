//! A square table of numbers without titles, separated by tabs, `;`, commas or blanks.

use std::path::Path;

use super::MOST_ROWS;
use super::error::{MatrixError, Place};
use super::given::{Entries, GivenMatrix};
use crate::results::table::{number, separator};

/// Reads the text of a file.
pub(super) fn read(path: &Path, text: &str) -> Result<GivenMatrix, MatrixError> {
    let is_number_line = |(line, _): &(&str, _)| {
        let is_blank = line.trim_matches([' ', ';', ',', '\t', '\r']).is_empty();
        !is_blank && !line.starts_with('#') && !line.to_lowercase().starts_with("sep=")
    };
    let lines: Vec<(&str, u64)> = text.lines().zip(1..).filter(is_number_line).collect();
    let Some(&(first, size_line)) = lines.first() else {
        let allowed = "as many rows of numbers as columns";
        return Err(Place { path, line: 1 }.refuse("the table", "", allowed));
    };
    let separator = char::from(separator(first));
    let cells = |line: &'_ str| -> Vec<String> {
        let line = line.trim();
        let cell = |cell: &str| cell.trim().trim_matches('"').trim().to_owned();
        match line.contains(separator) {
            true => line.split(separator).map(cell).collect(),
            false => line.split_whitespace().map(cell).collect(),
        }
    };
    let columns = cells(first).len();
    if columns != lines.len() || columns > MOST_ROWS {
        let size = format!("{} × {columns}", lines.len());
        let allowed = format!("as many columns as rows, 1 to {MOST_ROWS}");
        return Err(Place { path, line: size_line }.refuse("the size", &size, allowed));
    }
    let mut entries = Entries::new(columns);
    for (i, &(line, number_of_line)) in lines.iter().enumerate() {
        let place = Place { path, line: number_of_line };
        let cells = cells(line);
        if cells.len() != columns {
            let allowed = format!("{columns}, as line {size_line} has");
            return Err(place.refuse("the number of columns", &cells.len().to_string(), allowed));
        }
        for (j, cell) in cells.iter().enumerate() {
            let read = number(cell, separator != ',');
            let (value, _) = read.ok_or_else(|| {
                place.refuse(
                    format!("column {}", j + 1),
                    cell,
                    "a finite number, without titles of rows or columns",
                )
            })?;
            entries.set((i, j), value, cell, number_of_line);
        }
    }
    Ok(entries.finish(path.to_owned(), size_line))
}
