//! Line charts, drawn the same way by every verb.

use super::picture::Picture;
use kuva::plot::{LinePlot, LineStyle, MarkerShape, ScatterPlot};
use kuva::render::annotations::ReferenceLine;
use kuva::render::figure::Figure;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

/// One curve, or points that nothing joins.
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) is_dashed: bool,
    /// Radius of the points, px, and their colour.
    dots: Option<(f64, &'static str)>,
}

impl Curve {
    pub(crate) fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, is_dashed: false, dots: None }
    }

    pub(crate) fn dashed(mut self) -> Self {
        self.is_dashed = true;
        self
    }

    /// Points instead of a line.
    pub(crate) fn dots(mut self, size: f64, colour: &'static str) -> Self {
        self.dots = Some((size, colour));
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

/// Curves over one pair of axes, with values of x marked.
pub(crate) struct Panel<'a> {
    pub(crate) labels: Labels<'a>,
    pub(crate) curves: Vec<Curve>,
    pub(crate) marks: Vec<f64>,
    /// Ends of the x axis.
    pub(crate) x_range: Option<(f64, f64)>,
    pub(crate) is_log: bool,
}

/// Colours that stay apart for colour-blind eyes (Okabe & Ito).
const COLOURS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#b8a800"];

/// Colour of curve i of a chart.
pub(crate) fn colour(i: usize) -> &'static str {
    COLOURS[i % COLOURS.len()]
}

/// SVG of curves over one pair of axes.
pub(crate) fn chart(labels: &Labels<'_>, curves: &[Curve]) -> Picture {
    let plots = plots(curves);
    let layout = layout(labels, &plots).with_subtitle(&labels.subtitle).with_subtitle_size(12);
    Picture::new(render_multiple(plots, layout))
}

/// SVG of panels in so many columns under one title.
pub(crate) fn panels(title: &str, columns: usize, size: (f64, f64), list: &[Panel<'_>]) -> Picture {
    let (mut all, mut layouts) = (Vec::new(), Vec::new());
    for panel in list {
        let plots = plots(&panel.curves);
        let mut layout = layout(&panel.labels, &plots).with_title_size(14);
        for x in &panel.marks {
            let line = ReferenceLine::vertical(*x).with_color("#9aa0a6").with_dasharray("3 3");
            layout = layout.with_reference_line(line.with_stroke_width(0.8));
        }
        if let Some((low, high)) = panel.x_range {
            layout = layout.with_x_axis_min(low).with_x_axis_max(high);
        }
        layouts.push(if panel.is_log { layout.with_log_y() } else { layout });
        all.push(plots);
    }
    let figure = Figure::new(list.len().div_ceil(columns), columns)
        .with_title(title)
        .with_title_size(16)
        .with_cell_size(size.0, size.1)
        .with_plots(all)
        .with_layouts(layouts);
    Picture::new(figure.render())
}

fn plots(curves: &[Curve]) -> Vec<Plot> {
    let plot = |(i, curve): (usize, &Curve)| {
        if let Some((size, colour)) = curve.dots {
            let dots = ScatterPlot::new()
                .with_data(curve.points.clone())
                .with_color(colour)
                .with_size(size)
                .with_marker(MarkerShape::Circle);
            let is_named = !curve.name.is_empty();
            return Plot::Scatter(if is_named { dots.with_legend(&curve.name) } else { dots });
        }
        let line = LinePlot::new()
            .with_data(curve.points.clone())
            .with_color(colour(i))
            .with_stroke_width(1.4);
        let line = if curve.is_dashed { line.with_line_style(LineStyle::Dashed) } else { line };
        Plot::Line(if curve.name.is_empty() { line } else { line.with_legend(&curve.name) })
    };
    curves.iter().enumerate().map(plot).collect()
}

fn layout(labels: &Labels<'_>, plots: &[Plot]) -> Layout {
    Layout::auto_from_plots(plots)
        .with_title(labels.title)
        .with_x_label(labels.x)
        .with_y_label(labels.y)
}
