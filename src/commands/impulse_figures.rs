//! Figures of `impulse`: spectra, stabilisation chart, mode shapes, frequencies over the cycle.

use std::path::Path;

use dynamics::{Window, spectrum};
use experiments::modal::{Decay, FrequencyBand, ImpulseTest, ModeBand};
use fe_contact::statics::SUN;
use validation::ValidationError;

use crate::error::CommandError;

use super::figure::{Curve, Labels, Panel, colour, panels};
use super::impulse::Found;
use super::mode_shapes;
use super::picture::Picture;
use super::save;

/// Zeros behind a decay before its spectrum is taken, in lengths of the decay.
const PADDING: usize = 8;

const STABLE: &str = "#0072b2";
const CHOSEN: &str = "#d55e00";
const PASSING: &str = "#c4c8cc";

pub(super) fn draw(found: &Found, folder: &Path) -> Result<(), CommandError> {
    if let Some(svg) = spectra(found)? {
        svg.save(folder, "spectrum")?;
    }
    stabilisation(found).save(folder, "stabilisation")?;
    save(&folder.join("mode_shapes.svg"), &mode_shapes::picture(found))?;
    if let Some(band) = &found.band {
        over_the_cycle(found, band).save(folder, "band")?;
    }
    Ok(())
}

fn frequencies(test: &ImpulseTest) -> Vec<f64> {
    test.modes.iter().map(|m| m.frequency_hz).collect()
}

/// What the sun's translation holds after a force on the sun and after one on the carrier, as in
/// Fig. 3 of Parker, Agashe & Vijayakar (2000); `None` if neither is there to be pushed.
fn spectra(found: &Found) -> Result<Option<Picture>, CommandError> {
    let test = &found.test;
    let pulses = [
        ("sun x force", "The sun's translation after a force pulse on the sun"),
        ("carrier x force", "The sun's translation after a force pulse on the carrier"),
    ];
    let mut list = Vec::new();
    for (name, title) in pulses {
        let Some(decay) = test.decays.iter().find(|d| d.pulse.name == name) else { continue };
        let Some(points) = translation(found, decay)? else { continue };
        list.push(Panel {
            labels: Labels {
                title,
                subtitle: String::new(),
                x: "frequency, Hz",
                y: "amplitude, nm",
            },
            curves: vec![Curve::new("", points)],
            marks: frequencies(test),
            x_range: Some((0.0, test.settings.band_hz.1)),
            is_log: true,
        });
    }
    let title = format!("{}: natural frequencies dashed", found.scene.title);
    Ok((!list.is_empty()).then(|| panels(&title, 1, (900.0, 360.0), &list)))
}

/// Amplitude √(|X|² + |Y|²) of the sun (nm) over frequency (Hz).
fn translation(found: &Found, decay: &Decay) -> Result<Option<Vec<(f64, f64)>>, CommandError> {
    let axes = [0, 1].map(|axis| found.races.of(SUN, axis));
    let [Some(x), Some(y)] = axes else { return Ok(None) };
    let settings = &found.test.settings;
    let of = |i: usize| {
        spectrum(&decay.records[i], settings.preload.step_s, Window::Rectangular, PADDING)
            .map_err(ValidationError::from)
    };
    let (x, y) = (of(x)?, of(y)?);
    let amplitude = x.lines.iter().zip(&y.lines).map(|(x, y)| 1e9 * x.norm().hypot(y.norm()));
    let points = x.frequencies().zip(amplitude);
    Ok(Some(points.take_while(|(f, _)| *f <= settings.band_hz.1).collect()))
}

/// Poles of every order.
fn stabilisation(found: &Found) -> Picture {
    let (test, chart) = (&found.test, &found.test.identification.chart);
    let ((low, high), modes) = (test.settings.band_hz, frequencies(test));
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
    panels(&found.scene.title, 1, (1000.0, 520.0), &[panel])
}

/// Each mode of the test's band over the mesh cycle, then all modes above it as points: what a place
/// among those of its type means may change there from state to state.
fn over_the_cycle(found: &Found, band: &FrequencyBand) -> Picture {
    let (low, high) = found.test.settings.band_hz;
    let points = |mode: &ModeBand, t: usize| -> Vec<(f64, f64)> {
        let own = band.positions.iter().zip(&mode.frequencies_hz[t]);
        own.filter_map(|(p, f)| f.map(|f| (*p, f))).collect()
    };
    let curves = |of: &dyn Fn(usize, String) -> Curve| -> Vec<Curve> {
        let named = band.torques_nm.iter().map(|torque| format!("{torque:.0} N·m"));
        named.enumerate().map(|(t, name)| of(t, name)).collect()
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
    let title = format!("{}: natural frequencies over the mesh cycle", found.scene.title);
    panels(&title, 3, (420.0, 260.0), &list)
}
