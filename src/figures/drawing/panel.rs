//! Panels: series over a pair of axes, in a frame with ticks, titles, labels and a key.

use super::canvas::{Anchor, Canvas, Pen, Pixel, Type, text_width};
use super::labels::{self, Label, around, spread};
use super::picture::Picture;
use super::scale::Scale;
use super::series::{Series, Symbol, key_column, key_width};

const FRAME: Pen = Pen::new("#333333", 1.0);
const GRID: Pen = Pen::new("#e6e8ea", 0.8);

/// Room of a frame at its left, its top, its right and its bottom, px.
const LEFT: f64 = 84.0;
const TOP: f64 = 34.0;
const RIGHT: f64 = 24.0;
const BOTTOM: f64 = 54.0;

/// Size of labels at the edges of a frame, px.
const EDGE: u32 = 11;

/// Frame of a chart, px.
pub(crate) const CHART: [f64; 2] = [600.0, 430.0];

/// What an axis shows.
#[derive(Default)]
pub(crate) struct Axis {
    label: String,
    ends: Option<(f64, f64)>,
    is_log: bool,
    names: Vec<String>,
}

impl Axis {
    /// Around the values of the series.
    pub(crate) fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// Logarithmic, around the positive values of the series.
    pub(crate) fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), is_log: true, ..Self::default() }
    }

    /// A linear axis with these ends.
    pub(crate) fn within(label: impl Into<String>, low: f64, high: f64) -> Self {
        Self { label: label.into(), ends: Some((low, high)), ..Self::default() }
    }

    /// An axis of tiles with their names, the middle of the first at 0.5.
    pub(crate) fn named(label: &str, names: impl Iterator<Item = String>) -> Self {
        let names: Vec<String> = names.collect();
        Self { ends: Some((0.0, names.len() as f64)), names, ..Self::linear(label) }
    }

    fn scale(&self, values: impl Iterator<Item = f64>) -> Scale {
        match self.ends {
            Some((low, high)) => Scale::linear(low, high),
            None if self.is_log => Scale::log(values),
            None => Scale::around(values),
        }
    }

    fn ticks(&self, scale: &Scale, about: f64) -> Vec<(f64, String)> {
        let named = self.names.iter().zip(0..).map(|(name, i)| (f64::from(i) + 0.5, name.clone()));
        if self.names.is_empty() { scale.ticks(about) } else { named.collect() }
    }
}

/// Series over a pair of axes.
#[derive(Default)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Drawn in this order.
    pub(crate) series: Vec<Series>,
    /// Labels on their points.
    pub(crate) on: Vec<Label>,
    /// Labels beside their points, placed in this order.
    pub(crate) labels: Vec<Label>,
    /// Labels of values of x at the upper edge.
    pub(crate) above: Vec<Label>,
    /// Labels of values of y at the right edge.
    pub(crate) beside: Vec<Label>,
}

/// Series over linear axes with these labels, under a title and a caption.
pub(crate) fn chart(head: [&str; 2], [x, y]: [&str; 2], series: Vec<Series>) -> Picture {
    let panel = Panel { x: Axis::linear(x), y: Axis::linear(y), series, ..Panel::default() };
    panels(head, 1, CHART, &[panel])
}

/// Panels in `columns` columns under a title and a caption, with frames of a size in px. The key stands once if all
/// panels have the same.
pub(crate) fn panels(head: [&str; 2], columns: usize, frame: [f64; 2], list: &[Panel]) -> Picture {
    let keys: Vec<Vec<&Series>> = list.iter().map(Panel::key).collect();
    let is_shared = keys.windows(2).all(|pair| {
        let [a, b] = [0, 1].map(|i| pair[i].iter().map(|series| &series.name));
        a.eq(b)
    });
    let widest = keys.iter().map(|key| key_width(key)).fold(0.0, f64::max);
    let beside = list.iter().map(Panel::width_beside).fold(RIGHT, f64::max);
    let right = LEFT + frame[0] + beside;
    let size = [right + if is_shared { 0.0 } else { widest }, TOP + frame[1] + BOTTOM];
    let shared = keys.first().filter(|_| is_shared).map_or(&[][..], |key| key);
    let (mut canvas, corners) = Canvas::cells(head, shared, columns, list.len(), size);
    for ((panel, key), [x, y]) in list.iter().zip(&keys).zip(corners) {
        panel.draw(&mut canvas, [x + LEFT, y + TOP], frame);
        if !is_shared {
            key_column(&mut canvas, key, [x + right, y + TOP]);
        }
    }
    canvas.picture()
}

impl Panel {
    fn key(&self) -> Vec<&Series> {
        self.series.iter().filter(|s| !s.name.is_empty()).collect()
    }

    /// Room that the labels at the right edge need, px.
    fn width_beside(&self) -> f64 {
        self.beside.iter().map(|label| text_width(&label.text, EDGE) + 20.0).fold(0.0, f64::max)
    }

