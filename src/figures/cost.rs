//! Error against cost of the fidelities of the ladder (`kept/ladder.toml`).

use validation::{Ladder, LadderFidelity};

use super::drawing::{Anchor, Axes, Canvas, Pen, Picture, Pixel, Scale, Type, colour};

/// A fidelity with a number of steps per cycle and of contact cells.
struct Setting {
    /// Steps, and cells where they are not the default.
    label: String,
    group: usize,
    cost: f64,
    /// Error, percent; at least the uncertainty of the reference.
    error: f64,
}

/// One kind of error: title, how it is read, uncertainty of the reference and wanted limit, both in percent.
struct Panel {
    title: &'static str,
    error: fn(&LadderFidelity, &Ladder) -> f64,
    uncertain: f64,
    wanted: f64,
}

const SIZE: [f64; 2] = [430.0, 380.0];
const CORNER: [f64; 2] = [76.0, 84.0];
const GAP: f64 = 76.0;
const LEGEND: f64 = 190.0;

/// Height of a label and width of a letter, px.
const LINE: f64 = 11.0;
const LETTER: f64 = 5.4;

/// Error over cost, both axes logarithmic; settings on the Pareto front (none is both cheaper and better) are
/// ringed and joined.
pub fn cost(ladder: &Ladder) -> Picture {
    let panels = [
        Panel {
            title: "height of the peak",
            error: LadderFidelity::height_percent,
            uncertain: ladder.peak_rad_uncertain_percent,
            wanted: 1.0,
        },
        Panel {
            title: "place of the peak",
            error: LadderFidelity::place_percent,
            uncertain: ladder.peak_rpm_uncertain_percent,
            wanted: 0.2,
        },
    ];
    let width = CORNER[0] + 2.0 * SIZE[0] + GAP + LEGEND;
    let mut canvas = Canvas::new([width, CORNER[1] + SIZE[1] + 58.0]);
    let caption = format!(
        "sun rotation, second harmonic, four planets, {} N·m; truth: full bodies; labels: steps a mesh cycle",
        ladder.torque_nm
    );
    canvas.head("What a fidelity costs and how far off it is", &caption);
    let mut groups: Vec<&str> = Vec::new();
    for fidelity in &ladder.fidelity {
        if !groups.contains(&fidelity.name.as_str()) {
            groups.push(&fidelity.name);
        }
    }
    for (k, panel) in panels.iter().enumerate() {
        let corner = [CORNER[0] + (SIZE[0] + GAP) * k as f64, CORNER[1]];
        draw(&mut canvas, ladder, panel, &groups, corner);
    }
    legend(&mut canvas, &groups, [CORNER[0] + 2.0 * SIZE[0] + GAP + 20.0, CORNER[1] + 14.0]);
    canvas.picture()
}

fn settings(ladder: &Ladder, panel: &Panel, groups: &[&str]) -> Vec<Setting> {
    let usual = ladder.fidelity.first().map_or(0, |r| r.contact_cells);
    let one = |fidelity: &LadderFidelity| {
        let cells = match fidelity.contact_cells == usual {
            true => String::new(),
            false => format!(", {} cells", fidelity.contact_cells),
        };
        Setting {
            label: format!("{}{cells}", fidelity.steps_per_cycle),
            group: groups.iter().position(|g| *g == fidelity.name).unwrap_or(0),
            cost: fidelity.cycle_ratio(),
            error: (panel.error)(fidelity, ladder).abs().max(panel.uncertain).max(1e-3),
        }
    };
    ladder.fidelity.iter().map(one).collect()
}

