//! Waterfall plots: curves of the harmonics behind one another in oblique projection.

use lumped::ModeType;

use super::drawing::{Anchor, Canvas, Pen, Picture, Pixel, Scale, Type, colour, colour_of, spread};
use super::sweep::{Quantity, Spot, Subject, key_of_types};

const COLUMNS: usize = 2;
const CELL: [f64; 2] = [640.0, 460.0];
const HEAD: f64 = 84.0;

/// Margins of the drawing in its cell: left, right, top, px.
const MARGINS: [f64; 3] = [70.0, 62.0, 34.0];

/// Room below it, px: for speeds, and for the names of natural frequencies.
const FOOT: f64 = 62.0;
const NAMES: f64 = 140.0;

/// Parts of the drawing's width and height that its depth takes.
const DEPTH: [f64; 2] = [0.16, 0.42];

const BASE: Pen = Pen::new("#c4c8cc", 0.8);
const FRAME: Pen = Pen::new("#333333", 1.0);

/// A box seen from above its front: x to the right, depth to the back right, height upwards.
struct Oblique {
    x: Scale,
    height: Scale,
    /// Front left corner of the floor, px.
    origin: Pixel,
    /// Lengths of x, of the depth's two parts and of the height, px.
    width: f64,
    depth: [f64; 2],
    rise: f64,
}

impl Oblique {
    /// A box as high as its cell allows for the highest curve; `curves`: depth and amplitude of all points.
    fn new(
        cell: Pixel,
        foot: f64,
        x: Scale,
        height: Scale,
        curves: impl Iterator<Item = (f64, f64)>,
    ) -> Self {
        let [left, right, top] = MARGINS;
        let size = [CELL[0] - left - right, CELL[1] - top - foot];
        let depth = [DEPTH[0] * size[0], DEPTH[1] * size[1]];
        let room = curves.map(|(at, value)| (size[1] - depth[1] * at) / height.share(value));
        Self {
            x,
            height,
            origin: [cell[0] + left, cell[1] + CELL[1] - foot],
            width: size[0] - depth[0],
            depth,
            rise: room.fold(0.94 * size[1], f64::min),
        }
    }

    /// `depth`: 0 in front, 1 at the back.
    fn at(&self, x: f64, depth: f64, height: f64) -> Pixel {
        [
            self.origin[0] + self.width * self.x.share(x) + self.depth[0] * depth,
            self.origin[1] - self.depth[1] * depth - self.rise * self.height.share(height),
        ]
    }

    /// Edges of the floor, ticks of x at its front and of the height at its left.
    fn frame(&self, canvas: &mut Canvas, ends: [f64; 2]) {
        let [low, high] = ends;
        let floor = [(low, 0.0), (high, 0.0), (high, 1.0), (low, 1.0), (low, 0.0)];
        canvas.line(floor.map(|(x, depth)| self.at(x, depth, 0.0)), BASE);
        canvas.line([self.at(low, 0.0, 0.0), self.at(high, 0.0, 0.0)], FRAME);
        let [x, y] = self.origin;
        canvas.line([[x, y], [x, y - self.rise]], FRAME);
        for (value, label) in self.height.ticks(4) {
            let [x, y] = self.at(low, 0.0, value);
            canvas.line([[x - 4.0, y], [x, y]], FRAME);
            canvas.text([x - 7.0, y + 4.0], Type::new(11, Anchor::End), label);
        }
        for (value, label) in self.x.ticks(6) {
            let [x, y] = self.at(value, 0.0, 0.0);
            canvas.line([[x, y], [x, y + 4.0]], FRAME);
            canvas.text([x, y + 17.0], Type::new(11, Anchor::Middle), label);
        }
    }

    fn labels(&self, canvas: &mut Canvas, quantity: &Quantity, x: &str, below: f64) {
        let [left, bottom] = self.origin;
        canvas.text(
            [left + 0.5 * self.width, bottom + below],
            Type::new(12, Anchor::Middle),
            x.to_owned(),
        );
        let up = Type::new(12, Anchor::Middle).turned(-90.0);
        canvas.text(
            [left - 48.0, bottom - 0.5 * self.rise],
            up,
            format!("amplitude, {}", quantity.unit),
        );
    }
}

