//! Resonant peaks over torque, as Figs 13 and 14 of Parker, Agashe & Vijayakar (2000).

use validation::{TorquePeak, TorquePeaks};

use super::drawing::{Axis, Label, Panel, Pen, Picture, Series, Symbol, colour, curve, panels};

/// Amplitudes of a peak, one for each torque.
type Amplitudes = fn(&TorquePeak) -> &[f64];

/// The kept peaks of one system (`kept/torque_peaks.toml`), each divided by its amplitude at the lowest torque: of the
/// sun and of planet 0 (Figs 13 and 14), and the same harmonics of the sun at rest.
pub fn torque_peaks(kept: &TorquePeaks, system: &str) -> Picture {
    let peaks: Vec<&TorquePeak> = kept.peak.iter().filter(|p| p.system == system).collect();
    let of_bodies: [(&str, Amplitudes); 3] = [
        ("sun", |p| &p.sun),
        ("planet 0", |p| &p.planet),
        ("sun at rest: the same harmonic", |p| &p.at_rest),
    ];
    let list = of_bodies.map(|(title, of)| panel(title, &kept.torques_nm, &peaks, of));
    let title = format!("OH-58, four planets, {system}: growth with torque");
    let caption = "quasi-static fidelity; peaks over those at 565 N·m; dotted: in proportion";
    panels([&title, caption], 3, [430.0, 320.0], &list)
}

fn panel(title: &str, torques: &[f64], peaks: &[&TorquePeak], of: Amplitudes) -> Panel {
    let lists = peaks.iter().map(|p| normalised(torques, of(p))).collect::<Vec<_>>();
    let all = || lists.iter().flatten();
    let lowest = all().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let highest = all().map(|p| p.0).fold(0.0, f64::max);
    let top = 1.1 * all().map(|p| p.1).fold(1.0, f64::max);
    // Up to the upper edge.
    let end = highest.min(lowest * top);
    let proportion = (highest > lowest).then_some([(lowest, 1.0), (end, end / lowest)]);
    let dotted = Pen::new("#9aa0a6", 1.2).dotted();
    let mut panel = Panel {
        title: title.into(),
        x: Axis::within("sun torque, N·m", 0.0, highest),
        y: Axis::within("peak over that at the lowest torque", 0.0, top),
        series: vec![Series::new(
            "in proportion to torque",
            dotted,
            proportion.into_iter().flatten(),
        )],
        ..Panel::default()
    };
    for (i, (peak, points)) in peaks.iter().zip(lists).enumerate() {
        let is_dashed = peak.mode.contains("translational");
        let pen = if is_dashed { curve(i).dashed() } else { curve(i) };
        let text = format!("{}, l = {}", peak.mode, peak.harmonic);
        panel.beside.extend(points.last().map(|p| Label { point: *p, text, colour: colour(i) }));
        panel.series.push(Series::new("", pen, points.iter().copied()));
        panel.series.push(Series::new("", Symbol::Disc(3.2, colour(i)), points));
    }
    panel
}

/// Amplitudes divided by that at the lowest torque, by torque; empty if that one is 0.
fn normalised(torques: &[f64], amplitudes: &[f64]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> =
        torques.iter().copied().zip(amplitudes.iter().copied()).collect();
    points.retain(|(torque, amplitude)| torque.is_finite() && amplitude.is_finite());
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    match points.first().map(|p| p.1) {
        Some(first) if first > 0.0 => points.into_iter().map(|(t, a)| (t, a / first)).collect(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::normalised;

    #[test]
    fn peaks_count_from_the_lowest_torque() {
        assert_eq!(normalised(&[1130.0, 565.0], &[6.0, 2.0]), [(565.0, 1.0), (1130.0, 3.0)]);
        assert!(normalised(&[565.0, 1130.0], &[0.0, 1.0]).is_empty());
    }
}
