//! What a reader took for granted.

use std::fmt;
use std::path::PathBuf;

/// One thing that was read in another way than it is written; said once for each column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// The file.
    pub path: PathBuf,
    /// First line that it concerns, from 1.
    pub line: u64,
    /// Titles of the columns as written; none of a matrix, or of a file that is no table.
    pub columns: Vec<String>,
    /// What was done.
    pub text: String,
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = format!("{}:{}", self.path.display(), self.line);
        if self.columns.is_empty() {
            return write!(f, "{place}: {}", self.text);
        }
        let columns = if self.columns.len() == 1 { "column" } else { "columns" };
        let titles = self.columns.join("`, `");
        write!(f, "{place}: {columns} `{titles}`: {}", self.text)
    }
}
