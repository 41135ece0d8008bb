//! A drawing surface: lines, areas and texts placed in pixels, y downwards.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene};

use super::picture::Picture;
use super::series::{Series, Symbol, key_column, key_width};

pub(crate) use kuva::render::render::TextAnchor as Anchor;

/// The fonts that kuva's own charts ask for.
const FONTS: &str = "DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif";

/// Place in the picture, px.
pub(crate) type Pixel = [f64; 2];

/// Colour, width (px) and dashes of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pen {
    colour: &'static str,
    width: f64,
    dashes: Option<&'static str>,
}

impl Pen {
    pub(crate) const fn new(colour: &'static str, width: f64) -> Self {
        Self { colour, width, dashes: None }
    }

    pub(crate) const fn dashed(self) -> Self {
        Self { dashes: Some("6 3"), ..self }
    }

    pub(crate) const fn dotted(self) -> Self {
        Self { dashes: Some("2 3"), ..self }
    }
}

/// How a text is set: size in px, anchor, colour, turn in degrees (clockwise).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Type {
    size: u32,
    anchor: Anchor,
    colour: &'static str,
    turn: Option<f64>,
}

impl Type {
    pub(crate) const fn new(size: u32, anchor: Anchor) -> Self {
        Self { size, anchor, colour: "#000000", turn: None }
    }

    pub(crate) const fn colour(self, colour: &'static str) -> Self {
        Self { colour, ..self }
    }

    pub(crate) const fn turned(self, degrees: f64) -> Self {
        Self { turn: Some(degrees), ..self }
    }
}

/// Width of a text, px: that of DejaVu Sans, a wide font, by estimate.
pub(super) fn text_width(text: &str, size: u32) -> f64 {
    0.6 * f64::from(size) * text.chars().count() as f64
}

/// A picture being drawn.
pub(crate) struct Canvas {
    scene: Scene,
}

impl Canvas {
    /// A white canvas of this width and height, px.
    pub(crate) fn new([width, height]: [f64; 2]) -> Self {
        let mut scene = Scene::new(width, height);
        scene.font_family = Some(FONTS.into());
        scene.text_color = Some("black".into());
        Self { scene }
    }

    /// A canvas of `count` cells of equal size (px) in up to `columns` columns, with the upper left corner of each;
    /// above them title and caption, of which either may be empty, and at their right a key.
    pub(crate) fn cells(
        head: [&str; 2],
        key: &[&Series],
        columns: usize,
        count: usize,
        [across, down]: [f64; 2],
    ) -> (Self, Vec<Pixel>) {
        let columns = columns.min(count).max(1);
        let top = 18.0 + 20.0 * head.iter().filter(|line| !line.is_empty()).count() as f64;
        let right = across * columns as f64;
        let height = top + down * count.div_ceil(columns).max(1) as f64;
        let mut canvas = Self::new([right + key_width(key), height]);
        canvas.head(head);
        key_column(&mut canvas, key, [right, top + 34.0]);
        let corner = |i| [across * (i % columns) as f64, top + down * (i / columns) as f64];
        (canvas, (0..count).map(corner).collect())
    }

    /// A line through points.
    pub(crate) fn line(&mut self, points: impl IntoIterator<Item = Pixel>, pen: Pen) {
        self.scene.add(Primitive::PolyLine {
            points: points.into_iter().map(|[x, y]| (x, y)).collect(),
            stroke: Color::from(pen.colour),
            stroke_width: pen.width,
            stroke_dasharray: pen.dashes.map(Into::into),
        });
    }

    /// A filled polygon.
    pub(crate) fn area(&mut self, points: &[Pixel], fill: &'static str, opacity: f64) {
        let mut d = String::new();
        for [x, y] in points {
            // Writing to a string cannot fail.
            let _ = write!(d, "{}{x:.2} {y:.2}", if d.is_empty() { "M" } else { "L" });
        }
        d.push('Z');
        self.path(d, Some((fill, opacity)), Pen::new(fill, 0.0));
    }

    /// Curves that are not closed, each from a place over a control point to another place (parabolas).
    pub(crate) fn parabolas(&mut self, curves: &[[Pixel; 3]], pen: Pen) {
        let mut d = String::new();
        for [p, c, q] in curves {
            let [[a, b], [e, f], [g, h]] = [p, c, q];
            // Writing to a string cannot fail.
            let _ = write!(d, "M{a:.3} {b:.3}Q{e:.3} {f:.3} {g:.3} {h:.3}");
        }
        self.path(d, None, pen);
    }

    fn path(&mut self, d: String, fill: Option<(&str, f64)>, pen: Pen) {
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: fill.map(|(colour, _)| Color::from(colour)),
            stroke: Color::from(pen.colour),
            stroke_width: pen.width,
            opacity: fill.map(|(_, opacity)| opacity),
            stroke_dasharray: pen.dashes.map(Into::into),
        })));
    }

    /// A filled rectangle from a corner.
    pub(crate) fn rectangle(&mut self, [x, y]: Pixel, [w, h]: [f64; 2], fill: &'static str) {
        self.area(&[[x, y], [x + w, y], [x + w, y + h], [x, y + h]], fill, 1.0);
    }

    /// A symbol at a place: a disc or a ring, of the others the sample that stands in a key.
    pub(crate) fn symbol(&mut self, [x, y]: Pixel, symbol: Symbol) {
        let (r, colour, ring) = match symbol {
            Symbol::Disc(r, colour) => (r, colour, None),
            Symbol::Ring(r, pen) => (r, "#ffffff", Some(pen)),
            Symbol::Line(pen) | Symbol::Upright(pen) | Symbol::Level(pen) => {
                return self.line([[x - 9.0, y], [x + 9.0, y]], pen);
            }
            Symbol::Below(fill) | Symbol::Tile(fill) => {
                return self.rectangle([x - 8.0, y - 5.0], [16.0, 10.0], fill);
            }
        };
        self.scene.add(Primitive::Circle {
            cx: x,
            cy: y,
            r,
            fill: Color::from(colour),
            fill_opacity: ring.map(|_| 0.0),
            stroke: ring.map(|pen| Color::from(pen.colour)),
            stroke_width: ring.map(|pen| pen.width),
        });
    }

    /// A text on its baseline.
    pub(crate) fn text(&mut self, at: Pixel, kind: Type, content: impl Into<String>) {
        self.scene.add(Primitive::Text {
            x: at[0],
            y: at[1],
            content: content.into(),
            size: kind.size,
            anchor: kind.anchor,
            rotate: kind.turn,
            bold: false,
            color: Some(Color::from(kind.colour)),
        });
    }

    /// Title and the line below it, in the middle of the top edge and no wider than the picture.
    pub(super) fn head(&mut self, lines: [&str; 2]) {
        let width = self.scene.width;
        for (i, (line, size)) in lines.into_iter().zip([16, 12]).enumerate() {
            let fits = (8..=size).rev().find(|size| text_width(line, *size) < width);
            let kind = Type::new(fits.unwrap_or(8), Anchor::Middle);
            let kind = if i == 0 { kind } else { kind.colour("#444444") };
            if !line.is_empty() {
                self.text([0.5 * width, 26.0 + 20.0 * i as f64], kind, line);
            }
        }
    }

    pub(crate) fn picture(self) -> Picture {
        Picture::new(self.scene)
    }
}
