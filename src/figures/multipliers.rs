//! Size of the largest Floquet multiplier over speed: how near every motion of a sweep is to losing its stability,
//! in which way and in which type of motion.

use experiments::sweep::{Sweep, SweepPoint};

use super::drawing::{Curve, Labels, Picture, chart};

/// Ways in which stability is lost, as points have them, for people and with their colours.
const KINDS: [(&str, &str, &str); 3] = [
    ("fold", "real, positive (fold)", "#000000"),
    ("period_doubling", "real, negative (doubling)", "#009e73"),
    ("neimark_sacker", "complex pair (Neimark–Sacker)", "#0072b2"),
];

/// Colour of motions that were not shown to attract.
const NOT_SHOWN: &str = "#d55e00";

/// The multipliers over speed; `None` where no motion has any.
pub(super) fn picture(sweep: &Sweep, title: &str) -> Option<Picture> {
    let points = sweep.points();
    let size = |p: &&SweepPoint| Some((p.state.case.speed_rpm, p.largest_multiplier()?));
    let mut curves = vec![Curve::new("", points.iter().filter_map(size).collect()).thin("#999999")];
    if curves[0].points.is_empty() {
        return None;
    }
    for (kind, name, colour) in KINDS {
        let is_kind = |p: &&&SweepPoint| {
            p.attracts.is_shown() && p.largest_multiplier.as_ref().is_some_and(|m| m.kind == kind)
        };
        curves.extend(dots(name, points.iter().filter(is_kind).filter_map(size), colour));
    }
    let not_shown = points.iter().filter(|p| !p.attracts.is_shown()).map(|p| {
        // Motions without multipliers stand on the border.
        (p.state.case.speed_rpm, p.largest_multiplier().unwrap_or(1.0))
    });
    curves.extend(dots("not shown to attract", not_shown, NOT_SHOWN));
    let types = points.iter().filter_map(|p| p.largest_multiplier.as_ref()?.mode_type.as_deref());
    let mut names: Vec<&str> = types.collect();
    names.sort_unstable();
    names.dedup();
    let of_types = match names.is_empty() {
        true => String::new(),
        false => format!("; of {} motion", names.join(", ")),
    };
    let labels = Labels {
        title,
        subtitle: format!("{}, size of the largest Floquet multiplier{of_types}", sweep.fidelity),
        x: "speed of the input member, rpm",
        y: "|μ|; motions attract below 1",
    };
    Some(chart(&labels, &curves))
}

fn dots(
    name: &str,
    points: impl Iterator<Item = (f64, f64)>,
    colour: &'static str,
) -> Option<Curve> {
    let points: Vec<(f64, f64)> = points.collect();
    (!points.is_empty()).then(|| Curve::new(name, points).dots(3.0, colour))
}
