//! One drawing layer for all figures: panels of series over scaled axes, their keys and labels, and the canvas beneath
//! for what a panel cannot show. Only this folder uses kuva.

mod canvas;
mod glyphs;
mod labels;
mod palette;
mod panel;
mod picture;
mod scale;
mod series;

pub(super) use canvas::{Anchor, Canvas, Pen, Pixel, Type};
pub(super) use glyphs::missing;
pub(super) use labels::{Label, spread};
pub(super) use palette::{FOUND, colour, colour_of, curve};
pub(super) use panel::{Axis, CHART, Panel, chart, panels};
pub use picture::{FigureError, Picture};
pub(super) use scale::Scale;
pub(super) use series::{Series, Symbol};
