//! Rows that say something twice, the same or something else.

use std::collections::HashMap;
use std::hash::Hash;
use std::path::Path;

use super::contradiction::{Contradiction, counted};

/// Repeated rows of a table.
pub(super) struct Repeated {
    /// Lines of the first pair with different numbers, and how many such pairs there are.
    different: Option<([u64; 2], usize)>,
    /// The same of equal numbers.
    equal: Option<([u64; 2], usize)>,
    rows: usize,
}

impl Repeated {
    /// Finds rows of one key.
    pub(super) fn of<K: Hash + Eq>(rows: impl Iterator<Item = (u64, K, [u64; 2])>) -> Self {
        let mut first: HashMap<K, (u64, [u64; 2])> = HashMap::new();
        let mut found = Self { different: None, equal: None, rows: 0 };
        for (line, key, numbers) in rows {
            found.rows += 1;
            let (before, same) = *first.entry(key).or_insert((line, numbers));
            if before == line {
                continue;
            }
            let list = if same == numbers { &mut found.equal } else { &mut found.different };
            list.get_or_insert(([before, line], 0)).1 += 1;
        }
        found
    }

    /// Whether any row says otherwise than another.
    pub(super) fn differs(&self) -> bool {
        self.different.is_some()
    }

    /// As contradictions; `key` says which columns make two rows the same.
    pub(super) fn contradictions(&self, path: &Path, key: &str) -> Vec<Contradiction> {
        let mut list = Vec::new();
        if let Some((lines, count)) = self.different {
            let statement =
                format!("different numbers for one {key} ({})", counted(count, "such pair"));
            let remedy = match key.starts_with("speed") {
                true => "keep the right row, or tell sweeps apart by a column `chain`",
                false => "keep the right row",
            };
            list.push(Contradiction::new(path, lines, statement, remedy));
        }
        if let Some((lines, count)) = self.equal {
            let statement = format!("one row twice ({count} of {} rows)", self.rows);
            list.push(Contradiction::new(path, lines, statement, "write every row once"));
        }
        list
    }
}
