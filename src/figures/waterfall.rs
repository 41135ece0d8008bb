//! Waterfall plots: curves of the harmonics behind one another in oblique projection.

use super::drawing::{
    Anchor, Canvas, Pen, Picture, Pixel, Scale, Series, Symbol, Type, colour, colour_of, curve,
    spread,
};
use super::sweep::{Quantity, Spot, Subject};

const CELL: [f64; 2] = [640.0, 460.0];

/// Margins of the drawing in its cell: left, right, top, px.
const MARGINS: [f64; 3] = [70.0, 62.0, 34.0];

/// Room below it, px: for speeds, and for the names of natural frequencies.
const FOOT: f64 = 62.0;
const NAMES: f64 = 140.0;

/// Parts of the drawing's width and height that its depth takes.
const DEPTH: [f64; 2] = [0.16, 0.42];

const BASE: Pen = Pen::new("#c4c8cc", 0.8);
const FRAME: Pen = Pen::new("#333333", 1.0);

/// Value of x and depth (0 in front, 1 at the back) of harmonic i, from 0, at a mesh frequency in Hz.
type Place<'p> = &'p dyn Fn(usize, f64) -> (f64, f64);

/// A box seen from above its front, with the curves of a quantity: x to the right, depth to the back right, height
/// upwards.
struct Oblique<'q> {
    quantity: &'q Quantity,
    place: Place<'q>,
    /// Ends of x and of the mesh frequency, Hz.
    end: f64,
    top_mesh_hz: f64,
    x: Scale,
    height: Scale,
    /// Front left corner of the floor, px.
    origin: Pixel,
    /// Lengths of x, of the depth's two parts and of the height, px.
    width: f64,
    depth: [f64; 2],
    rise: f64,
}

impl<'q> Oblique<'q> {
    /// A box as high as its cell allows for the highest curve, over `foot` px.
    fn new(
        cell: Pixel,
        foot: f64,
        quantity: &'q Quantity,
        place: Place<'q>,
        [end, top_mesh_hz]: [f64; 2],
    ) -> Self {
        let [left, right, top] = MARGINS;
        let size = [CELL[0] - left - right, CELL[1] - top - foot];
        let depth = [DEPTH[0] * size[0], DEPTH[1] * size[1]];
        let mut view = Self {
            quantity,
            place,
            end,
            top_mesh_hz,
            x: Scale::linear(0.0, end),
            height: Scale::linear(0.0, quantity.largest()),
            origin: [cell[0] + left, cell[1] + CELL[1] - foot],
            width: size[0] - depth[0],
            depth,
            rise: 0.94 * size[1],
        };
        let spots = quantity.harmonics.iter().enumerate().flat_map(|(i, branches)| {
            let spots = branches.iter().flatten();
            spots.map(move |s| (place(i, s.mesh_hz), s.amplitude))
        });
        let room = spots
            .filter(|((x, _), _)| *x <= end)
            .map(|((_, at), amplitude)| (size[1] - depth[1] * at) / view.height.share(amplitude));
        view.rise = room.fold(view.rise, f64::min);
        view
    }

