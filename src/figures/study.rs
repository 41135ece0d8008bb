//! Error against cost of the settings of a study, a panel for each quantity.

use experiments::study::{QuantityResult, Quartiles, Row, StudyResult};

use super::Figure;
use super::cost::{around, free};
use super::drawing::{Anchor, Axes, Canvas, Pen, Pixel, Scale, Type, colour};

const SIZE: [f64; 2] = [430.0, 330.0];
const CORNER: [f64; 2] = [84.0, 92.0];
const GAP: [f64; 2] = [96.0, 118.0];
const LEGEND: f64 = 250.0;

/// Most panels side by side.
const COLUMNS: usize = 2;

/// Width of a letter of a label, px.
const LETTER: f64 = 5.4;

/// Smallest error that is drawn, percent.
const LEAST: f64 = 1e-6;

const RING: Pen = Pen::new("#000000", 1.4);
const WANTED: Pen = Pen::new("#b23a48", 1.2).dashed("6 3");
const FRONT: Pen = Pen::new("#6b7075", 1.2).dashed("4 3");
const OPEN: &str = "#b9bdc1";
const BELOW: &str = "#d9dde1";

/// One figure of a study; `name` is that of its file.
pub fn of_study(study: &StudyResult, name: &str) -> Figure {
    let mut groups: Vec<&str> = Vec::new();
    for setting in &study.settings {
        if !groups.contains(&setting.group.as_str()) {
            groups.push(&setting.group);
        }
    }
    let count = study.quantities.len();
    let columns = count.clamp(1, COLUMNS);
    let rows = count.div_ceil(columns);
    let width = CORNER[0] + columns as f64 * (SIZE[0] + GAP[0]) - GAP[0] + LEGEND;
    let height = CORNER[1] + rows as f64 * (SIZE[1] + GAP[1]) - GAP[1] + 64.0;
    let mut canvas = Canvas::new([width, height]);
    let caption = format!(
        "{}, {} N·m on the sun; cost 1: a mesh cycle of the lumped model of 140 steps",
        study.scene, study.sun_torque_nm
    );
    canvas.head(&study.title, &caption);
    for (k, quantity) in study.quantities.iter().enumerate() {
        let (row, column) = (k / columns, k % columns);
        let corner = [
            CORNER[0] + (SIZE[0] + GAP[0]) * column as f64,
            CORNER[1] + (SIZE[1] + GAP[1]) * row as f64,
        ];
        panel(&mut canvas, study, quantity, &groups, corner);
    }
    let left = CORNER[0] + columns as f64 * (SIZE[0] + GAP[0]) - GAP[0] + 22.0;
    legend(&mut canvas, &groups, [left, CORNER[1] + 14.0]);
    Figure::new(format!("study_{}", name.replace('-', "_")), canvas.picture())
}

/// A setting as it is drawn.
struct Mark<'s> {
    row: &'s Row,
    label: String,
    group: usize,
    cost: Quartiles,
    /// Guarded error, percent, no smaller than U.
    error: f64,
}

impl Mark<'_> {
    fn is_open(&self) -> bool {
        self.row.ranks.is_some_and(|[low, high]| low != high)
    }
}

fn marks<'s>(
    study: &'s StudyResult,
    quantity: &'s QuantityResult,
    groups: &[&str],
) -> Vec<Mark<'s>> {
    let uncertain = quantity.truth.uncertainty_percent;
    let one = |(row, k): (&'s Row, usize)| {
        let setting = &study.settings[k];
        let start = format!("{}: ", setting.group);
        let label = setting.name.strip_prefix(&start).unwrap_or(&setting.name);
        Some(Mark {
            row,
            label: label.to_owned(),
            group: groups.iter().position(|g| *g == setting.group).unwrap_or(0),
            cost: row.time.cost_cycles.filter(|q| q.median > 0.0)?,
            error: row.guarded_percent?.max(uncertain).max(LEAST),
        })
    };
    quantity.rows.iter().zip(0..).filter_map(one).collect()
}

