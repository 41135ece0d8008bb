//! Error of the rungs of the ladder against bodies with every degree of freedom, over the number of modes.

use validation::{Ladder, LadderRung, Value, Verdict};

use super::figure::{Curve, Labels, Panel, panels};
use super::picture::Picture;

/// Standing, largest difference of a tabled frequency to `full`, one curve a set; turning, place and
/// height of a peak to `full` at as many steps. `None` unless a verdict holds more than the quasi-static
/// rung, as the full profile's does.
pub(crate) fn rungs_chart(verdict: &Verdict, ladder: &Ladder) -> Option<Picture> {
    let standing = ["three", "four"].map(|name| of_verdict(verdict, name));
    if standing.iter().any(|c| c.points.len() < 2) {
        return None;
    }
    let full = ladder.rung.iter().find(|rung| rung.name == "full")?;
    let turning = vec![
        of_ladder(ladder, full, "place", |rung| rung.peak_rpm),
        of_ladder(ladder, full, "height", |rung| rung.peak_rad),
    ];
    let panel = |title, y, curves| Panel {
        labels: Labels { title, subtitle: String::new(), x: "modes of each body, n", y },
        curves,
        marks: Vec::new(),
        x_range: None,
        is_log: true,
    };
    let list = [
        panel("standing, 1130 N·m", "largest difference of a tabled frequency, %", standing.into()),
        panel("turning, 1413 N·m", "difference of the sun's peak in rotation, l = 2, %", turning),
    ];
    let title = "Modal bodies against full ones (n = 0: quasi-static)";
    Some(panels(title, 2, (560.0, 420.0), &list))
}

fn of_verdict(verdict: &Verdict, name: &str) -> Curve {
    let (prefix, suffix) = ("fe.rungs.frequency.", format!(".{name}"));
    let point = |check: &validation::Check| {
        let rung = check.id.strip_prefix(prefix)?.strip_suffix(&suffix)?;
        match check.actual {
            Some(Value::Number(error)) => Some((modes(rung, "modal_", "")?, error)),
            _ => None,
        }
    };
    let points = verdict.checks.iter().filter_map(point).collect();
    Curve::new(format!("{name} planets"), points)
}

fn of_ladder(
    ladder: &Ladder,
    full: &LadderRung,
    name: &str,
    of: impl Fn(&LadderRung) -> f64,
) -> Curve {
    let alike = |rung: &&LadderRung| {
        (rung.steps_per_cycle, rung.contact_cells) == (full.steps_per_cycle, full.contact_cells)
    };
    let point = |rung: &LadderRung| {
        let error = 100.0 * (of(rung) / of(full) - 1.0).abs();
        Some((modes(&rung.name, "modal(", ")")?, error))
    };
    Curve::new(name, ladder.rung.iter().filter(alike).filter_map(point).collect())
}

/// Number of modes behind the name of a rung.
fn modes(rung: &str, before: &str, after: &str) -> Option<f64> {
    match rung {
        "quasi_static" | "quasi-static" => Some(0.0),
        _ => rung.strip_prefix(before)?.strip_suffix(after)?.parse().ok(),
    }
}
