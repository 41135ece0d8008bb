//! What moved between two runs of one program.

use std::collections::HashMap;

use serde::Serialize;

use super::row::Row;
use super::score::correct_digits;
use super::table::CertifiedValues;

/// Difference in parts of a value that is no drift: another compiler's rounding.
const ROUNDING: f64 = 1e-9;

/// A value that moved.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Moved {
    /// Its id.
    pub id: String,
    /// Value in the baseline.
    pub baseline: f64,
    /// Value now.
    pub now: f64,
    /// Unit of both.
    pub unit: String,
    /// Digits that baseline and value have in common.
    pub common_digits: f64,
    /// Correct digits of the baseline, if the data set has the value.
    pub digits_before: Option<f64>,
    /// The same now.
    pub digits_now: Option<f64>,
}

impl Moved {
    /// `towards the certified value`, `away from it`, or nothing where the data set does not have it.
    pub fn direction(&self) -> &'static str {
        match self.digits_before.zip(self.digits_now) {
            Some((before, now)) if now > before => "towards the data set",
            Some((before, now)) if now < before => "away from the data set",
            Some(_) => "as far from the data set",
            None => "",
        }
    }
}

/// How results differ from their baseline.
#[derive(Debug, Clone, Default, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Drift {
    /// Number of values that both have.
    pub compared: usize,
    /// Those that moved, the furthest first.
    pub moved: Vec<Moved>,
    /// Ids of values that only the baseline has.
    pub missing: Vec<String>,
    /// Ids of values that only the results have.
    pub added: Vec<String>,
}

impl Drift {
    /// Compares results with their baseline. A value moved if it differs by more than 10⁻⁹ of it and, where the data
    /// set has it, by more than a hundredth of its uncertainty.
    pub fn between(baseline: &[Row], now: &[Row]) -> Self {
        let values = CertifiedValues::shipped();
        let found: HashMap<&str, &Row> = now.iter().map(|row| (row.id.as_str(), row)).collect();
        let mut drift = Self::default();
        for old in baseline {
            let Some(new) = found.get(old.id.as_str()) else {
                drift.missing.push(old.id.clone());
                continue;
            };
            drift.compared += 1;
            let kept = values.row(&old.id);
            let largest = kept.map_or(0.0, |kept| values.largest(kept));
            let allowed = (ROUNDING * old.value.abs().max(1e-3 * largest))
                .max(kept.map_or(0.0, |kept| 0.01 * kept.uncertainty));
            let difference = (new.value - old.value).abs();
            if difference <= allowed {
                continue;
            }
            let digits = |value: f64| {
                kept.map(|kept| correct_digits(value, kept.value, kept.uncertainty, largest))
            };
            drift.moved.push(Moved {
                id: old.id.clone(),
                baseline: old.value,
                now: new.value,
                unit: old.unit.clone(),
                common_digits: correct_digits(new.value, old.value, 0.0, largest),
                digits_before: digits(old.value),
                digits_now: digits(new.value),
            });
        }
        let known: HashMap<&str, ()> = baseline.iter().map(|row| (row.id.as_str(), ())).collect();
        let added = now.iter().filter(|row| !known.contains_key(row.id.as_str()));
        drift.added = added.map(|row| row.id.clone()).collect();
        drift.moved.sort_by(|a, b| a.common_digits.total_cmp(&b.common_digits));
        drift
    }

    /// Whether nothing moved, is missing or is new.
    pub fn is_none(&self) -> bool {
        self.moved.is_empty() && self.missing.is_empty() && self.added.is_empty()
    }
}
