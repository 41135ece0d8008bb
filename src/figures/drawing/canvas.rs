//! A drawing surface: lines, texts and shapes placed in pixels, y downwards.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

use super::picture::Picture;

/// The fonts that kuva's own charts ask for.
const FONTS: &str = "DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif";

/// Place in the picture, px.
pub(crate) type Pixel = [f64; 2];

/// How a line is drawn.
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

    pub(crate) const fn dashed(mut self, dashes: &'static str) -> Self {
        self.dashes = Some(dashes);
        self
    }
}

/// Which point of a text its position refers to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set: size in px, anchor, colour, turn in degrees (clockwise).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Type {
    size: u32,
    anchor: Anchor,
    colour: &'static str,
    turn: Option<f64>,
    is_bold: bool,
}

impl Type {
    pub(crate) const fn new(size: u32, anchor: Anchor) -> Self {
        Self { size, anchor, colour: "#000000", turn: None, is_bold: false }
    }

    pub(crate) const fn colour(mut self, colour: &'static str) -> Self {
        self.colour = colour;
        self
    }

    pub(crate) const fn turned(mut self, degrees: f64) -> Self {
        self.turn = Some(degrees);
        self
    }

    pub(crate) const fn bold(mut self) -> Self {
        self.is_bold = true;
        self
    }
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
        for (i, [x, y]) in points.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(d, "{}{x:.2} {y:.2}", if i == 0 { "M" } else { "L" });
        }
        d.push('Z');
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: Some(Color::from(fill)),
            stroke: Color::from(fill),
            stroke_width: 0.0,
            opacity: Some(opacity),
            stroke_dasharray: None,
        })));
    }

    /// Curves that are not closed, each from a place over a control point to another place (parabolas).
    pub(crate) fn parabolas(&mut self, curves: &[[Pixel; 3]], pen: Pen) {
        let mut d = String::new();
        for [p, c, q] in curves {
            // Writing to a string cannot fail.
            let _ = write!(
                d,
                "M{:.3} {:.3}Q{:.3} {:.3} {:.3} {:.3}",
                p[0], p[1], c[0], c[1], q[0], q[1]
            );
        }
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: None,
            stroke: Color::from(pen.colour),
            stroke_width: pen.width,
            opacity: None,
            stroke_dasharray: pen.dashes.map(Into::into),
        })));
    }

    /// A filled rectangle from a corner.
    pub(crate) fn rectangle(&mut self, corner: Pixel, size: [f64; 2], fill: &'static str) {
        self.scene.add(Primitive::Rect {
            x: corner[0],
            y: corner[1],
            width: size[0],
            height: size[1],
            fill: Color::from(fill),
            stroke: None,
            stroke_width: None,
            opacity: None,
        });
    }

    /// A filled circle.
    pub(crate) fn disc(&mut self, centre: Pixel, radius: f64, fill: &'static str) {
        self.circle(centre, radius, fill, None);
    }

    /// A circle without fill.
    pub(crate) fn ring(&mut self, centre: Pixel, radius: f64, pen: Pen) {
        self.circle(centre, radius, "#ffffff", Some(pen));
    }

    fn circle(&mut self, centre: Pixel, r: f64, fill: &'static str, edge: Option<Pen>) {
        self.scene.add(Primitive::Circle {
            cx: centre[0],
            cy: centre[1],
            r,
            fill: Color::from(fill),
            fill_opacity: edge.map(|_| 0.0),
            stroke: edge.map(|pen| Color::from(pen.colour)),
            stroke_width: edge.map(|pen| pen.width),
        });
    }

    /// A text on its baseline.
    pub(crate) fn text(&mut self, at: Pixel, kind: Type, content: impl Into<String>) {
        self.scene.add(Primitive::Text {
            x: at[0],
            y: at[1],
            content: content.into(),
            size: kind.size,
            anchor: match kind.anchor {
                Anchor::Start => TextAnchor::Start,
                Anchor::Middle => TextAnchor::Middle,
                Anchor::End => TextAnchor::End,
            },
            rotate: kind.turn,
            bold: kind.is_bold,
            color: Some(Color::from(kind.colour)),
        });
    }

    /// Title and the line below it, in the middle of the top edge.
    pub(crate) fn head(&mut self, title: &str, caption: &str) {
        let middle = 0.5 * self.scene.width;
        self.text([middle, 26.0], Type::new(16, Anchor::Middle), title);
        self.text([middle, 46.0], Type::new(12, Anchor::Middle).colour("#444444"), caption);
    }

    pub(crate) fn picture(self) -> Picture {
        Picture::new(self.scene)
    }
}