/// A picture with one cell for each quantity.
fn cells(
    subject: &Subject,
    list: &[Quantity],
    title: &str,
    draw: impl Fn(&mut Canvas, &Quantity, Pixel),
) -> Picture {
    let columns = COLUMNS.min(list.len().max(1));
    let rows = list.len().div_ceil(columns);
    let width = CELL[0] * columns as f64;
    let mut canvas = Canvas::new([width, HEAD + CELL[1] * rows as f64]);
    canvas.head(&format!("{}: {title}", subject.title), &subject.caption);
    key_of_types(&mut canvas, subject, [0.5 * width, 68.0]);
    for (i, quantity) in list.iter().enumerate() {
        let cell = [CELL[0] * (i % columns) as f64, HEAD + CELL[1] * (i / columns) as f64];
        let kind = Type::new(14, Anchor::Middle).bold();
        canvas.text([cell[0] + 0.5 * CELL[0], cell[1] + 18.0], kind, quantity.title.clone());
        draw(&mut canvas, quantity, cell);
    }
    canvas.picture()
}

/// One curve on its own base line; if opaque, it hides the curves behind it.
fn sheet(
    canvas: &mut Canvas,
    spots: &[Spot],
    pen: Pen,
    is_opaque: bool,
    at: impl Fn(&Spot, f64) -> Pixel,
) {
    let curve: Vec<Pixel> = spots.iter().map(|s| at(s, s.amplitude)).collect();
    if is_opaque {
        let base = spots.iter().rev().map(|s| at(s, 0.0));
        let outline: Vec<Pixel> = curve.iter().copied().chain(base).collect();
        canvas.area(&outline, "#ffffff", 0.75);
    }
    canvas.line(curve, pen);
}

/// Colour of harmonic number i from 0, dashed for falling speeds.
fn pen(i: usize, branch: usize) -> Pen {
    let pen = Pen::new(colour(i), 1.5);
    if branch == 0 { pen } else { pen.dashed("6 3") }
}

/// Amplitudes over mesh frequency, the first harmonic in front (Figs 4 to 6, 8 to 11); dots on the base
/// lines where a harmonic meets a natural frequency.
pub(super) fn over_mesh_frequency(subject: &Subject, list: &[Quantity]) -> Picture {
    let title = "harmonics of the mesh frequency; dots: natural frequency over l";
    cells(subject, list, title, |canvas, quantity, cell| {
        let top = subject.top_mesh_hz;
        let count = quantity.harmonics.len();
        let depth = |i: usize| i as f64 / count.saturating_sub(1).max(1) as f64;
        let (x, height) = scales(quantity, top);
        let curves = quantity.harmonics.iter().enumerate().flat_map(|(i, branches)| {
            branches.iter().flatten().map(move |s| (depth(i), s.amplitude))
        });
        let view = Oblique::new(cell, FOOT, x, height, curves);
        view.frame(canvas, [0.0, top]);
        for (value, _) in x.ticks(6) {
            canvas.line([view.at(value, 0.0, 0.0), view.at(value, 1.0, 0.0)], BASE);
            let [at, bottom] = view.at(value, 0.0, 0.0);
            let rpm = format!("{:.0}", value * subject.rpm_per_hz);
            let grey = Type::new(10, Anchor::Middle).colour("#70767c");
            canvas.text([at, bottom + 31.0], grey, rpm);
        }
        for (i, branches) in quantity.harmonics.iter().enumerate().rev() {
            canvas.line([view.at(0.0, depth(i), 0.0), view.at(top, depth(i), 0.0)], BASE);
            for (branch, spots) in branches.iter().enumerate() {
                sheet(canvas, spots, pen(i, branch), branch == 0, |s, height| {
                    view.at(s.mesh_hz, depth(i), height)
                });
            }
            let l = (i + 1) as f64;
            for (f, mode_type) in subject.natural.iter().filter(|(f, _)| x.contains(f / l)) {
                canvas.disc(view.at(f / l, depth(i), 0.0), 2.6, colour_of(*mode_type));
            }
            let [end, base] = view.at(top, depth(i), 0.0);
            let kind = Type::new(12, Anchor::Start).colour(colour(i));
            canvas.text([end + 8.0, base + 4.0], kind, format!("l = {}", i + 1));
        }
        view.labels(canvas, quantity, "mesh frequency f_m, Hz (grey: input speed, rpm)", 50.0);
    })
}