    /// Motions whose harmonic i lies within the scale of x.
    fn inside<'s>(&self, i: usize, spots: &'s [Spot]) -> impl Iterator<Item = &'s Spot> {
        let (place, end) = (self.place, self.end);
        spots.iter().filter(move |s| place(i, s.mesh_hz).0 <= end)
    }

    fn at(&self, x: f64, depth: f64, height: f64) -> Pixel {
        [
            self.origin[0] + self.width * self.x.share(x) + self.depth[0] * depth,
            self.origin[1] - self.depth[1] * depth - self.rise * self.height.share(height),
        ]
    }

    /// Edges of the floor, ticks of x at its front and of the height at its left, and the labels of both.
    fn frame(&self, canvas: &mut Canvas, label: &str, below: f64) {
        let floor = [(0.0, 0.0), (self.end, 0.0), (self.end, 1.0), (0.0, 1.0), (0.0, 0.0)];
        canvas.line(floor.map(|(x, depth)| self.at(x, depth, 0.0)), BASE);
        canvas.line([self.at(0.0, 0.0, 0.0), self.at(self.end, 0.0, 0.0)], FRAME);
        let [left, bottom] = self.origin;
        canvas.line([[left, bottom], [left, bottom - self.rise]], FRAME);
        for (value, label) in self.height.ticks(4.0) {
            let [x, y] = self.at(0.0, 0.0, value);
            canvas.line([[x - 4.0, y], [x, y]], FRAME);
            canvas.text([x - 7.0, y + 4.0], Type::new(11, Anchor::End), label);
        }
        for (value, label) in self.x.ticks(6.0) {
            let [x, y] = self.at(value, 0.0, 0.0);
            canvas.line([[x, y], [x, y + 4.0]], FRAME);
            canvas.text([x, y + 17.0], Type::new(11, Anchor::Middle), label);
        }
        let kind = Type::new(12, Anchor::Middle);
        canvas.text([left + 0.5 * self.width, bottom + below], kind, label);
        let amplitude = format!("amplitude, {}", self.quantity.unit);
        canvas.text([left - 48.0, bottom - 0.5 * self.rise], kind.turned(-90.0), amplitude);
    }

    /// Base line and curves of harmonic i; that of growing speeds hides what is behind it.
    fn curves(&self, canvas: &mut Canvas, i: usize) {
        // The last mesh frequency within the scale of x, which grows in proportion to it.
        let last = f64::min(self.end / (self.place)(i, 1.0).0, self.top_mesh_hz);
        let base = [0.0, last].map(|mesh_hz| (self.place)(i, mesh_hz));
        canvas.line(base.map(|(x, depth)| self.at(x, depth, 0.0)), BASE);
        for (branch, spots) in self.quantity.harmonics[i].iter().enumerate() {
            let line = |height: fn(&Spot) -> f64| -> Vec<Pixel> {
                let places = self.inside(i, spots).map(|s| ((self.place)(i, s.mesh_hz), height(s)));
                places.map(|((x, depth), height)| self.at(x, depth, height)).collect()
            };
            let curve_line = line(|s| s.amplitude);
            if branch == 0 {
                let base = line(|_| 0.0);
                let outline = curve_line.iter().chain(base.iter().rev()).copied();
                canvas.area(&outline.collect::<Vec<_>>(), "#ffffff", 0.75);
            }
            canvas.line(curve_line, if branch == 0 { curve(i) } else { curve(i).dashed() });
        }
    }
}

/// A picture with one cell for each quantity.
fn cells(
    subject: &Subject,
    list: &[Quantity],
    title: &str,
    draw: impl Fn(&mut Canvas, &Quantity, Pixel),
) -> Picture {
    let title = format!("{}: {title}", subject.title);
    let key = subject.natural_lines(|f| f);
    let key: Vec<&Series> = key.iter().collect();
    let (mut canvas, corners) =
        Canvas::cells([&title, &subject.caption], &key, 2, list.len(), CELL);
    for (quantity, cell) in list.iter().zip(corners) {
        let middle = [cell[0] + 0.5 * CELL[0], cell[1] + 18.0];
        canvas.text(middle, Type::new(14, Anchor::Middle), &*quantity.title);
        draw(&mut canvas, quantity, cell);
    }
    canvas.picture()
}

