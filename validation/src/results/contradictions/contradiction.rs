//! One thing in a table that cannot be true.

use std::fmt;
use std::path::{Path, PathBuf};

/// Names of columns.
pub(super) type Columns = &'static [&'static str];

/// What contradicts what, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contradiction {
    /// The file.
    pub path: PathBuf,
    /// Lines that contradict each other, from 1: the first two, or the first and the last of many.
    pub lines: Vec<u64>,
    /// Names of the columns whose cells cannot be true together; none of a matrix or a vector, whose statement names
    /// the coordinates.
    pub columns: &'static [&'static str],
    /// What cannot be true.
    pub statement: String,
    /// What to do.
    pub remedy: String,
}

impl Contradiction {
    pub(super) fn new(
        path: &Path,
        lines: impl IntoIterator<Item = u64>,
        columns: Columns,
        statement: String,
        remedy: impl Into<String>,
    ) -> Self {
        let mut lines: Vec<u64> = lines.into_iter().collect();
        lines.dedup();
        Self { path: path.to_owned(), lines, columns, statement, remedy: remedy.into() }
    }
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |line: &u64| format!("{}:{line}", self.path.display());
        let places = self.lines.iter().map(place).collect::<Vec<_>>().join(" and ");
        if self.columns.is_empty() {
            return write!(f, "{places}: {}: {}", self.statement, self.remedy);
        }
        let word = if self.columns.len() == 1 { "column" } else { "columns" };
        let columns = self.columns.join("`, `");
        write!(f, "{places}: {word} `{columns}`: {}: {}", self.statement, self.remedy)
    }
}

/// `1 row`, `2 rows`.
pub(super) fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
