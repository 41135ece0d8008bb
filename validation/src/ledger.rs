//! The ledger of assumptions: every approximation with the checks that measure its size.

use serde::Deserialize;

use crate::reference_file::{ReferenceError, embedded, parse};

/// `checks/assumptions.toml`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ledger {
    /// Entries in the order they are printed in.
    pub assumption: Vec<Assumption>,
}

/// One approximation.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assumption {
    /// What it is called.
    pub name: String,
    /// What is assumed.
    pub says: String,
    /// Ids of the checks that measure its size; none where it cannot be measured yet.
    pub checks: Vec<String>,
    /// In which range it holds, or what is not known.
    pub holds: String,
}

/// What a check found, as tables print it.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Number found.
    pub actual: f64,
    /// Its unit.
    pub unit: String,
    /// How far it may be off.
    pub tolerance: f64,
}

impl Ledger {
    /// As kept in the repository.
    ///
    /// # Errors
    /// If the file does not hold what the code expects.
    pub fn load() -> Result<Self, ReferenceError> {
        parse("checks/assumptions.toml", embedded!("checks/assumptions.toml"))
    }

    /// The page `docs/assumptions.md` with the figures a verdict has; checks that it does not have are
    /// said to run in the full profile.
    pub fn page(&self, figure: &dyn Fn(&str) -> Option<Figure>) -> String {
        let mut page = String::from(
            "# Assumptions, and how large each is\n\nEvery approximation of model and method, the checks that measure its size on the shipped scenes\n(`epicyclic validate --only ID`), what the kept verdict has, and the range in which it holds. Made from\n`checks/assumptions.toml` and `snapshots/verdict.snap` by\n`cargo run --release -p remake -- assumptions > docs/assumptions.md`.\n",
        );
        for own in &self.assumption {
            page += &format!("\n## {}\n\n{}\n", own.name, own.says);
            if own.checks.is_empty() {
                page += "\nNo check measures it.\n";
            } else {
                page += "\n| check | found | may be |\n|---|---:|---:|\n";
            }
            for id in &own.checks {
                page += &match figure(id) {
                    Some(Figure { actual, unit, tolerance }) => {
                        // Small limits with an exponent: 1e-9 instead of 0.000000001.
                        let limit = if tolerance.abs() < 1e-3 {
                            format!("{tolerance:e}")
                        } else {
                            tolerance.to_string()
                        };
                        format!("| `{id}` | {actual:.2e} {unit} | {limit} {unit} |\n")
                    }
                    None => format!("| `{id}` | full profile | |\n"),
                };
            }
            page += &format!("\nRange: {}\n", own.holds);
        }
        page
    }
}
