//! The unit that a list of frequencies likely is in where, read as Hz, few of them are those of a model.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::Serialize;

use crate::compare::{Comparison, ListedMode, ModelMode, held_against, rigid_body_hz};

/// Units, with the ends of the titles of columns in them, and Hz in one of them.
const UNITS: [(&str, &str, f64); 3] =
    [("kHz", "khz", 1e3), ("rad/s", "rad_per_s", 1.0 / TAU), ("1/min", "rpm", 1.0 / 60.0)];

/// Lines by which the agreement in another unit must be the larger one: a single one may be chance.
const FEWEST_MORE: usize = 2;

/// A unit other than Hz in which a list agrees with the model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LikelyUnit {
    /// The unit: kHz, rad/s or 1/min.
    pub unit: String,
    /// Title of a column of frequencies in it.
    pub column: String,
    /// Lines that would agree in it, rigid-body motion aside.
    pub agreed: usize,
    /// Lines that there would be, without rigid-body motion and modes above the list's highest.
    pub lines: usize,
}

impl LikelyUnit {
    /// The unit in which at least half of the lines agree, where fewer do in Hz and at least two less.
    pub(crate) fn of(
        listed: &[ListedMode],
        model: &[ModelMode],
        in_hz: &Comparison,
        is_whole: bool,
    ) -> Option<Self> {
        let rigid_hz = rigid_body_hz(model);
        let (now, _) = elastic(in_hz, rigid_hz);
        let unit = |(unit, title, hz): (&str, &str, f64)| {
            let read = |mode: &ListedMode| ListedMode {
                frequency_hz: hz * mode.frequency_hz,
                ..mode.clone()
            };
            let list: Vec<ListedMode> = listed.iter().map(read).collect();
            let found = held_against(&list, model, in_hz.tolerance_percent, is_whole);
            let (agreed, lines) = elastic(&found, rigid_hz);
            let column = format!("frequency_{title}");
            Self { unit: unit.to_owned(), column, agreed, lines }
        };
        let is_likely = |other: &Self| {
            2 * now < other.lines
                && 2 * other.agreed >= other.lines
                && other.agreed >= now + FEWEST_MORE
        };
        UNITS.into_iter().map(unit).filter(is_likely).max_by_key(|other| other.agreed)
    }
}

/// Lines that agree and all lines, without rigid-body motion and modes above the list's highest.
fn elastic(found: &Comparison, rigid_hz: f64) -> (usize, usize) {
    let is_elastic = |hz: Option<f64>| hz.is_none_or(|hz| hz > rigid_hz);
    let lines = found.matches.iter().filter(|m| !m.is_beyond_list && is_elastic(m.model_hz));
    (lines.clone().filter(|m| m.agrees).count(), lines.count())
}
