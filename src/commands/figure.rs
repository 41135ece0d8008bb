//! Line charts, drawn the same way by every verb.

use kuva::backend::svg::SvgBackend;
use kuva::plot::{LinePlot, LineStyle};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

/// One curve.
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) is_dashed: bool,
}

impl Curve {
    pub(crate) fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, is_dashed: false }
    }

    pub(crate) fn dashed(mut self) -> Self {
        self.is_dashed = true;
        self
    }
}

/// Title, subtitle and axes of a chart.
pub(crate) struct Labels<'a> {
    pub(crate) title: &'a str,
    pub(crate) subtitle: String,
    pub(crate) x: &'a str,
    pub(crate) y: &'a str,
}

/// Colours that stay apart for colour-blind eyes (Okabe & Ito).
const COLOURS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#b8a800"];

/// SVG of curves over one pair of axes.
pub(crate) fn chart(labels: &Labels<'_>, curves: &[Curve]) -> String {
    let plots: Vec<Plot> = curves
        .iter()
        .enumerate()
        .map(|(i, curve)| {
            let line = LinePlot::new()
                .with_data(curve.points.clone())
                .with_color(COLOURS[i % COLOURS.len()])
                .with_stroke_width(1.4);
            let line = if curve.is_dashed { line.with_line_style(LineStyle::Dashed) } else { line };
            Plot::Line(if curve.name.is_empty() { line } else { line.with_legend(&curve.name) })
        })
        .collect();
    let layout = Layout::auto_from_plots(&plots)
        .with_title(labels.title)
        .with_subtitle(&labels.subtitle)
        .with_subtitle_size(12)
        .with_x_label(labels.x)
        .with_y_label(labels.y);
    SvgBackend.render_scene(&render_multiple(plots, layout))
}
