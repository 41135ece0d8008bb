//! How far parameters that the paper does not give move the values that are compared with it.
//!
//! The paper does not give tooth thickness, fillets, pin seats and plane state of its finite-element model,
//! so that its values can be expected to agree with ours only within the effects of these. Each parameter has
//! an interval from geometry or design practice; the two ends are computed one parameter at a time
//! (`remake -- parameter_bands`). The effects that lower a value add up to the lower end of its band, those that raise
//! it to the upper end. The printed value does not enter. `kept/parameter_bands.toml` holds the result.

use serde::{Deserialize, Serialize};

use crate::reference_file::{ReferenceError, embedded, parse};

/// A parameter that the paper leaves open, with its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Name by which the effects of every row refer to it.
    pub name: String,
    /// Unit of the three numbers; none where they only name a case.
    pub unit: String,
    /// Lower end.
    pub lower: f64,
    /// Value in the scene.
    pub base: f64,
    /// Upper end.
    pub upper: f64,
    /// Whether it describes gears and carrier, and counts in [`BandRow::band_percent`]; the state in which the
    /// set was struck (position, preload) counts in [`BandRow::band_with_state_percent`] only.
    pub is_body: bool,
    /// Reason for both ends.
    pub reason: String,
}

/// Effect of one parameter on one value over its interval, percent of our value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterEffect {
    /// Name of the interval.
    pub parameter: String,
    /// At its lower end; for the position, the least over the cycle.
    pub at_lower_percent: f64,
    /// At its upper end; for the position, the largest over the cycle.
    pub at_upper_percent: f64,
}

/// One value and its band.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BandRow {
    /// Id of the check.
    pub id: String,
    /// What it is.
    pub what: String,
    /// Unit of our value and the printed one.
    pub unit: String,
    /// Our value.
    pub ours: f64,
    /// Value of the paper, or of the standard's formula on the same gears.
    pub printed: f64,
    /// Half a unit of the last digit of the printed value.
    pub half_digit: f64,
    /// Sums of the effects by sign, parameters of gears and carrier, percent of our value.
    pub band_percent: [f64; 2],
    /// The same with position and preload.
    pub band_with_state_percent: [f64; 2],
    /// Effects of the parameters, in the order of the intervals.
    pub effect: Vec<ParameterEffect>,
}

/// `kept/parameter_bands.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterBands {
    /// Where it comes from.
    pub source: String,
    /// What remakes it.
    pub command: String,
    /// Open parameters.
    pub interval: Vec<Interval>,
    /// Values.
    pub row: Vec<BandRow>,
}

/// Sums of effects by sign: interval arithmetic to first order, one parameter at a time.
pub fn band_of<'e>(effects: impl Iterator<Item = &'e ParameterEffect>) -> [f64; 2] {
    effects.fold([0.0, 0.0], |[low, high], effect| {
        let (a, b) = (effect.at_lower_percent, effect.at_upper_percent);
        [low + a.min(b).min(0.0), high + a.max(b).max(0.0)]
    })
}

/// Whether a printed value lies within a band about our own, the rounding of the print added.
///
/// `false` if the band or a value is not a number.
pub fn is_within(ours: f64, band_percent: [f64; 2], printed: f64, half_digit: f64) -> bool {
    let [low, high] = band_percent.map(|percent| ours * (1.0 + 0.01 * percent));
    low - half_digit <= printed && printed <= high + half_digit
}

impl BandRow {
    /// Whether the printed value lies within the band of the parameters of gears and carrier.
    pub fn holds(&self) -> bool {
        is_within(self.ours, self.band_percent, self.printed, self.half_digit)
    }

    /// Whether it lies within the band of these parameters, position and preload.
    pub fn holds_with_state(&self) -> bool {
        is_within(self.ours, self.band_with_state_percent, self.printed, self.half_digit)
    }

    /// How far the printed value is outside the band, in percent of our value; 0 inside.
    pub fn outside_percent(&self) -> f64 {
        let percent = |x: f64| 100.0 * (x / self.ours - 1.0);
        let above = percent(self.printed - self.half_digit) - self.band_percent[1];
        let below = self.band_percent[0] - percent(self.printed + self.half_digit);
        above.max(below).max(0.0)
    }
}

