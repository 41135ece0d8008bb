//! Natural frequencies linearised over the mesh cycle.

use experiments::modal::{FrequencyBand, ModeBand};

use super::ModalTest;
use super::drawing::{Axis, Panel, Picture, Series, Symbol, colour, curve, panels};

/// Each mode within the test's band over the mesh cycle, then all modes above the band as points, because
/// there the same rank within a type may denote different modes in different states.
pub(super) fn picture(of: &ModalTest<'_>, band: &FrequencyBand) -> Picture {
    let (low, high) = of.test.settings.band_hz;
    let panel = |title: String, modes: &[&ModeBand], symbol: &dyn Fn(usize) -> Symbol| {
        let series = band.torques_nm.iter().enumerate().map(|(t, torque)| {
            let points = modes.iter().flat_map(|mode| {
                let found = band.positions.iter().zip(&mode.frequencies_hz[t]);
                found.filter_map(|(position, f)| Some((*position, (*f)?)))
            });
            Series::new(format!("{torque:.0} N·m"), symbol(t), points)
        });
        Panel {
            title,
            x: Axis::within("mesh cycle", 0.0, 1.0),
            y: Axis::linear("Hz"),
            series: series.collect(),
            ..Panel::default()
        }
    };
    let is_below = |m: &&ModeBand| (low..=high).contains(&m.spread().mean);
    let title = |m: &ModeBand| format!("{} {}", m.mode_type.name(), m.place);
    let below = band.modes.iter().filter(is_below);
    let mut list: Vec<Panel> = below.map(|m| panel(title(m), &[m], &|t| curve(t).into())).collect();
    let above: Vec<&ModeBand> = band.modes.iter().filter(|m| m.spread().mean > high).collect();
    if !above.is_empty() {
        let dots = |t| Symbol::Disc(1.6, colour(t));
        list.push(panel("all modes above".into(), &above, &dots));
    }
    let title = format!("{}: natural frequencies over the mesh cycle", of.scene.title);
    panels([&title, ""], 3, [280.0, 170.0], &list)
}