fn draw(canvas: &mut Canvas, ladder: &Ladder, panel: &Panel, groups: &[&str], corner: Pixel) {
    let settings = settings(ladder, panel, groups);
    let wanted = std::iter::once(panel.wanted);
    let axes = Axes {
        x: Scale::log(settings.iter().map(|s| s.cost)),
        y: Scale::log(settings.iter().map(|s| s.error).chain(wanted)),
        corner,
        size: SIZE,
    };
    axes.frame(canvas, [0, 0]);
    axes.title(canvas, panel.title);
    axes.x_label(canvas, "cost of a mesh cycle, lumped at 140 steps = 1");
    axes.y_label(canvas, "error, %");
    let at = |s: &Setting| axes.at((s.cost, s.error));
    let [_, y] = axes.at((1.0, panel.wanted));
    canvas.line([[axes.left(), y], [axes.right(), y]], Pen::new("#b23a48", 1.2).dashed("6 3"));
    let is_efficient = |s: &Setting| {
        let beats = |o: &Setting| {
            o.cost <= s.cost && o.error <= s.error && (o.cost < s.cost || o.error < s.error)
        };
        !settings.iter().any(beats)
    };
    let mut efficient: Vec<&Setting> = settings.iter().filter(|s| is_efficient(s)).collect();
    efficient.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    canvas.line(efficient.iter().map(|s| at(s)), Pen::new("#9aa0a6", 1.2).dashed("4 3"));
    for s in &settings {
        canvas.disc(at(s), 4.0, colour(s.group));
        if is_efficient(s) {
            canvas.ring(at(s), 8.0, RING);
        }
    }
    let mut taken: Vec<[f64; 4]> = settings.iter().map(|s| around(at(s), 5.0)).collect();
    // Labels of ringed settings are placed first.
    let (first, others): (Vec<_>, Vec<_>) = settings.iter().partition(|s| is_efficient(s));
    for s in first.into_iter().chain(others) {
        let length = LETTER * s.label.chars().count() as f64;
        let (place, anchor) = free(&axes, at(s), length, &mut taken);
        canvas.text(place, Type::new(9, anchor).colour(colour(s.group)), s.label.clone());
    }
}

const RING: Pen = Pen::new("#000000", 1.4);

fn legend(canvas: &mut Canvas, groups: &[&str], [left, top]: Pixel) {
    let text = Type::new(12, Anchor::Start);
    for (i, group) in groups.iter().enumerate() {
        let y = top + 20.0 * i as f64;
        canvas.disc([left, y - 4.0], 4.0, colour(i));
        canvas.text([left + 14.0, y], text, (*group).to_owned());
    }
    let y = top + 10.0 + 20.0 * groups.len() as f64;
    canvas.ring([left, y - 4.0], 8.0, RING);
    canvas.text([left + 14.0, y], text, "none is both");
    canvas.text([left + 14.0, y + 15.0], text, "cheaper and better");
    let y = y + 40.0;
    canvas.line(
        [[left - 8.0, y - 4.0], [left + 8.0, y - 4.0]],
        Pen::new("#b23a48", 1.2).dashed("6 3"),
    );
    canvas.text([left + 14.0, y], text, "wanted");
}

/// Square about a point: left, top, right, bottom.
pub(super) fn around([x, y]: Pixel, half: f64) -> [f64; 4] {
    [x - half, y - half, x + half, y + half]
}

/// Place and anchor of a label that covers no other, if there is one.
pub(super) fn free(
    axes: &Axes,
    [x, y]: Pixel,
    length: f64,
    taken: &mut Vec<[f64; 4]>,
) -> (Pixel, Anchor) {
    let is_free = |b: &[f64; 4], taken: &[[f64; 4]]| {
        let is_inside = b[0] >= axes.left() && b[2] <= axes.right() && b[1] >= axes.top();
        let meets = |t: &[f64; 4]| b[0] < t[2] && t[0] < b[2] && b[1] < t[3] && t[1] < b[3];
        is_inside && b[3] <= axes.bottom() && !taken.iter().any(meets)
    };
    for down in [4.0, -8.0, 16.0, -20.0, 28.0, -32.0] {
        for (left, anchor) in [(x + 11.0, Anchor::Start), (x - 11.0 - length, Anchor::End)] {
            let label = [left, y + down - LINE + 2.0, left + length, y + down + 2.0];
            if is_free(&label, taken) {
                taken.push(label);
                let at = if left > x { left } else { x - 11.0 };
                return ([at, y + down], anchor);
            }
        }
    }
    ([x + 11.0, y + 4.0], Anchor::Start)
}