impl ParameterBands {
    /// As kept in the repository.
    ///
    /// # Errors
    /// If the file does not hold what the code expects.
    pub fn load() -> Result<Self, ReferenceError> {
        parse("kept/parameter_bands.toml", embedded!("kept/parameter_bands.toml"))
    }

    /// The row of a check.
    pub fn row(&self, id: &str) -> Option<&BandRow> {
        self.row.iter().find(|row| row.id == id)
    }

    /// Band of a check, percent of our value: the printed value p of a computed value f is inside if
    /// f(1 + lower/100) − half a digit ≤ p ≤ f(1 + upper/100) + half a digit.
    pub fn band(&self, id: &str) -> Option<[f64; 2]> {
        self.row(id).map(|row| row.band_percent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn effect(at_lower_percent: f64, at_upper_percent: f64) -> ParameterEffect {
        ParameterEffect { parameter: "a".into(), at_lower_percent, at_upper_percent }
    }

    #[test]
    fn effects_add_up_by_sign() {
        // One that goes both ways, one that only lowers, one whose ends both raise.
        let list = [effect(-1.0, 2.0), effect(0.0, -0.5), effect(0.3, 0.1)];
        let [low, high] = band_of(list.iter());
        assert!((low + 1.5).abs() < 1e-15 && (high - 2.3).abs() < 1e-15);
        assert_eq!(band_of([].iter()), [0.0, 0.0]);
    }

    #[test]
    fn the_rounding_of_the_print_counts_and_no_number_is_inside() {
        let band = [-1.0, 2.0];
        for (printed, is_inside) in
            [(990.0, true), (989.5, true), (989.4, false), (1020.5, true), (1020.6, false)]
        {
            assert_eq!(is_within(1000.0, band, printed, 0.5), is_inside, "{printed}");
        }
        assert!(!is_within(f64::NAN, band, 1000.0, 0.5));
        assert!(!is_within(1000.0, [f64::NAN, 2.0], 1000.0, 0.5));
    }

    #[test]
    fn what_is_outside_is_told_by_how_much() {
        let row = |printed| BandRow {
            id: "a".into(),
            what: "a".into(),
            unit: "Hz".into(),
            ours: 1000.0,
            printed,
            half_digit: 0.5,
            effect: Vec::new(),
            band_percent: [-1.0, 2.0],
            band_with_state_percent: [-1.0, 2.0],
        };
        assert_eq!(row(1000.0).outside_percent(), 0.0);
        assert!((row(1030.5).outside_percent() - 1.0).abs() < 1e-12);
        assert!((row(979.5).outside_percent() - 1.0).abs() < 1e-12);
    }

    /// Kept bands are the sums of their kept effects, and every value judged by a band has a row.
    #[test]
    fn kept_bands_are_the_sums_of_their_effects() {
        let kept = ParameterBands::load().unwrap();
        for row in &kept.row {
            let body = |e: &&ParameterEffect| {
                kept.interval.iter().any(|i| i.name == e.parameter && i.is_body)
            };
            let sums = band_of(row.effect.iter().filter(body));
            let all = band_of(row.effect.iter());
            for (kept, made) in [(row.band_percent, sums), (row.band_with_state_percent, all)] {
                for k in 0..2 {
                    // Effects are rounded to 1e-4 %, their sum by less than 1e-3 %.
                    assert!((kept[k] - made[k]).abs() < 1e-3, "{}", row.id);
                }
            }
            assert_eq!(row.effect.len(), kept.interval.len(), "{}", row.id);
        }
        let rows = |start: &str| kept.row.iter().filter(|r| r.id.starts_with(start)).count();
        let found = [
            "table2.fe_contact.",
            "table3.fe_contact.",
            "lumped_from_fe.table2.",
            "lumped_from_fe.table3.",
        ]
        .map(rows);
        assert_eq!(found, [5, 6, 5, 6]);
        assert_eq!([rows("fe.bodies."), rows("fe.iso_6336.")], [6, 2]);
        assert!(kept.band("fe.stiffness.series").is_some() && kept.band("no such row").is_none());
    }
}
