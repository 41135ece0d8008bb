//! Line charts, drawn the same way by every verb.

use std::sync::Arc;

use kuva::plot::{LinePlot, LineStyle, MarkerShape, ScatterPlot};
use kuva::render::annotations::{ReferenceLine, TextAnnotation};
use kuva::render::figure::Figure;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use super::palette::colour;
use super::picture::Picture;

/// One curve, or unconnected points.
pub(crate) struct Curve {
    name: String,
    pub(crate) points: Vec<(f64, f64)>,
    is_dashed: bool,
    /// Width of the line, px.
    width: f64,
    /// If `None`, the palette's colour for the curve's index.
    colour: Option<&'static str>,
    /// Radius of points instead of a line, px.
    dots: Option<f64>,
}

impl Curve {
    /// Without an entry in the legend if its name is empty.
    pub(crate) fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        let name = name.into();
        Self { name, points, is_dashed: false, width: 1.4, colour: None, dots: None }
    }

    pub(crate) fn dashed(mut self) -> Self {
        self.is_dashed = true;
        self
    }

    /// A line of a width, px.
    pub(crate) fn wide(mut self, width: f64) -> Self {
        self.width = width;
        self
    }

    /// A thin line of a colour.
    pub(crate) fn thin(mut self, colour: &'static str) -> Self {
        (self.width, self.colour) = (1.0, Some(colour));
        self
    }

    /// Points instead of a line.
    pub(crate) fn dots(mut self, size: f64, colour: &'static str) -> Self {
        (self.dots, self.colour) = (Some(size), Some(colour));
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

/// Curves over one pair of axes.
pub(crate) fn chart(labels: &Labels<'_>, curves: &[Curve]) -> Picture {
    chart_with_words(labels, curves, &[])
}

/// The same with words at points of the plane.
pub(crate) fn chart_with_words(
    labels: &Labels<'_>,
    curves: &[Curve],
    words: &[(String, f64, f64)],
) -> Picture {
    let plots = plots(curves);
    let mut layout = layout(labels, &plots).with_subtitle(&labels.subtitle).with_subtitle_size(12);
    for (text, x, y) in words {
        let words = TextAnnotation::new(text, *x, *y).with_color("#5f6368").with_font_size(11);
        layout = layout.with_annotation(words);
    }
    Picture::new(render_multiple(plots, layout))
}

/// Every label of a logarithmic axis in the one form that suits all.
fn power_of_ten(value: f64) -> String {
    let exponent = value.abs().log10();
    if (exponent - exponent.round()).abs() < 1e-8 {
        return format!("1e{}", exponent.round() as i32);
    }
    format!("{value:.0e}")
}

/// Panels in `columns` columns under one title.
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
        layouts.push(if panel.is_log {
            layout.with_log_y().with_y_tick_format(TickFormat::Custom(Arc::new(power_of_ten)))
        } else {
            layout
        });
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
        let (is_named, colour) = (!curve.name.is_empty(), curve.colour.unwrap_or(colour(i)));
        if let Some(size) = curve.dots {
            let dots = ScatterPlot::new()
                .with_data(curve.points.clone())
                .with_color(colour)
                .with_size(size)
                .with_marker(MarkerShape::Circle);
            return Plot::Scatter(if is_named { dots.with_legend(&curve.name) } else { dots });
        }
        let line = LinePlot::new()
            .with_data(curve.points.clone())
            .with_color(colour)
            .with_stroke_width(curve.width);
        let line = if curve.is_dashed { line.with_line_style(LineStyle::Dashed) } else { line };
        Plot::Line(if is_named { line.with_legend(&curve.name) } else { line })
    };
    curves.iter().enumerate().map(plot).collect()
}

fn layout(labels: &Labels<'_>, plots: &[Plot]) -> Layout {
    Layout::auto_from_plots(plots)
        .with_title(labels.title)
        .with_x_label(labels.x)
        .with_y_label(labels.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words of a text element behind its opening `<text`.
    fn words(part: &str) -> Option<&str> {
        let (_, rest) = part.split_once('>')?;
        rest.split_once('<').map(|(words, _)| words.trim())
    }

    /// Texts of an SVG file, in its order.
    fn texts(svg: &str) -> Vec<&str> {
        svg.split("<text").skip(1).filter_map(words).filter(|words| !words.is_empty()).collect()
    }

    /// Powers of ten beside plain numbers (`1e-1`, `1`, `10`) would be read as different axes.
    #[test]
    fn labels_of_a_logarithmic_chart_have_one_form() {
        for (low, high) in [(1e-4f64, 30.0f64), (0.02, 300.0), (1e-9, 1e-7)] {
            let panel = Panel {
                labels: Labels { title: "", subtitle: String::new(), x: "", y: "" },
                curves: vec![Curve::new("", vec![(100.0, low), (200.0, high)])],
                marks: Vec::new(),
                x_range: Some((100.0, 200.0)),
                is_log: true,
            };
            let svg = panels("", 1, (500.0, 400.0), &[panel]).svg();
            // Labels of x, from 100 to 200, have no power of ten; those of y are the others.
            let on_x = |label: &str| label.parse().is_ok_and(|x: f64| (100.0..=200.0).contains(&x));
            let (powers, others): (Vec<&str>, Vec<&str>) =
                texts(&svg).into_iter().partition(|t| t.contains('e'));
            assert!(powers.len() > 2 && others.iter().all(|t| on_x(t)), "{powers:?} {others:?}");
            let decades = (high / low).log10() as usize;
            assert!(powers.len() >= decades, "{powers:?}");
        }
    }
}
