//! Error of the fidelities of the ladder against bodies with every degree of freedom, over the number of
//! modes.

use validation::{Ladder, LadderFidelity, Value, Verdict};

use super::drawing::{Curve, Labels, Panel, Picture, panels};

/// Two panels over the number of modes: for standing sets the largest difference of a tabled frequency from
/// `full`, one curve per set; for a turning set the differences of a peak's speed and height from `full` at
/// equal steps. `None` unless the verdict has more fidelities than `quasi_static`, as in the full profile.
pub fn fidelities(verdict: &Verdict, ladder: &Ladder) -> Option<Picture> {
    let standing = ["three", "four"].map(|name| of_verdict(verdict, name));
    if standing.iter().any(|c| c.points.len() < 2) {
        return None;
    }
    let full = ladder.fidelity.iter().find(|fidelity| fidelity.name == "full")?;
    let turning = vec![
        of_ladder(ladder, full, "place", |fidelity| fidelity.peak_rpm),
        of_ladder(ladder, full, "height", |fidelity| fidelity.peak_rad),
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
    let (prefix, suffix) = ("fe.fidelity.frequency.", format!(".{name}"));
    let point = |check: &validation::Check| {
        let fidelity = check.id.strip_prefix(prefix)?.strip_suffix(&suffix)?;
        match check.actual {
            Some(Value::Number(error)) => Some((modes(fidelity, "modal_", "")?, error)),
            _ => None,
        }
    };
    let points = verdict.checks.iter().filter_map(point).collect();
    Curve::new(format!("{name} planets"), points)
}

fn of_ladder(
    ladder: &Ladder,
    full: &LadderFidelity,
    name: &str,
    of: impl Fn(&LadderFidelity) -> f64,
) -> Curve {
    let alike = |fidelity: &&LadderFidelity| {
        (fidelity.steps_per_cycle, fidelity.contact_cells)
            == (full.steps_per_cycle, full.contact_cells)
    };
    let point = |fidelity: &LadderFidelity| {
        let error = 100.0 * (of(fidelity) / of(full) - 1.0).abs();
        Some((modes(&fidelity.name, "modal(", ")")?, error))
    };
    Curve::new(name, ladder.fidelity.iter().filter(alike).filter_map(point).collect())
}

/// Number of modes that the name of a fidelity stands for.
fn modes(fidelity: &str, before: &str, after: &str) -> Option<f64> {
    match fidelity {
        "quasi_static" | "quasi-static" => Some(0.0),
        _ => fidelity.strip_prefix(before)?.strip_suffix(after)?.parse().ok(),
    }
}
