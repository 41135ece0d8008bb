//! Error over cost of settings, both axes logarithmic; settings than which none is both cheaper and more accurate are
//! ringed and joined.

use super::drawing::{self, Axis, Label, Panel, Pen, Series, Symbol};

/// Edge of settings on the Pareto front, and the names of their rings in the key.
const RING: Pen = Pen::new("#000000", 1.4);
const EFFICIENT: &str = "no setting is both\ncheaper and more accurate";

/// A setting as it is drawn.
pub(super) struct Setting<'s> {
    pub(super) label: String,
    pub(super) group: &'s str,
    /// Lower quartile, median and upper quartile.
    pub(super) cost: [f64; 3],
    /// Percent, above 0.
    pub(super) error: f64,
    /// Whether no setting is both cheaper and more accurate.
    pub(super) is_efficient: bool,
    /// Instead of a disc in the colour of its group.
    pub(super) symbol: Option<Symbol>,
}

/// One panel; `groups` are in the order of their colours, `wanted` is an error in percent.
pub(super) fn panel(
    title: &str,
    cost: &str,
    groups: &[&str],
    settings: &[Setting<'_>],
    wanted: f64,
) -> Panel {
    let place = |s: &Setting<'_>| (s.cost[1], s.error);
    let (front, others): (Vec<_>, Vec<_>) = settings.iter().partition(|s| s.is_efficient);
    let number = |s: &Setting<'_>| groups.iter().position(|g| *g == s.group).unwrap_or(0);
    let colour = |s: &Setting<'_>| drawing::colour(number(s));
    let mut by_cost = front.clone();
    by_cost.sort_by(|a, b| a.cost[1].total_cmp(&b.cost[1]));
    let joined = by_cost.into_iter().map(place);
    let mut series = vec![Series::new("", Pen::new("#6b7075", 1.2).dashed(), joined)];
    series.extend(settings.iter().map(|s| {
        let quartiles = [s.cost[0], s.cost[2]].map(|cost| (cost, s.error));
        Series::new("", Pen::new(colour(s), 1.0), quartiles)
    }));
    series.extend(groups.iter().enumerate().map(|(i, group)| {
        let plain = settings.iter().filter(|s| s.group == *group && s.symbol.is_none());
        Series::new(*group, Symbol::Disc(4.0, drawing::colour(i)), plain.map(place))
    }));
    series.extend(settings.iter().filter_map(|s| Some(Series::new("", s.symbol?, [place(s)]))));
    series.push(Series::new(EFFICIENT, Symbol::Ring(8.0, RING), front.iter().map(|s| place(s))));
    series.push(Series::level("wanted", Pen::new("#b23a48", 1.2).dashed(), wanted));
    // Labels of ringed settings are placed first.
    let labels = front.into_iter().chain(others).map(|s| Label {
        point: place(s),
        text: s.label.clone(),
        colour: colour(s),
    });
    Panel {
        title: title.to_owned(),
        x: Axis::log(cost),
        y: Axis::log("error, %"),
        series,
        labels: labels.collect(),
        ..Panel::default()
    }
}
