//! Figures of stability maps: what was measured as points or solid lines, theory dashed.

use experiments::stability::{MapCurve, StabilityMap};

use super::Figure;
use super::drawing::{Curve, Labels, Panel, colour, panels};

/// Cell of one panel, px.
const CELL: (f64, f64) = (760.0, 420.0);

/// One figure of a map, a panel for each quantity.
pub fn of_map(map: &StabilityMap) -> Figure {
    let (names, titles) = (distinct(map, |c| &c.name), distinct(map, |c| &c.panel));
    let mut list = Vec::new();
    for title in titles {
        let mut named: Vec<&str> = Vec::new();
        let mut curves = Vec::new();
        for curve in map.curves.iter().filter(|c| c.panel == title) {
            let place = names.iter().position(|n| *n == curve.name).unwrap_or(0);
            // One entry of the legend for all that has one name.
            let is_new = !named.contains(&curve.name.as_str());
            named.push(&curve.name);
            let name = if is_new { curve.name.clone() } else { String::new() };
            let drawn = Curve::new(name, curve.points.clone());
            curves.push(match (curve.is_points, curve.is_theory) {
                (true, _) => drawn.dots(2.4, colour(place)),
                (false, true) => drawn.thin(colour(place)).dashed(),
                (false, false) => drawn.thin(colour(place)).wide(1.6),
            });
        }
        list.push(Panel {
            labels: Labels { title, subtitle: String::new(), x: &map.x_axis, y: "" },
            curves,
            marks: Vec::new(),
            x_range: None,
            is_log: false,
        });
    }
    let title = format!("{}; theory dashed", map.system);
    Figure::new(format!("stability_{}", map.map.replace('-', "_")), panels(&title, 1, CELL, &list))
}

/// The distinct values of a name of the curves, in order.
fn distinct<'m>(map: &'m StabilityMap, of: impl Fn(&'m MapCurve) -> &'m str) -> Vec<&'m str> {
    let mut found: Vec<&str> = Vec::new();
    for curve in &map.curves {
        if !found.contains(&of(curve)) {
            found.push(of(curve));
        }
    }
    found
}
