//! Stabilisation chart of an identification: poles over model order; those stable from order to order marked.

use super::ModalTest;
use super::drawing::{Curve, Labels, Panel, Picture, panels};

const STABLE: &str = "#0072b2";
const CHOSEN: &str = "#d55e00";
const PASSING: &str = "#c4c8cc";

/// Poles of every order.
pub(super) fn picture(of: &ModalTest<'_>) -> Picture {
    let (test, chart) = (&of.test, &of.test.identification.chart);
    let ((low, high), modes) = (test.settings.band_hz, of.frequencies());
    let (mut passing, mut stable, mut chosen) = (Vec::new(), Vec::new(), Vec::new());
    for order in chart {
        for pole in order.poles.iter().filter(|p| (low..=high).contains(&p.frequency)) {
            let point = (pole.frequency, order.order as f64);
            let of_order = order.order == test.identification.order;
            let is_mode = |f: &f64| (f - pole.frequency).abs() <= 2e-3 * f;
            if of_order && pole.stable.all() && modes.iter().any(is_mode) {
                chosen.push(point);
            } else if pole.stable.all() {
                stable.push(point);
            } else {
                passing.push(point);
            }
        }
    }
    let curves = vec![
        Curve::new("not stable", passing).dots(2.0, PASSING),
        Curve::new("stable", stable).dots(3.0, STABLE),
        Curve::new("modes", chosen).dots(4.5, CHOSEN),
    ];
    let panel = Panel {
        labels: Labels {
            title: "Poles that stay from order to order",
            subtitle: String::new(),
            x: "frequency, Hz",
            y: "order",
        },
        curves,
        marks: modes,
        x_range: Some((0.0, high)),
        is_log: false,
    };
    panels(&of.scene.title, 1, (1000.0, 520.0), &[panel])
}
