//! The harmonics of one quantity, one panel each, with marks where they meet natural frequencies.

use super::drawing::{Axis, Label, Panel, Pen, Picture, Series, Symbol, colour_of, panels};
use super::sweep::{Quantity, Spot, Subject};

/// Least range of a panel as a share of the largest amplitude, so that an absent harmonic looks absent.
const FLOOR: f64 = 0.02;

/// By branch: its speeds in the key, and its pen.
const BRANCHES: [(&str, Pen); 2] = [
    ("speeds growing", Pen::new("#000000", 1.4)),
    ("speeds falling", Pen::new("#d55e00", 1.2).dashed()),
];

/// All harmonics of a quantity.
pub(super) fn picture(subject: &Subject, quantity: &Quantity) -> Picture {
    let least = FLOOR * quantity.largest();
    let harmonics = (1..).zip(&quantity.harmonics);
    let list = harmonics.map(|(l, branches)| panel(subject, l, branches, least, quantity.unit));
    let title = format!("{}: {}", subject.title, quantity.title);
    let caption = format!("{}; each harmonic on its own scale", subject.caption);
    panels([&title, &caption], 1, [746.0, 120.0], &list.collect::<Vec<_>>())
}

/// Harmonic l with lines where l f_m is a natural frequency.
fn panel(subject: &Subject, l: u32, branches: &[Vec<Spot>], least: f64, unit: &str) -> Panel {
    let high = 1.08 * Quantity::largest_of(branches).max(least);
    let l_f = f64::from(l);
    let mut series = subject.natural_lines(|f| f / l_f);
    let place = |s: &Spot| (s.mesh_hz, s.amplitude);
    for (spots, (name, pen)) in branches.iter().zip(BRANCHES) {
        let name = if branches.len() > 1 { name } else { "" };
        series.push(Series::new(name, pen, spots.iter().map(place)));
    }
    if !subject.is_settled {
        let unsettled = branches.iter().flatten().filter(|s| !s.is_steady).map(place);
        let name = "repeats after several\nmesh cycles, or not\nshown to attract";
        series.push(Series::new(name, Symbol::Ring(3.0, Pen::new("#d55e00", 1.2)), unsettled));
    }
    let labels = subject.natural.iter().map(|(f, mode_type)| Label {
        point: (f / l_f, high),
        text: format!("{f:.0}"),
        colour: colour_of(*mode_type),
    });
    Panel {
        x: Axis::within("mesh frequency, Hz", 0.0, subject.top_mesh_hz),
        y: Axis::within(format!("l = {l}, {unit}"), 0.0, high),
        series,
        above: labels.collect(),
        ..Panel::default()
    }
}
