//! Stabilisation chart of an identification: poles over model order; those stable from order to order marked.

use super::ModalTest;
use super::drawing::{Axis, FOUND, Panel, Picture, Series, Symbol, panels};

/// Poles of every order.
pub(super) fn picture(of: &ModalTest<'_>) -> Picture {
    let identification = &of.test.identification;
    let ((low, high), modes) = (of.test.settings.band_hz, of.frequencies());
    let (mut passing, mut stable, mut chosen) = (Vec::new(), Vec::new(), Vec::new());
    for order in &identification.chart {
        for pole in order.poles.iter().filter(|p| (low..=high).contains(&p.frequency)) {
            let is_mode = |f: &f64| (f - pole.frequency).abs() <= 2e-3 * f;
            let is_chosen = order.order == identification.order && modes.iter().any(is_mode);
            let list = match (pole.stable.all(), is_chosen) {
                (true, true) => &mut chosen,
                (true, false) => &mut stable,
                (false, _) => &mut passing,
            };
            list.push((pole.frequency, order.order as f64));
        }
    }
    let panel = Panel {
        title: "Poles that stay from order to order".into(),
        x: Axis::within("frequency, Hz", 0.0, high),
        y: Axis::linear("order"),
        series: vec![
            Series::new("not stable", Symbol::Disc(2.0, "#c4c8cc"), passing),
            Series::new("stable", Symbol::Disc(3.0, "#0072b2"), stable),
            Series::uprights("", FOUND, modes),
            Series::new("modes", Symbol::Disc(4.5, "#d55e00"), chosen),
        ],
        ..Panel::default()
    };
    panels([&of.scene.title, ""], 1, [760.0, 420.0], &[panel])
}
