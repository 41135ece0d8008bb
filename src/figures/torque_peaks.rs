//! Resonant peaks over torque, as Figs 13 and 14 of Parker, Agashe & Vijayakar (2000).

use validation::{TorquePeak, TorquePeaks};

use super::drawing::{Anchor, Axes, Canvas, Pen, Picture, Scale, Type, colour, spread};

/// The kept peaks of one system (`kept/torque_peaks.toml`): of the sun and of planet 0, and the same
/// harmonics of the sun at rest.
pub fn torque_peaks(kept: &TorquePeaks, system: &str) -> Picture {
    let panel = |title: &str, of: fn(&TorquePeak) -> &[f64]| PeakPanel {
        title: title.into(),
        series: kept
            .peak
            .iter()
            .filter(|p| p.system == system)
            .map(|p| PeakSeries {
                name: format!("{}, l = {}", p.mode, p.harmonic),
                is_dashed: p.mode.contains("translational"),
                points: kept.torques_nm.iter().copied().zip(of(p).iter().copied()).collect(),
            })
            .collect(),
    };
    let panels = [
        panel("sun", |p| &p.sun),
        panel("planet 0", |p| &p.planet),
        panel("sun at rest: the same harmonic", |p| &p.at_rest),
    ];
    let title = format!("OH-58, four planets, {system}: growth with torque");
    draw(
        &title,
        "quasi-static fidelity; peaks over those at 565 N·m; dotted: in proportion",
        &panels,
    )
}

/// A peak's amplitude under several torques.
struct PeakSeries {
    /// Mode, harmonic, body: `rotational 1144 Hz, l = 2, sun rotation`.
    name: String,
    /// Drawn dashed.
    is_dashed: bool,
    /// Torque (N m), amplitude in any unit.
    points: Vec<(f64, f64)>,
}

/// Series of one body (Fig. 13 the sun, Fig. 14 a planet).
struct PeakPanel {
    title: String,
    series: Vec<PeakSeries>,
}

/// Size of a panel's frame and room for names at its right, px.
const PEAKS: [f64; 2] = [430.0, 320.0];
const NAMES: f64 = 250.0;
const LEFT: f64 = 80.0;
const HEAD: f64 = 92.0;
const FOOT: f64 = 56.0;

const PROPORTIONAL: Pen = Pen::new("#9aa0a6", 1.2).dashed("2 3");

/// Peaks over torque, each divided by its amplitude at the lowest torque.
fn draw(title: &str, caption: &str, panels: &[PeakPanel]) -> Picture {
    let cell = LEFT + PEAKS[0] + NAMES;
    let mut canvas = Canvas::new([cell * panels.len().max(1) as f64, HEAD + PEAKS[1] + FOOT]);
    canvas.head(title, caption);
    for (i, panel) in panels.iter().enumerate() {
        peaks(&mut canvas, panel, [LEFT + cell * i as f64, HEAD]);
    }
    canvas.picture()
}

/// Amplitudes divided by that at the lowest torque, by torque; empty if that one is 0.
fn normalised(series: &PeakSeries) -> Vec<(f64, f64)> {
    let mut points = series.points.clone();
    points.retain(|(torque, amplitude)| torque.is_finite() && amplitude.is_finite());
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    match points.first().map(|p| p.1) {
        Some(first) if first > 0.0 => points.into_iter().map(|(t, a)| (t, a / first)).collect(),
        _ => Vec::new(),
    }
}

fn peaks(canvas: &mut Canvas, panel: &PeakPanel, corner: [f64; 2]) {
    let lists: Vec<Vec<(f64, f64)>> = panel.series.iter().map(normalised).collect();
    let all = || lists.iter().flatten();
    let lowest = all().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let highest = all().map(|p| p.0).fold(0.0, f64::max);
    let top = all().map(|p| p.1).fold(1.0, f64::max);
    let axes = Axes {
        x: Scale::linear(0.0, 1.05 * highest),
        y: Scale::linear(0.0, 1.1 * top),
        corner,
        size: PEAKS,
    };
    axes.frame(canvas, [6, 6]);
    axes.title(canvas, &panel.title);
    axes.x_label(canvas, "sun torque, N·m");
    axes.y_label(canvas, "peak over that at the lowest torque");
    let mut names: Vec<(f64, usize)> = Vec::new();
    if highest > lowest {
        // In proportion to torque, up to the upper edge.
        let end = highest.min(lowest * 1.1 * top);
        canvas.line([(lowest, 1.0), (end, end / lowest)].map(|p| axes.at(p)), PROPORTIONAL);
    }
    for (i, (series, points)) in panel.series.iter().zip(&lists).enumerate() {
        let pen = Pen::new(colour(i), 1.6);
        let pen = if series.is_dashed { pen.dashed("7 4") } else { pen };
        canvas.line(points.iter().map(|p| axes.at(*p)), pen);
        for p in points {
            canvas.disc(axes.at(*p), 3.2, colour(i));
        }
        if let Some(last) = points.last() {
            names.push((axes.at(*last)[1], i));
        }
    }
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    let wanted: Vec<f64> = names.iter().map(|n| n.0).collect();
    for ((y, i), place) in names.iter().zip(spread(&wanted, 15.0, axes.bottom() - 24.0)) {
        let end = panel.series[*i].points.iter().map(|p| p.0).fold(0.0, f64::max);
        let from = [axes.at((end, 0.0))[0] + 4.0, *y];
        canvas.line([from, [axes.right() + 8.0, place]], Pen::new(colour(*i), 0.7));
        let kind = Type::new(11, Anchor::Start).colour(colour(*i));
        canvas.text([axes.right() + 11.0, place + 4.0], kind, panel.series[*i].name.clone());
    }
    let y = axes.bottom() - 6.0;
    canvas.line([[axes.right() + 11.0, y - 4.0], [axes.right() + 36.0, y - 4.0]], PROPORTIONAL);
    let grey = Type::new(11, Anchor::Start).colour("#70767c");
    canvas.text([axes.right() + 42.0, y], grey, "in proportion to torque");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_count_from_the_lowest_torque() {
        let of = |points: Vec<(f64, f64)>| {
            normalised(&PeakSeries { name: String::new(), is_dashed: false, points })
        };
        assert_eq!(of(vec![(1130.0, 6.0), (565.0, 2.0)]), [(565.0, 1.0), (1130.0, 3.0)]);
        assert!(of(vec![(565.0, 0.0), (1130.0, 1.0)]).is_empty());
    }
}
