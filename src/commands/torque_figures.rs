//! Resonant peaks over torque, and where in a plane of two parameters statements about them hold.

use super::axes::{Axes, Scale, spread};
use super::canvas::{Anchor, Canvas, Pen, Type};
use super::figure::colour;

/// A peak's amplitude under several torques.
pub(super) struct PeakSeries {
    /// Mode, harmonic, body: `rotational 1144 Hz, l = 2, sun rotation`.
    pub(super) name: String,
    /// Drawn dashed.
    pub(super) is_dashed: bool,
    /// Torque (N m), amplitude in any unit.
    pub(super) points: Vec<(f64, f64)>,
}

/// Series of one body (Fig. 13 the sun, Fig. 14 a planet).
pub(super) struct PeakPanel {
    pub(super) title: String,
    pub(super) series: Vec<PeakSeries>,
}

/// Size of a panel's frame and room for names at its right, px.
const PEAKS: [f64; 2] = [430.0, 320.0];
const NAMES: f64 = 250.0;
const LEFT: f64 = 80.0;
const HEAD: f64 = 92.0;
const FOOT: f64 = 56.0;

const PROPORTIONAL: Pen = Pen::new("#9aa0a6", 1.2).dashed("2 3");

/// SVG of peaks over torque, each over its own at its lowest torque.
pub(super) fn torque_peaks(title: &str, caption: &str, panels: &[PeakPanel]) -> String {
    let cell = LEFT + PEAKS[0] + NAMES;
    let mut canvas = Canvas::new([cell * panels.len().max(1) as f64, HEAD + PEAKS[1] + FOOT]);
    canvas.head(title, caption);
    for (i, panel) in panels.iter().enumerate() {
        peaks(&mut canvas, panel, [LEFT + cell * i as f64, HEAD]);
    }
    canvas.svg()
}

/// Points over that at the lowest torque, by torque; empty if that one is nothing.
fn normalised(series: &PeakSeries) -> Vec<(f64, f64)> {
    let mut points = series.points.clone();
    points.retain(|(torque, amplitude)| torque.is_finite() && amplitude.is_finite());
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    match points.first().map(|p| p.1) {
        Some(first) if first > 0.0 => points.into_iter().map(|(t, a)| (t, a / first)).collect(),
        _ => Vec::new(),
    }
}

fn peaks(canvas: &mut Canvas, panel: &PeakPanel, corner: [f64; 2]) {
    let lists: Vec<Vec<(f64, f64)>> = panel.series.iter().map(normalised).collect();
    let all = || lists.iter().flatten();
    let lowest = all().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let highest = all().map(|p| p.0).fold(0.0, f64::max);
    let top = all().map(|p| p.1).fold(1.0, f64::max);
    let axes = Axes {
        x: Scale::linear(0.0, 1.05 * highest),
        y: Scale::linear(0.0, 1.1 * top),
        corner,
        size: PEAKS,
    };
    axes.frame(canvas, [6, 6]);
    axes.title(canvas, &panel.title);
    axes.x_label(canvas, "sun torque, N·m");
    axes.y_label(canvas, "peak over that at the lowest torque");
    let mut names: Vec<(f64, usize)> = Vec::new();
    if highest > lowest {
        // In proportion to torque, up to the upper edge.
        let end = highest.min(lowest * 1.1 * top);
        canvas.line([(lowest, 1.0), (end, end / lowest)].map(|p| axes.at(p)), PROPORTIONAL);
    }
    for (i, (series, points)) in panel.series.iter().zip(&lists).enumerate() {
        let pen = Pen::new(colour(i), 1.6);
        let pen = if series.is_dashed { pen.dashed("7 4") } else { pen };
        canvas.line(points.iter().map(|p| axes.at(*p)), pen);
        for p in points {
            canvas.disc(axes.at(*p), 3.2, colour(i));
        }
        if let Some(last) = points.last() {
            names.push((axes.at(*last)[1], i));
        }
    }
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    let wanted: Vec<f64> = names.iter().map(|n| n.0).collect();
    for ((y, i), place) in names.iter().zip(spread(&wanted, 15.0, axes.bottom() - 24.0)) {
        let end = panel.series[*i].points.iter().map(|p| p.0).fold(0.0, f64::max);
        let from = [axes.at((end, 0.0))[0] + 4.0, *y];
        canvas.line([from, [axes.right() + 8.0, place]], Pen::new(colour(*i), 0.7));
        let kind = Type::new(11, Anchor::Start).colour(colour(*i));
        canvas.text([axes.right() + 11.0, place + 4.0], kind, panel.series[*i].name.clone());
    }
    let y = axes.bottom() - 6.0;
    canvas.line([[axes.right() + 11.0, y - 4.0], [axes.right() + 36.0, y - 4.0]], PROPORTIONAL);
    let grey = Type::new(11, Anchor::Start).colour("#70767c");
    canvas.text([axes.right() + 42.0, y], grey, "in proportion to torque");
}

/// Where one statement holds.
pub(super) struct MapPanel {
    /// The statement.
    pub(super) title: String,
    /// Factors on the mesh compliance, growing.
    pub(super) xs: Vec<f64>,
    /// γ in mesh cycles, growing.
    pub(super) ys: Vec<f64>,
    /// By y, then x; `None`: not known.
    pub(super) cells: Vec<Vec<Option<bool>>>,
    /// A place (x, y) with its name.
    pub(super) marker: Option<(f64, f64, String)>,
}

const HOLDS: &str = "#56b4e9";
const FAILS: &str = "#e69f00";
const UNKNOWN: &str = "#eceeef";

/// Largest side of a map's frame, px; panels beside each other.
const MAP: f64 = 300.0;
const COLUMNS: usize = 3;

