//! Error of the fidelities of the ladder against bodies with every degree of freedom, over the number of
//! modes.

use validation::{Ladder, LadderFidelity, Value, Verdict};

use super::drawing::{Axis, Panel, Picture, Series, curve, panels};

/// Two panels over the number of modes: for standing sets the largest difference of a tabled frequency from
/// `full`, one curve per set; for a turning set the differences of a peak's speed and height from `full` at
/// equal steps. `None` unless the verdict has more fidelities than `quasi_static`, as in the full profile.
pub fn fidelities(verdict: &Verdict, ladder: &Ladder) -> Option<Picture> {
    let standing = [(0, "three"), (1, "four")]
        .map(|(i, name)| Series::new(format!("{name} planets"), curve(i), standing(verdict, name)));
    if standing.iter().any(|series| series.points.len() < 2) {
        return None;
    }
    let full = ladder.fidelity.iter().find(|fidelity| fidelity.name == "full")?;
    let of_peak: [fn(&LadderFidelity) -> f64; 2] = [|f| f.peak_rpm, |f| f.peak_rad];
    let turning = vec![
        Series::new("place", curve(0), turning(ladder, full, of_peak[0])),
        Series::new("height", curve(1), turning(ladder, full, of_peak[1])),
    ];
    let panel = |title: &str, y, series| Panel {
        title: title.into(),
        x: Axis::linear("modes of each body, n"),
        y: Axis::log(y),
        series,
        ..Panel::default()
    };
    let list = [
        panel("standing, 1130 N·m", "largest difference of a tabled frequency, %", standing.into()),
        panel("turning, 1413 N·m", "difference of the sun's peak in rotation, l = 2, %", turning),
    ];
    let title = "Modal bodies against full ones (n = 0: quasi-static)";
    Some(panels([title, ""], 2, [400.0, 320.0], &list))
}

fn standing(verdict: &Verdict, name: &str) -> Vec<(f64, f64)> {
    let (prefix, suffix) = ("fe.fidelity.frequency.", format!(".{name}"));
    let point = |check: &validation::Check| {
        let fidelity = check.id.strip_prefix(prefix)?.strip_suffix(&suffix)?;
        match check.actual {
            Some(Value::Number(error)) => Some((modes(fidelity, "modal_", "")?, error)),
            _ => None,
        }
    };
    verdict.checks.iter().filter_map(point).collect()
}

fn turning(
    ladder: &Ladder,
    full: &LadderFidelity,
    of: fn(&LadderFidelity) -> f64,
) -> Vec<(f64, f64)> {
    let settings = |f: &LadderFidelity| (f.steps_per_cycle, f.contact_cells);
    let alike = ladder.fidelity.iter().filter(|f| settings(f) == settings(full));
    let error = |f: &LadderFidelity| 100.0 * (of(f) / of(full) - 1.0).abs();
    alike.filter_map(|f| Some((modes(&f.name, "modal(", ")")?, error(f)))).collect()
}

/// Number of modes that the name of a fidelity stands for.
fn modes(fidelity: &str, before: &str, after: &str) -> Option<f64> {
    match fidelity {
        "quasi_static" | "quasi-static" => Some(0.0),
        _ => fidelity.strip_prefix(before)?.strip_suffix(after)?.parse().ok(),
    }
}