/// Amplitudes over l f_m, the mesh frequency in the depth (Fig. 7): every peak on the line of a natural
/// frequency.
pub(super) fn over_frequency(subject: &Subject, list: &[Quantity]) -> Picture {
    let title = "harmonics over their own frequency; dashed: natural frequencies";
    cells(subject, list, title, |canvas, quantity, cell| {
        let count = quantity.harmonics.len();
        let top = subject.top_mesh_hz;
        let end = end_of_frequencies(subject, count);
        let depth = |mesh_hz: f64| mesh_hz / top;
        let (x, height) = scales(quantity, end);
        let curves = quantity.harmonics.iter().enumerate().flat_map(|(i, branches)| {
            let inside = move |s: &&Spot| (i + 1) as f64 * s.mesh_hz <= end;
            let spots = branches.iter().flatten().filter(inside);
            spots.map(move |s| (depth(s.mesh_hz), s.amplitude))
        });
        let view = Oblique::new(cell, NAMES, x, height, curves);
        view.frame(canvas, [0.0, end]);
        natural_lines(canvas, &view, subject);
        for (mesh_hz, label) in Scale::linear(0.0, top).ticks(4) {
            let [at, base] = view.at(end, depth(mesh_hz), 0.0);
            canvas.line([[at, base], [at + 4.0, base]], FRAME);
            canvas.text([at + 8.0, base + 4.0], Type::new(11, Anchor::Start), label);
        }
        let [at, base] = view.at(end, 0.5, 0.0);
        let turned = Type::new(12, Anchor::Middle).turned(-66.0);
        canvas.text([at + 52.0, base], turned, "f_m, Hz");
        // At one frequency the first harmonic is the furthest back.
        for (i, branches) in quantity.harmonics.iter().enumerate() {
            let l = (i + 1) as f64;
            let last = (end / l).min(top);
            canvas.line([view.at(0.0, 0.0, 0.0), view.at(l * last, depth(last), 0.0)], BASE);
            for (branch, spots) in branches.iter().enumerate() {
                let inside: Vec<Spot> =
                    spots.iter().filter(|s| l * s.mesh_hz <= end).copied().collect();
                sheet(canvas, &inside, pen(i, branch), branch == 0, |s, height| {
                    view.at(l * s.mesh_hz, depth(s.mesh_hz), height)
                });
            }
        }
        for i in 0..count {
            let kind = Type::new(12, Anchor::Start).colour(colour(i));
            let at = [cell[0] + CELL[0] - 46.0, cell[1] + 42.0 + 17.0 * i as f64];
            canvas.text(at, kind, format!("l = {}", i + 1));
        }
        view.labels(canvas, quantity, "frequency l f_m, Hz", 132.0);
    })
}

/// Scales up to a frequency and to the largest amplitude.
fn scales(quantity: &Quantity, end: f64) -> (Scale, Scale) {
    (Scale::linear(0.0, end), Scale::linear(0.0, quantity.largest()))
}

/// A little beyond the natural frequencies that the highest harmonic reaches.
fn end_of_frequencies(subject: &Subject, count: usize) -> f64 {
    let reach = subject.top_mesh_hz * count.max(1) as f64;
    let reached = subject.natural.iter().map(|(f, _)| *f).filter(|f| *f <= reach);
    match reached.fold(0.0, f64::max) {
        0.0 => reach,
        highest => (1.15 * highest).min(reach),
    }
}

/// Lines of the natural frequencies on the floor, labelled with frequency and type in front of it.
fn natural_lines(canvas: &mut Canvas, view: &Oblique, subject: &Subject) {
    let inside: Vec<&(f64, ModeType)> =
        subject.natural.iter().filter(|(f, _)| view.x.contains(*f)).collect();
    let wanted: Vec<f64> = inside.iter().map(|(f, _)| view.at(*f, 0.0, 0.0)[0]).collect();
    let places = spread(&wanted, 14.0, view.origin[0] + view.width);
    for ((f, mode_type), place) in inside.into_iter().zip(places) {
        let pen = Pen::new(colour_of(*mode_type), 1.0);
        let front = view.at(*f, 0.0, 0.0);
        let end = [place, front[1] + 26.0];
        canvas.line([view.at(*f, 1.0, 0.0), front], pen.dashed("5 3"));
        canvas.line([front, end], Pen::new(colour_of(*mode_type), 0.7));
        let kind = Type::new(10, Anchor::Start).colour(colour_of(*mode_type)).turned(55.0);
        let label = format!("{f:.0} {}", mode_type.name());
        canvas.text([end[0] - 2.0, end[1] + 8.0], kind, label);
    }
}
