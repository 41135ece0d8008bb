//! Excitation rules.

use std::path::Path;

use super::super::contradiction::Contradiction;
use super::super::repeated::Repeated;
use crate::results::rows::RuleRow;

/// What cannot be true in `rules.csv`.
pub(in crate::results) fn rules(path: &Path, rows: &[RuleRow]) -> Vec<Contradiction> {
    let keyed = rows.iter().map(|row| {
        let kinds = row.excites;
        let numbers = [
            u64::from(kinds.rotational) + 2 * u64::from(kinds.translational),
            u64::from(kinds.planet),
        ];
        (row.line, (row.scene.id.as_str(), row.harmonic), numbers)
    });
    Repeated::of(keyed).contradictions(
        path,
        &["excites"],
        "harmonic of a scene",
        "keep the right row",
    )
}
