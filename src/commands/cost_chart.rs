//! Accuracy against cost.

use super::axes::{Axes, Scale};
use super::canvas::{Anchor, Canvas, Pen, Type};
use super::figure::colour;

/// What one setting costs and how far off it is.
pub(super) struct CostPoint {
    pub(super) name: String,
    /// Settings of one group share a colour.
    pub(super) group: String,
    /// Over the cost of the reference.
    pub(super) cost_ratio: f64,
    /// Error against the reference, percent.
    pub(super) error_percent: f64,
    /// No other is both cheaper and better.
    pub(super) is_efficient: bool,
}

const SIZE: [f64; 2] = [760.0, 460.0];
const CORNER: [f64; 2] = [86.0, 72.0];
const RIGHT: f64 = 190.0;

/// Height of a label and width of a letter, px.
const LINE: f64 = 12.0;
const LETTER: f64 = 6.0;

/// SVG of errors over costs, logarithmic both ways; efficient settings ringed and joined.
pub(super) fn cost_chart(title: &str, caption: &str, points: &[CostPoint]) -> String {
    let [width, height] = [CORNER[0] + SIZE[0] + RIGHT, CORNER[1] + SIZE[1] + 58.0];
    let mut canvas = Canvas::new([width, height]);
    canvas.head(title, caption);
    let axes = Axes {
        x: Scale::log(points.iter().map(|p| p.cost_ratio)),
        y: Scale::log(points.iter().map(|p| p.error_percent)),
        corner: CORNER,
        size: SIZE,
    };
    axes.frame(&mut canvas, [0, 0]);
    axes.x_label(&mut canvas, "cost over that of the reference");
    axes.y_label(&mut canvas, "error, %");
    let at = |p: &CostPoint| axes.at((p.cost_ratio, p.error_percent));
    let mut efficient: Vec<&CostPoint> = points.iter().filter(|p| p.is_efficient).collect();
    efficient.sort_by(|a, b| a.cost_ratio.total_cmp(&b.cost_ratio));
    let grey = Pen::new("#9aa0a6", 1.2).dashed("4 3");
    canvas.line(efficient.iter().map(|p| at(p)), grey);
    let mut groups: Vec<&str> = Vec::new();
    for p in points {
        if !groups.contains(&p.group.as_str()) {
            groups.push(&p.group);
        }
    }
    let of = |p: &CostPoint| colour(groups.iter().position(|g| *g == p.group).unwrap_or(0));
    for p in points {
        canvas.disc(at(p), 4.0, of(p));
        if p.is_efficient {
            canvas.ring(at(p), 8.0, Pen::new("#000000", 1.4));
        }
    }
    let mut taken: Vec<[f64; 4]> = points.iter().map(|p| around(at(p), 5.0)).collect();
    // Those that matter choose their places first.
    let (first, others): (Vec<_>, Vec<_>) = points.iter().partition(|p| p.is_efficient);
    for p in first.into_iter().chain(others) {
        let length = LETTER * p.name.chars().count() as f64;
        let (place, anchor) = free(&axes, at(p), length, &mut taken);
        let kind = Type::new(10, anchor).colour(of(p));
        canvas.text(place, kind, p.name.clone());
    }
    let left = axes.right() + 22.0;
    for (i, group) in groups.iter().enumerate() {
        let y = axes.top() + 14.0 + 20.0 * i as f64;
        canvas.disc([left, y - 4.0], 4.0, colour(i));
        canvas.text([left + 12.0, y], Type::new(12, Anchor::Start), (*group).to_owned());
    }
    let y = axes.top() + 24.0 + 20.0 * groups.len() as f64;
    canvas.ring([left, y - 4.0], 8.0, Pen::new("#000000", 1.4));
    canvas.text([left + 12.0, y], Type::new(12, Anchor::Start), "none is both");
    canvas.text([left + 12.0, y + 15.0], Type::new(12, Anchor::Start), "cheaper and better");
    canvas.svg()
}

/// Square about a point: left, top, right, bottom.
fn around([x, y]: [f64; 2], half: f64) -> [f64; 4] {
    [x - half, y - half, x + half, y + half]
}

/// Place and anchor of a label that covers no other, if there is one.
fn free(
    axes: &Axes,
    [x, y]: [f64; 2],
    length: f64,
    taken: &mut Vec<[f64; 4]>,
) -> ([f64; 2], Anchor) {
    let is_free = |b: &[f64; 4], taken: &[[f64; 4]]| {
        let is_inside = b[0] >= axes.left() && b[2] <= axes.right() && b[1] >= axes.top();
        let meets = |t: &[f64; 4]| b[0] < t[2] && t[0] < b[2] && b[1] < t[3] && t[1] < b[3];
        is_inside && b[3] <= axes.bottom() && !taken.iter().any(meets)
    };
    for down in [4.0, -8.0, 16.0, -20.0, 28.0, -32.0, 40.0, -44.0] {
        for (left, anchor) in [(x + 12.0, Anchor::Start), (x - 12.0 - length, Anchor::End)] {
            let label = [left, y + down - LINE + 2.0, left + length, y + down + 2.0];
            if is_free(&label, taken) {
                taken.push(label);
                let at = if left > x { left } else { x - 12.0 };
                return ([at, y + down], anchor);
            }
        }
    }
    ([x + 12.0, y + 4.0], Anchor::Start)
}
