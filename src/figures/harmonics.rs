//! The harmonics of one quantity, one panel each, with marks where they meet natural frequencies.

use super::drawing::{Anchor, Axes, Canvas, Pen, Picture, Scale, Type, colour_of, spread};
use super::sweep::{Quantity, Spot, Subject, key_of_types};

const WIDTH: f64 = 860.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 30.0;

/// Height of a panel and of the labels above it, px.
const PANEL: f64 = 120.0;
const LABELS: f64 = 40.0;
const HEAD: f64 = 78.0;

/// Least range of a panel as a share of the largest amplitude, so that an absent harmonic looks absent.
const FLOOR: f64 = 0.02;

const CURVE: Pen = Pen::new("#000000", 1.4);
const DOWN: Pen = Pen::new("#d55e00", 1.2).dashed("6 3");

/// All harmonics of a quantity.
pub(super) fn picture(subject: &Subject, quantity: &Quantity) -> Picture {
    let count = quantity.harmonics.len() as f64;
    let mut canvas = Canvas::new([WIDTH, HEAD + count * (PANEL + LABELS) + 70.0]);
    canvas.head(&format!("{}: {}", subject.title, quantity.title), &subject.caption);
    key_of_types(&mut canvas, subject, [0.5 * WIDTH, 66.0]);
    let is_double = quantity.harmonics.first().is_some_and(|h| h.len() > 1);
    let floor = FLOOR * quantity.largest();
    for (i, branches) in quantity.harmonics.iter().enumerate() {
        let high = 1.08 * Quantity::largest_of(branches).max(floor);
        let axes = Axes {
            x: Scale::linear(0.0, subject.top_mesh_hz),
            y: Scale::linear(0.0, high),
            corner: [LEFT, HEAD + i as f64 * (PANEL + LABELS) + LABELS - 8.0],
            size: [WIDTH - LEFT - RIGHT, PANEL],
        };
        axes.frame(&mut canvas, [8, 3]);
        marks(&mut canvas, &axes, subject, i + 1);
        for (branch, spots) in branches.iter().enumerate() {
            let points = spots.iter().map(|s| axes.at((s.mesh_hz, s.amplitude)));
            canvas.line(points, if branch == 0 { CURVE } else { DOWN });
            for s in spots.iter().filter(|s: &&Spot| !s.is_steady) {
                canvas.ring(axes.at((s.mesh_hz, s.amplitude)), 3.0, Pen::new("#d55e00", 1.2));
            }
        }
        axes.y_label(&mut canvas, &format!("l = {}, {}", i + 1, quantity.unit));
        if i + 1 == quantity.harmonics.len() {
            axes.x_label(&mut canvas, "mesh frequency, Hz");
            let double = if is_double { "; solid: speeds growing, dashed: falling" } else { "" };
            let rings = if subject.is_settled {
                ""
            } else {
                "; ringed: repeats after several mesh cycles, or not shown to attract"
            };
            let note = format!("own scale each{double}{rings}");
            let kind = Type::new(11, Anchor::End).colour("#444444");
            canvas.text([axes.right(), axes.bottom() + 54.0], kind, note);
        }
    }
    canvas.picture()
}

/// Where l f_m is a natural frequency.
fn marks(canvas: &mut Canvas, axes: &Axes, subject: &Subject, harmonic: usize) {
    let l = harmonic as f64;
    let inside: Vec<_> =
        subject.natural.iter().filter(|(f, _)| axes.x.contains(f / l) && *f > 0.0).collect();
    let wanted: Vec<f64> = inside.iter().map(|(f, _)| axes.at((f / l, 0.0))[0]).collect();
    let places = spread(&wanted, 32.0, axes.right());
    for (((f, mode_type), x), place) in inside.into_iter().zip(wanted).zip(places) {
        let pen = Pen::new(colour_of(*mode_type), 1.0);
        canvas.line([[x, axes.top()], [x, axes.bottom()]], pen.dashed("5 3"));
        canvas.line([[x, axes.top()], [place, axes.top() - 7.0]], pen);
        let kind = Type::new(10, Anchor::Middle).colour(colour_of(*mode_type));
        let at = [place, axes.top() - 10.0];
        canvas.text(at, kind, format!("{f:.0}"));
    }
}
