//! Matrix Market files: a line of words, `%` comments, a line of sizes, then a line for each entry.
//!
//! The entries of `coordinate` are a row, a column and a number, counted from 1; those of `array` are numbers, column
//! by column. Of a `symmetric` matrix one triangle is there, of `array` the lower one.

use std::path::Path;

use super::MOST_ROWS;
use super::error::{MatrixError, Place};
use super::given::{Entries, GivenMatrix};
use crate::results::table::number;

/// What the first line may say.
const ALLOWED: &str = "%%MatrixMarket matrix coordinate|array real|integer general|symmetric";

/// What the first lines say.
struct Form {
    is_array: bool,
    is_symmetric: bool,
    rows: usize,
}

/// Reads the text of a file.
pub(super) fn read(path: &Path, text: &str) -> Result<GivenMatrix, MatrixError> {
    let end = Place { path, line: text.lines().count().max(1) as u64 };
    let mut lines = text.lines().zip(1..).map(|(text, line)| (text.trim(), Place { path, line }));
    let (words, place) = lines.next().unwrap_or(("", end));
    let [is_array, is_symmetric] = kind(place, words)?;
    let mut lines = lines.filter(|(text, _)| !text.is_empty() && !text.starts_with('%'));
    let (sizes, size_place) = lines.next().unwrap_or(("", end));
    let (rows, count) = size(size_place, sizes, is_array, is_symmetric)?;
    let form = Form { is_array, is_symmetric, rows };
    let mut entries = Entries::new(rows);
    let mut last = None;
    for k in 0..count {
        let Some((text, place)) = lines.next() else {
            let said = format!("{count} lines of entries, as line {} says", size_place.line);
            return Err(end.refuse("the number of entries", &k.to_string(), said));
        };
        last = Some(entry(place, text, &form, last, &mut entries)?);
    }
    match lines.next() {
        Some((text, place)) => {
            let allowed =
                format!("none after the {count} of entries that line {} says", size_place.line);
            Err(place.refuse("a further line", text, allowed))
        }
        None => Ok(entries.finish(path.to_owned(), size_place.line)),
    }
}

/// Whether entries stand as an array, and whether one triangle stands for both.
fn kind(place: Place<'_>, text: &str) -> Result<[bool; 2], MatrixError> {
    let lower = text.to_lowercase();
    let words: Vec<&str> = lower.split_whitespace().collect();
    match words.as_slice() {
        [
            "%%matrixmarket",
            "matrix",
            form @ ("coordinate" | "array"),
            "real" | "integer",
            symmetry @ ("general" | "symmetric"),
        ] => Ok([*form == "array", *symmetry == "symmetric"]),
        _ => Err(place.refuse("the first line", text, ALLOWED)),
    }
}

/// Number of rows and of entries.
fn size(
    place: Place<'_>,
    text: &str,
    is_array: bool,
    is_symmetric: bool,
) -> Result<(usize, usize), MatrixError> {
    let allowed = match is_array {
        true => "rows and columns",
        false => "rows, columns and number of entries",
    };
    let refuse = || place.refuse("the line of sizes", text, allowed);
    let numbers: Option<Vec<usize>> =
        text.split_whitespace().map(|word| word.parse().ok()).collect();
    let (rows, columns, entries) = match (numbers.as_deref(), is_array) {
        (Some([rows, columns]), true) => (*rows, *columns, None),
        (Some([rows, columns, entries]), false) => (*rows, *columns, Some(*entries)),
        _ => return Err(refuse()),
    };
    // Before anything is allocated.
    if rows != columns || rows == 0 || rows > MOST_ROWS {
        let allowed = format!("as many columns as rows, 1 to {MOST_ROWS}");
        return Err(place.refuse("the size", &format!("{rows} × {columns}"), allowed));
    }
    let most = if is_symmetric { rows * (rows + 1) / 2 } else { rows * rows };
    let count = entries.unwrap_or(most);
    match count <= most {
        true => Ok((rows, count)),
        false => {
            let allowed = format!("at most {most} of {rows} × {rows}");
            Err(place.refuse("the number of entries", &count.to_string(), allowed))
        }
    }
}

/// Reads an entry; `last` is the one before. Returns its row and column.
fn entry(
    place: Place<'_>,
    text: &str,
    form: &Form,
    last: Option<(usize, usize)>,
    entries: &mut Entries,
) -> Result<(usize, usize), MatrixError> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let index = |what: &str, word: &str| {
        let index = word.parse::<usize>().ok().filter(|k| (1..=form.rows).contains(k));
        let allowed = || format!("a whole number from 1 to {}", form.rows);
        index
            .map(|k| k - 1)
            .ok_or_else(|| place.refuse(format!("{what} of the entry"), word, allowed()))
    };
    let ((i, j), word) = match (words.as_slice(), form.is_array) {
        ([word], true) => {
            let next = match last {
                None => (0, 0),
                Some((i, j)) if i + 1 < form.rows => (i + 1, j),
                Some((_, j)) => (if form.is_symmetric { j + 1 } else { 0 }, j + 1),
            };
            (next, *word)
        }
        ([row, column, word], false) => ((index("row", row)?, index("column", column)?), *word),
        (_, true) => return Err(place.refuse("the entry", text, "one number a line")),
        (_, false) => return Err(place.refuse("the entry", text, "row, column and number")),
    };
    let name = || format!("entry ({}, {})", i + 1, j + 1);
    let Some((value, _)) = number(word, false) else {
        return Err(place.refuse(name(), word, "a finite number"));
    };
    if let Some(line) = entries.line(i, j) {
        let allowed = match form.is_symmetric {
            true => {
                format!("once, and line {line} has it: a symmetric matrix is given by one triangle")
            }
            false => format!("once, and line {line} has it"),
        };
        return Err(place.refuse(name(), word, allowed));
    }
    entries.set((i, j), value, word, place.line);
    if form.is_symmetric && i != j {
        entries.set((j, i), value, word, place.line);
    }
    Ok((i, j))
}