/// Amplitudes over mesh frequency, the first harmonic in front (Figs 4 to 6, 8 to 11); dots on the base
/// lines where a harmonic meets a natural frequency.
pub(super) fn over_mesh_frequency(subject: &Subject, list: &[Quantity]) -> Picture {
    let title = "harmonics of the mesh frequency; dots: natural frequency over l";
    let top = subject.top_mesh_hz;
    cells(subject, list, title, |canvas, quantity, cell| {
        let count = quantity.harmonics.len();
        let depth = |i: usize| i as f64 / count.saturating_sub(1).max(1) as f64;
        let place = |i, mesh_hz| (mesh_hz, depth(i));
        let view = Oblique::new(cell, FOOT, quantity, &place, [top, top]);
        view.frame(canvas, "mesh frequency f_m, Hz (grey: input speed, rpm)", 50.0);
        for (value, _) in view.x.ticks(6.0) {
            let front = view.at(value, 0.0, 0.0);
            canvas.line([front, view.at(value, 1.0, 0.0)], BASE);
            let rpm = format!("{:.0}", value * subject.rpm_per_hz);
            let grey = Type::new(10, Anchor::Middle).colour("#70767c");
            canvas.text([front[0], front[1] + 31.0], grey, rpm);
        }
        for i in (0..count).rev() {
            view.curves(canvas, i);
            let l = (i + 1) as f64;
            for (f, mode_type) in subject.natural.iter().filter(|(f, _)| view.x.contains(f / l)) {
                let disc = Symbol::Disc(2.6, colour_of(*mode_type));
                canvas.symbol(view.at(f / l, depth(i), 0.0), disc);
            }
            let [end, base] = view.at(top, depth(i), 0.0);
            let kind = Type::new(12, Anchor::Start).colour(colour(i));
            canvas.text([end + 8.0, base + 4.0], kind, format!("l = {}", i + 1));
        }
    })
}

/// Amplitudes over l f_m, the mesh frequency in the depth (Fig. 7): every peak on the line of a natural
/// frequency.
pub(super) fn over_frequency(subject: &Subject, list: &[Quantity]) -> Picture {
    let title = "harmonics over their own frequency; dashed: natural frequencies";
    let top = subject.top_mesh_hz;
    cells(subject, list, title, |canvas, quantity, cell| {
        let count = quantity.harmonics.len();
        let end = end_of_frequencies(subject, count);
        let place = |i: usize, mesh_hz: f64| ((i + 1) as f64 * mesh_hz, mesh_hz / top);
        let view = Oblique::new(cell, NAMES, quantity, &place, [end, top]);
        view.frame(canvas, "frequency l f_m, Hz", 132.0);
        natural_lines(canvas, &view, subject);
        for (mesh_hz, label) in Scale::linear(0.0, top).ticks(4.0) {
            let [at, base] = view.at(end, mesh_hz / top, 0.0);
            canvas.line([[at, base], [at + 4.0, base]], FRAME);
            canvas.text([at + 8.0, base + 4.0], Type::new(11, Anchor::Start), label);
        }
        let [at, base] = view.at(end, 0.5, 0.0);
        canvas.text([at + 52.0, base], Type::new(12, Anchor::Middle).turned(-66.0), "f_m, Hz");
        // At one frequency the first harmonic is the furthest back.
        for i in 0..count {
            view.curves(canvas, i);
            let kind = Type::new(12, Anchor::Start).colour(colour(i));
            let at = [cell[0] + CELL[0] - 46.0, cell[1] + 42.0 + 17.0 * i as f64];
            canvas.text(at, kind, format!("l = {}", i + 1));
        }
    })
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
fn natural_lines(canvas: &mut Canvas, view: &Oblique<'_>, subject: &Subject) {
    let inside = || subject.natural.iter().filter(|(f, _)| view.x.contains(*f));
    let wanted: Vec<f64> = inside().map(|(f, _)| view.at(*f, 0.0, 0.0)[0]).collect();
    let places = spread(&wanted, 14.0, view.origin[0] + view.width);
    for ((f, mode_type), place) in inside().zip(places) {
        let colour = colour_of(*mode_type);
        let (front, back) = (view.at(*f, 0.0, 0.0), view.at(*f, 1.0, 0.0));
        canvas.line([back, front], Pen::new(colour, 1.0).dashed());
        canvas.line([front, [place, front[1] + 26.0]], Pen::new(colour, 0.7));
        let kind = Type::new(10, Anchor::Start).colour(colour).turned(55.0);
        let label = format!("{f:.0} {}", mode_type.name());
        canvas.text([place - 2.0, front[1] + 34.0], kind, label);
    }
}
