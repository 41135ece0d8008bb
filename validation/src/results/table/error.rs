//! Why a table cannot be read, and what to do about it.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The first fault of a table.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// A file that is not there, is too long or is no UTF-8 text.
    #[error("{}: cannot be read: {source}: save it as a CSV file in UTF-8", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        #[source]
        source: std::io::Error,
    },
    /// A line that is no CSV.
    #[error("{}:{line}: is no CSV: {source}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: u64,
        /// What the reader said.
        #[source]
        source: csv::Error,
    },
    /// A file without rows.
    #[error("{}: no rows: a line of titles (`{titles}`) and at least one row are needed, or leave the file out", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// Titles of the columns that must be there.
        titles: String,
    },
    /// A column that must be there and is not.
    #[error("{}:{line}: column `{column}` is absent: {remedy}", path.display())]
    Absent {
        /// The file.
        path: PathBuf,
        /// Line of the titles, from 1.
        line: u64,
        /// The column.
        column: &'static str,
        /// What to do.
        remedy: String,
    },
    /// Two columns that mean the same.
    #[error("{}:{line}: columns `{first}` and `{second}` are both `{column}`: keep one", path.display())]
    Twice {
        /// The file.
        path: PathBuf,
        /// Line of the titles, from 1.
        line: u64,
        /// Title of one.
        first: String,
        /// Title of the other.
        second: String,
        /// The column that both are.
        column: Cow<'static, str>,
    },
    /// A row with more cells than there are titles.
    #[error("{}:{line}: {cells} cells under {titles} titles, the last is column `{last}`: {remedy}", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: u64,
        /// Number of cells.
        cells: usize,
        /// Number of titles.
        titles: usize,
        /// The last title.
        last: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A cell that must be filled and is empty.
    #[error("{}:{line}: column `{column}` is empty: needed is {needed}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: u64,
        /// Title of the column as written.
        column: String,
        /// What is to stand there.
        needed: String,
    },
    /// A cell that does not fit its column.
    #[error("{}:{line}: column `{column}` is `{value}`: allowed is {allowed}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line from 1.
        line: u64,
        /// Title of the column as written.
        column: String,
        /// What stands there.
        value: String,
        /// What may stand there.
        allowed: String,
    },
}

impl TableError {
    /// A cell refused.
    pub(super) fn value(path: &Path, line: u64, column: &str, value: &str, allowed: &str) -> Self {
        if value.is_empty() {
            let (path, column, needed) = (path.to_owned(), column.to_owned(), allowed.to_owned());
            return Self::Missing { path, line, column, needed };
        }
        let shown: String =
            value.chars().take(60).map(|c| if c.is_control() { '?' } else { c }).collect();
        Self::Value {
            path: path.to_owned(),
            line,
            column: column.to_owned(),
            value: shown,
            allowed: allowed.to_owned(),
        }
    }
}