    fn draw(&self, canvas: &mut Canvas, corner: Pixel, size: [f64; 2]) {
        let points = || self.series.iter().flat_map(|s| s.points.iter().copied());
        let about = [size[0] / 75.0, size[1] / 55.0];
        let x = self.x.scale(points().map(|p| p.0));
        let y = self.y.scale(points().map(|p| p.1));
        let [left, top] = corner;
        let axes = Axes { x, y, left, top, right: left + size[0], bottom: top + size[1] };
        for series in self.series.iter().filter(|s| matches!(s.symbol, Symbol::Below(_))) {
            axes.draw(canvas, series);
        }
        axes.frame(canvas, self.x.ticks(&x, about[0]), self.y.ticks(&y, about[1]));
        for series in self.series.iter().filter(|s| !matches!(s.symbol, Symbol::Below(_))) {
            axes.draw(canvas, series);
        }
        let middle = [0.5 * (axes.left + axes.right), 0.5 * (axes.top + axes.bottom)];
        let text = |size| Type::new(size, Anchor::Middle);
        canvas.text([middle[0], top - 10.0], text(14), &*self.title);
        canvas.text([middle[0], axes.bottom + 38.0], text(13), &*self.x.label);
        canvas.text([left - 62.0, middle[1]], text(13).turned(-90.0), &*self.y.label);
        self.draw_labels(canvas, &axes);
    }

    fn draw_labels(&self, canvas: &mut Canvas, axes: &Axes) {
        for label in &self.on {
            let [x, y] = axes.at(label.point);
            canvas.text([x, y + 3.5], Type::new(10, Anchor::Middle), &*label.text);
        }
        let marked = self.series.iter().filter(|s| matches!(s.symbol, Symbol::Disc(..)));
        let marked = marked.flat_map(|s| s.points.iter().map(|p| around(axes.at(*p), 5.0)));
        let mut taken: Vec<_> = marked.collect();
        let frame = [axes.left, axes.top, axes.right, axes.bottom];
        for label in &self.labels {
            let point = axes.at(label.point);
            let (place, anchor) = labels::beside(frame, point, &label.text, &mut taken);
            canvas.text(place, Type::new(labels::SIZE, anchor).colour(label.colour), &*label.text);
        }
        let shown = self.above.iter().filter(|label| axes.x.contains(label.point.0));
        edge_labels(canvas, axes, shown.collect(), 0);
        edge_labels(canvas, axes, self.beside.iter().collect(), 1);
    }
}

/// Labels at the upper edge for `along` = 0, at the right edge for 1, each with a line from its value.
fn edge_labels(canvas: &mut Canvas, axes: &Axes, mut list: Vec<&Label>, along: usize) {
    let place = |label: &Label| axes.at(label.point)[along];
    list.sort_by(|a, b| place(a).total_cmp(&place(b)));
    let wanted: Vec<f64> = list.iter().map(|label| place(label)).collect();
    let (gap, end) = [(32.0, axes.right), (15.0, axes.bottom)][along];
    for ((label, from), to) in list.iter().zip(&wanted).zip(spread(&wanted, gap, end)) {
        let (line, at, anchor) = match along {
            0 => ([[*from, axes.top], [to, axes.top - 7.0]], [to, axes.top - 10.0], Anchor::Middle),
            _ => (
                [[axes.right, *from], [axes.right + 8.0, to]],
                [axes.right + 11.0, to + 4.0],
                Anchor::Start,
            ),
        };
        canvas.line(line, Pen::new(label.colour, 0.7));
        canvas.text(at, Type::new(EDGE, anchor).colour(label.colour), &*label.text);
    }
}

/// A frame with two scales; edges in px.
struct Axes {
    x: Scale,
    y: Scale,
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Axes {
    /// Where a value pair lies.
    fn at(&self, (x, y): (f64, f64)) -> Pixel {
        let (width, height) = (self.right - self.left, self.bottom - self.top);
        [self.left + width * self.x.share(x), self.bottom - height * self.y.share(y)]
    }

    /// Grid, frame and labels of the ticks.
    fn frame(&self, canvas: &mut Canvas, x: Vec<(f64, String)>, y: Vec<(f64, String)>) {
        let &Self { left, top, right, bottom, .. } = self;
        for (value, label) in x {
            let [x, _] = self.at((value, self.y.low));
            canvas.line([[x, top], [x, bottom]], GRID);
            canvas.text([x, bottom + 16.0], Type::new(11, Anchor::Middle), label);
        }
        for (value, label) in y {
            let [_, y] = self.at((self.x.low, value));
            canvas.line([[left, y], [right, y]], GRID);
            canvas.text([left - 6.0, y + 4.0], Type::new(11, Anchor::End), label);
        }
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        canvas.line(corners, FRAME);
    }

    fn draw(&self, canvas: &mut Canvas, series: &Series) {
        let points = || series.points.iter().map(|p| self.at(*p));
        let finite = || points().filter(|p| p[0].is_finite() && p[1].is_finite());
        let &Self { left, top, right, bottom, .. } = self;
        match series.symbol {
            Symbol::Line(pen) => canvas.line(finite(), pen),
            Symbol::Disc(..) | Symbol::Ring(..) => {
                finite().for_each(|p| canvas.symbol(p, series.symbol));
            }
            Symbol::Upright(pen) => {
                let shown = points().filter(|p| (left..=right).contains(&p[0]));
                shown.for_each(|[x, _]| canvas.line([[x, top], [x, bottom]], pen));
            }
            Symbol::Level(pen) => {
                points().for_each(|[_, y]| canvas.line([[left, y], [right, y]], pen));
            }
            Symbol::Below(fill) => points().for_each(|[_, y]| {
                canvas.rectangle([left, y], [right - left, bottom - y], fill);
            }),
            Symbol::Tile(fill) => series.points.iter().for_each(|(x, y)| {
                let [[left, top], [right, bottom]] =
                    [-0.5, 0.5].map(|half| self.at((x + half, y - half)));
                let size = [right - left - 1.0, bottom - top - 1.0];
                canvas.rectangle([left + 0.5, top + 0.5], size, fill);
            }),
        }
    }
}
