//! Natural frequencies linearised over the mesh cycle.

use experiments::modal::{FrequencyBand, ModeBand};

use super::ModalTest;
use super::drawing::{Curve, Labels, Panel, Picture, colour, panels};

/// Each mode within the test's band over the mesh cycle, then all modes above the band as points, because
/// there the same rank within a type may denote different modes in different states.
pub(super) fn picture(of: &ModalTest<'_>, band: &FrequencyBand) -> Picture {
    let (low, high) = of.test.settings.band_hz;
    let points = |mode: &ModeBand, t: usize| -> Vec<(f64, f64)> {
        let own = band.positions.iter().zip(&mode.frequencies_hz[t]);
        own.filter_map(|(p, f)| f.map(|f| (*p, f))).collect()
    };
    let curves = |one: &dyn Fn(usize, String) -> Curve| -> Vec<Curve> {
        let named = band.torques_nm.iter().map(|torque| format!("{torque:.0} N·m"));
        named.enumerate().map(|(t, name)| one(t, name)).collect()
    };
    let is_below = |m: &&ModeBand| (low..=high).contains(&m.spread().mean);
    let mut charts: Vec<(String, Vec<Curve>)> = band
        .modes
        .iter()
        .filter(is_below)
        .map(|m| {
            let title = format!("{} {}", m.mode_type.name(), m.place);
            (title, curves(&|t, name| Curve::new(name, points(m, t))))
        })
        .collect();
    let above: Vec<&ModeBand> = band.modes.iter().filter(|m| m.spread().mean > high).collect();
    if !above.is_empty() {
        let all = |t: usize| above.iter().flat_map(|m| points(m, t)).collect();
        let dots = |t: usize, name| Curve::new(name, all(t)).dots(1.6, colour(t));
        charts.push(("all modes above".into(), curves(&dots)));
    }
    let panel = |(title, curves)| Panel {
        labels: Labels { title, subtitle: String::new(), x: "mesh cycle", y: "Hz" },
        curves,
        marks: Vec::new(),
        x_range: Some((0.0, 1.0)),
        is_log: false,
    };
    let list: Vec<Panel<'_>> =
        charts.iter_mut().map(|(t, c)| panel((t.as_str(), std::mem::take(c)))).collect();
    let title = format!("{}: natural frequencies over the mesh cycle", of.scene.title);
    panels(&title, 3, (420.0, 260.0), &list)
}
