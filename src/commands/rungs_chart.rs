//! Error of the rungs of the ladder against bodies with every degree of freedom.

use validation::{Value, Verdict};

use super::figure::{Curve, Labels, chart};
use super::picture::Picture;

/// Largest difference of a tabled frequency to `full` over the number of modes, one curve a set; `None`
/// unless a verdict holds more than the quasi-static rung, as the full profile's does.
pub(crate) fn rungs_chart(verdict: &Verdict) -> Option<Picture> {
    let curve = |name: &str| {
        let prefix = "fe.rungs.frequency.";
        let suffix = format!(".{name}");
        let points: Vec<(f64, f64)> = verdict
            .checks
            .iter()
            .filter_map(|check| {
                let rung = check.id.strip_prefix(prefix)?.strip_suffix(&suffix)?;
                let modes = match rung.strip_prefix("modal_") {
                    Some(n) => n.parse().ok()?,
                    None => 0.0,
                };
                match check.actual {
                    Some(Value::Number(error)) => Some((modes, error)),
                    _ => None,
                }
            })
            .collect();
        Curve::new(format!("{name} planets"), points)
    };
    let curves = ["three", "four"].map(curve);
    if curves.iter().any(|c| c.points.len() < 2) {
        return None;
    }
    let labels = Labels {
        title: "Natural frequencies of the rungs against full bodies",
        subtitle: "impulse tests at 1130 N·m, position 0; n = 0 is the quasi-static rung".into(),
        x: "modes of each body, n",
        y: "largest difference of a tabled mode, %",
    };
    Some(chart(&labels, &curves))
}
