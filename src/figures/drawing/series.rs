//! Series of points, each drawn with one symbol, and the keys that name them.

use super::canvas::{Anchor, Canvas, Pen, Pixel, Type, text_width};

/// Size of the names in a key, px.
const SIZE: u32 = 12;

/// Height of a line and of the gap between two names of a key, px.
const LINE: f64 = 15.0;
const GAP: f64 = 7.0;

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Symbol {
    /// A line through the points.
    Line(Pen),
    /// A disc at each point: radius in px and colour.
    Disc(f64, &'static str),
    /// A ring at each point: radius in px.
    Ring(f64, Pen),
    /// A line over the whole height of the panel at each x.
    Upright(Pen),
    /// A line over the whole width of the panel at each y.
    Level(Pen),
    /// A fill below each y.
    Below(&'static str),
    /// A fill of one unit of either axis about each point.
    Tile(&'static str),
}

impl From<Pen> for Symbol {
    fn from(pen: Pen) -> Self {
        Self::Line(pen)
    }
}

/// Points drawn with one symbol.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    /// In the key unless empty; a line break begins a new line there.
    pub(crate) name: String,
    pub(crate) symbol: Symbol,
    pub(crate) points: Vec<(f64, f64)>,
}

impl Series {
    pub(crate) fn new(
        name: impl Into<String>,
        symbol: impl Into<Symbol>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let points = points.into_iter().collect();
        Self { name: name.into(), symbol: symbol.into(), points }
    }

    /// Lines over the whole height of a panel.
    pub(crate) fn uprights(
        name: impl Into<String>,
        pen: Pen,
        places: impl IntoIterator<Item = f64>,
    ) -> Self {
        Self::new(name, Symbol::Upright(pen), places.into_iter().map(|x| (x, f64::NAN)))
    }

    /// A line over the whole width of a panel.
    pub(crate) fn level(name: impl Into<String>, pen: Pen, height: f64) -> Self {
        Self::new(name, Symbol::Level(pen), [(f64::NAN, height)])
    }
}

/// Width of a key in a column with its margins, px; 0 without names.
pub(super) fn key_width(key: &[&Series]) -> f64 {
    let widths = key.iter().flat_map(|s| s.name.lines()).map(|line| text_width(line, SIZE));
    widths.fold(0.0, |widest, width| f64::max(widest, width + 56.0))
}

/// Draws the names below one another.
pub(super) fn key_column(canvas: &mut Canvas, key: &[&Series], [left, top]: Pixel) {
    let mut y = top + 10.0;
    for series in key {
        canvas.symbol([left + 26.0, y - 4.0], series.symbol);
        for line in series.name.lines() {
            canvas.text([left + 42.0, y], Type::new(SIZE, Anchor::Start), line);
            y += LINE;
        }
        y += GAP;
    }
}
