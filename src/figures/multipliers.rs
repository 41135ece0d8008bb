//! Size of the largest Floquet multiplier over speed: how near every motion of a sweep is to losing its stability,
//! in which way and in which type of motion.

use experiments::sweep::{Sweep, SweepPoint};

use super::drawing::{Pen, Picture, Series, Symbol, chart};

/// Ways in which stability is lost, as points have them, for people and with their colours.
const KINDS: [(&str, &str, &str); 3] = [
    ("fold", "real, positive (fold)", "#000000"),
    ("period_doubling", "real, negative (doubling)", "#009e73"),
    ("neimark_sacker", "complex pair (Neimark–Sacker)", "#0072b2"),
];

/// The multipliers over speed; `None` where no motion has any.
pub(super) fn picture(sweep: &Sweep, title: &str) -> Option<Picture> {
    let points = sweep.points();
    let size = |p: &&SweepPoint| Some((p.state.case.speed_rpm, p.largest_multiplier()?));
    let dots = |name, colour, is_kind: &dyn Fn(&SweepPoint) -> bool| {
        let points = points.iter().filter(|p| is_kind(p));
        // Motions without multipliers stand on the border.
        let place =
            |p: &&SweepPoint| (p.state.case.speed_rpm, p.largest_multiplier().unwrap_or(1.0));
        Series::new(name, Symbol::Disc(3.0, colour), points.map(place))
    };
    let line = Series::new("", Pen::new("#999999", 1.0), points.iter().filter_map(size));
    if line.points.is_empty() {
        return None;
    }
    let mut series = vec![line];
    series.extend(KINDS.map(|(kind, name, colour)| {
        dots(name, colour, &|p| {
            p.attracts.is_shown() && p.largest_multiplier.as_ref().is_some_and(|m| m.kind == kind)
        })
    }));
    series.push(dots("not shown to attract", "#d55e00", &|p| !p.attracts.is_shown()));
    series.retain(|s| !s.points.is_empty());
    let types = points.iter().filter_map(|p| p.largest_multiplier.as_ref()?.mode_type.as_deref());
    let mut names: Vec<&str> = types.collect();
    names.sort_unstable();
    names.dedup();
    let of_types = match names.is_empty() {
        true => String::new(),
        false => format!("; of {} motion", names.join(", ")),
    };
    let caption = format!("{}, size of the largest Floquet multiplier{of_types}", sweep.fidelity);
    let axes = ["speed of the input member, rpm", "|μ|; motions attract below 1"];
    Some(chart([title, &caption], axes, series))
}
