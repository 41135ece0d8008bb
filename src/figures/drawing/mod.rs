//! Drawing tools of all figures: line charts, and a canvas with axes for what charts cannot show. Only this
//! folder uses kuva.

mod axes;
mod canvas;
mod chart;
mod glyphs;
mod palette;
mod picture;

pub(super) use axes::{Axes, Scale, spread};
pub(super) use canvas::{Anchor, Canvas, Pen, Pixel, Type};
pub(super) use chart::{Curve, Labels, Panel, chart, chart_with_words, panels};
pub(super) use glyphs::missing;
pub(super) use palette::{colour, colour_of};
pub use picture::{FigureError, Picture};