fn panel(
    canvas: &mut Canvas,
    study: &StudyResult,
    quantity: &QuantityResult,
    groups: &[&str],
    corner: Pixel,
) {
    let marks = marks(study, quantity, groups);
    let uncertain = quantity.truth.uncertainty_percent.max(LEAST);
    let limits = [study.tolerance_percent, uncertain];
    let axes = Axes {
        x: Scale::log(marks.iter().flat_map(|m| [m.cost.low, m.cost.high])),
        y: Scale::log(marks.iter().map(|m| m.error).chain(limits)),
        corner,
        size: SIZE,
    };
    axes.frame(canvas, [0, 0]);
    axes.title(canvas, &quantity.name);
    axes.x_label(canvas, "cost, lumped mesh cycles");
    axes.y_label(canvas, "error, %");
    let height = |error: f64| axes.bottom() - SIZE[1] * axes.y.share(error);
    let (left, right, below) = (axes.left(), axes.right(), height(uncertain));
    let area = [[left, below], [right, below], [right, axes.bottom()], [left, axes.bottom()]];
    canvas.area(&area, BELOW, 0.7);
    let wanted = height(study.tolerance_percent);
    canvas.line([[left, wanted], [right, wanted]], WANTED);
    let at = |m: &Mark<'_>| axes.at((m.cost.median, m.error));
    let mut efficient: Vec<&Mark<'_>> = marks.iter().filter(|m| m.row.time.is_efficient).collect();
    efficient.sort_by(|a, b| a.cost.median.total_cmp(&b.cost.median));
    canvas.line(efficient.iter().map(|m| at(m)), FRONT);
    for m in &marks {
        let [from, to] = [m.cost.low, m.cost.high].map(|cost| axes.at((cost, m.error)));
        canvas.line([from, to], Pen::new(colour(m.group), 1.0));
        match (m.row.doubt.is_some(), m.is_open()) {
            (true, _) => canvas.ring(at(m), 4.0, Pen::new(colour(m.group), 1.6)),
            (_, true) => canvas.disc(at(m), 4.0, OPEN),
            _ => canvas.disc(at(m), 4.0, colour(m.group)),
        }
        if m.row.time.is_efficient {
            canvas.ring(at(m), 8.0, RING);
        }
    }
    let mut taken: Vec<[f64; 4]> = marks.iter().map(|m| around(at(m), 5.0)).collect();
    let (first, others): (Vec<_>, Vec<_>) = marks.iter().partition(|m| m.row.time.is_efficient);
    for m in first.into_iter().chain(others) {
        let length = LETTER * m.label.chars().count() as f64;
        let (place, anchor) = free(&axes, at(m), length, &mut taken);
        canvas.text(place, Type::new(9, anchor).colour(colour(m.group)), m.label.clone());
    }
}

fn legend(canvas: &mut Canvas, groups: &[&str], [left, top]: Pixel) {
    let text = Type::new(12, Anchor::Start);
    let mut y = top;
    let mut lines = |canvas: &mut Canvas, words: &[&str]| {
        for line in words {
            canvas.text([left + 14.0, y], text, (*line).to_owned());
            y += 15.0;
        }
        y += 7.0;
        y
    };
    let mut middle = top - 4.0;
    for (i, group) in groups.iter().enumerate() {
        canvas.disc([left, middle], 4.0, colour(i));
        middle = lines(canvas, &[group]) - 4.0;
    }
    canvas.ring([left, middle], 8.0, RING);
    middle = lines(canvas, &["no setting is both", "cheaper and more accurate"]) - 4.0;
    canvas.disc([left, middle], 4.0, OPEN);
    middle = lines(canvas, &["rank changes as the truth", "moves by ±U"]) - 4.0;
    canvas.ring([left, middle], 4.0, Pen::new("#6b7075", 1.6));
    middle = lines(canvas, &["a finer setting is farther off:", "drawn with its error"]) - 4.0;
    canvas.line([[left - 8.0, middle], [left + 8.0, middle]], WANTED);
    middle = lines(canvas, &["wanted"]) - 4.0;
    canvas.rectangle([left - 8.0, middle - 5.0], [16.0, 10.0], BELOW);
    lines(canvas, &["below U: not to be told from", "the truth, drawn at U"]);
}
