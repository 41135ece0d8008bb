//! Figures of stability maps: what was measured as points or solid lines, theory dashed.

use experiments::stability::StabilityMap;

use super::drawing::{Axis, Panel, Pen, Series, Symbol, colour, panels};
use super::{Figure, distinct};

/// One figure of a map, a panel for each quantity.
pub fn of_map(map: &StabilityMap) -> Figure {
    let names = distinct(map.curves.iter().map(|c| c.name.as_str()));
    let panel = |title: &str| {
        let curves = || map.curves.iter().filter(|c| c.panel == title);
        let series = curves().enumerate().map(|(i, curve)| {
            // One entry of the key for all that has one name.
            let is_new = curves().take(i).all(|earlier| earlier.name != curve.name);
            let colour = colour(names.iter().position(|n| *n == curve.name).unwrap_or(0));
            let symbol = match (curve.is_points, curve.is_theory) {
                (true, _) => Symbol::Disc(2.4, colour),
                (false, true) => Symbol::Line(Pen::new(colour, 1.0).dashed()),
                (false, false) => Symbol::Line(Pen::new(colour, 1.6)),
            };
            Series::new(if is_new { &*curve.name } else { "" }, symbol, curve.points.clone())
        });
        Panel {
            title: title.into(),
            x: Axis::linear(&*map.x_axis),
            y: Axis::linear(""),
            series: series.collect(),
            ..Panel::default()
        }
    };
    let titles = distinct(map.curves.iter().map(|c| c.panel.as_str()));
    let list: Vec<Panel> = titles.into_iter().map(panel).collect();
    let title = format!("{}; theory dashed", map.system);
    let picture = panels([&title, ""], 1, [560.0, 330.0], &list);
    Figure::new(format!("stability_{}", map.map.replace('-', "_")), picture)
}