/// SVG of maps, a panel for each statement.
pub(super) fn torque_map(title: &str, caption: &str, panels: &[MapPanel]) -> String {
    let columns = COLUMNS.min(panels.len().max(1));
    let rows = panels.len().div_ceil(columns).max(1);
    let cell = [LEFT + MAP + 24.0, 40.0 + MAP + FOOT];
    let width = (cell[0] * columns as f64).max(560.0);
    let mut canvas = Canvas::new([width, 84.0 + cell[1] * rows as f64]);
    canvas.head(title, caption);
    let mut x = 0.5 * width - 165.0;
    for (fill, name) in [(HOLDS, "holds"), (FAILS, "fails"), (UNKNOWN, "not known")] {
        canvas.rectangle([x, 60.0], [16.0, 12.0], fill);
        canvas.text([x + 22.0, 70.0], Type::new(12, Anchor::Start), name);
        x += 110.0;
    }
    for (i, panel) in panels.iter().enumerate() {
        let (column, row) = ((i % columns) as f64, (i / columns) as f64);
        map(&mut canvas, panel, [cell[0] * column + LEFT, 124.0 + cell[1] * row]);
    }
    canvas.svg()
}

fn map(canvas: &mut Canvas, panel: &MapPanel, [left, top]: [f64; 2]) {
    let (nx, ny) = (panel.xs.len().max(1) as f64, panel.ys.len().max(1) as f64);
    let size = [MAP / nx, MAP / ny];
    let kind = Type::new(13, Anchor::Middle);
    canvas.text([left + 0.5 * MAP, top - 10.0], kind, panel.title.clone());
    for (iy, row) in panel.cells.iter().enumerate().take(panel.ys.len()) {
        for (ix, cell) in row.iter().enumerate().take(panel.xs.len()) {
            let corner = [left + size[0] * ix as f64, top + MAP - size[1] * (iy as f64 + 1.0)];
            let fill = match cell {
                Some(true) => HOLDS,
                Some(false) => FAILS,
                None => UNKNOWN,
            };
            let inner = [corner[0] + 0.5, corner[1] + 0.5];
            canvas.rectangle(inner, [size[0] - 1.0, size[1] - 1.0], fill);
        }
    }
    let every = |count: usize, room: f64, label: f64| {
        (count as f64 * label / room).ceil().max(1.0) as usize
    };
    let xs = panel.xs.iter().enumerate().step_by(every(panel.xs.len(), MAP, 34.0));
    for (i, value) in xs {
        let x = left + size[0] * (i as f64 + 0.5);
        canvas.text([x, top + MAP + 16.0], Type::new(11, Anchor::Middle), short(*value));
    }
    let ys = panel.ys.iter().enumerate().step_by(every(panel.ys.len(), MAP, 15.0));
    for (i, value) in ys {
        let y = top + MAP - size[1] * (i as f64 + 0.5) + 4.0;
        canvas.text([left - 6.0, y], Type::new(11, Anchor::End), short(*value));
    }
    let label = Type::new(13, Anchor::Middle);
    canvas.text([left + 0.5 * MAP, top + MAP + 36.0], label, "factor on mesh compliance");
    canvas.text([left - 52.0, top + 0.5 * MAP], label.turned(-90.0), "γ, cycles");
    let Some((x, y, name)) = &panel.marker else { return };
    let (Some(x), Some(y)) = (place(&panel.xs, *x), place(&panel.ys, *y)) else { return };
    let at = [left + size[0] * x, top + MAP - size[1] * y];
    canvas.ring(at, 6.0, Pen::new("#000000", 2.0));
    let is_right = at[0] > left + 0.6 * MAP;
    let (shift, anchor) = if is_right { (-10.0, Anchor::End) } else { (10.0, Anchor::Start) };
    canvas.text([at[0] + shift, at[1] + 4.0], Type::new(12, anchor).bold(), name.clone());
}

/// Without zeros at its end.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Place of a value among growing ones, in cells from the edge of the first; `None` outside.
fn place(values: &[f64], value: f64) -> Option<f64> {
    let edge = |i: usize, j: usize| Some((*values.get(i)? - *values.get(j)?).abs());
    let half = |i: usize, j: usize| 0.5 * edge(i, j).unwrap_or(f64::INFINITY);
    let last = values.len().checked_sub(1)?;
    if value < values[0] - half(1, 0) || value > values[last] + half(last, last.wrapping_sub(1)) {
        return None;
    }
    let after = values.iter().position(|v| *v >= value).unwrap_or(last).max(1).min(last);
    let before = after.saturating_sub(1);
    let step = values[after] - values[before];
    let share = if step > 0.0 { (value - values[before]) / step } else { 0.0 };
    Some(before as f64 + share + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_fall_into_their_cells() {
        let values = [1.0, 2.0, 4.0];
        let found: Vec<Option<f64>> =
            [1.0, 2.0, 3.0, 4.0, 0.4, 5.5].iter().map(|v| place(&values, *v)).collect();
        assert_eq!(found, [Some(0.5), Some(1.5), Some(2.0), Some(2.5), None, None]);
        assert_eq!(place(&[3.0], 3.0), Some(0.5));
        assert_eq!(place(&[], 3.0), None);
        assert_eq!([short(0.25), short(1.0), short(0.1239)], ["0.25", "1", "0.124"]);
    }

    #[test]
    fn peaks_count_from_the_lowest_torque() {
        let of = |points: Vec<(f64, f64)>| {
            normalised(&PeakSeries { name: String::new(), is_dashed: false, points })
        };
        assert_eq!(of(vec![(1130.0, 6.0), (565.0, 2.0)]), [(565.0, 1.0), (1130.0, 3.0)]);
        assert!(of(vec![(565.0, 0.0), (1130.0, 1.0)]).is_empty());
    }
}
