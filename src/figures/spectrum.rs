//! Amplitude spectra of the free decays of an impulse test.

use dynamics::{SpectrumError, Window, spectrum};
use experiments::modal::Decay;
use gearset::Body;

use super::ModalTest;
use super::drawing::{Curve, Labels, Panel, Picture, panels};

/// Length of a decay after zero padding, over its own length.
const PADDING: usize = 8;

/// Spectra of the sun's translation after a force pulse on the sun and after one on the carrier, as in Fig. 3
/// of Parker, Agashe & Vijayakar (2000); `None` if the test has neither pulse.
pub(super) fn picture(of: &ModalTest<'_>) -> Result<Option<Picture>, SpectrumError> {
    let test = &of.test;
    let pulses = [
        ("sun x force", "The sun's translation after a force pulse on the sun"),
        ("carrier x force", "The sun's translation after a force pulse on the carrier"),
    ];
    let mut list = Vec::new();
    for (name, title) in pulses {
        let Some(decay) = test.decays.iter().find(|d| d.pulse.name == name) else { continue };
        let Some(points) = translation(of, decay)? else { continue };
        list.push(Panel {
            labels: Labels {
                title,
                subtitle: String::new(),
                x: "frequency, Hz",
                y: "amplitude, nm",
            },
            curves: vec![Curve::new("", points)],
            marks: of.frequencies(),
            x_range: Some((0.0, test.settings.band_hz.1)),
            is_log: true,
        });
    }
    let title = format!("{}: natural frequencies dashed", of.scene.title);
    Ok((!list.is_empty()).then(|| panels(&title, 1, (900.0, 360.0), &list)))
}

/// Amplitude √(|X|² + |Y|²) of the sun (nm) over frequency (Hz).
fn translation(
    of: &ModalTest<'_>,
    decay: &Decay,
) -> Result<Option<Vec<(f64, f64)>>, SpectrumError> {
    let [Some(x), Some(y), _] = of.races.places(Body::Sun) else { return Ok(None) };
    let settings = &of.test.settings;
    let lines = |i: usize| {
        spectrum(&decay.records[i], settings.preload.step_s, Window::Rectangular, PADDING)
    };
    let (x, y) = (lines(x)?, lines(y)?);
    let amplitude = x.lines.iter().zip(&y.lines).map(|(x, y)| 1e9 * x.norm().hypot(y.norm()));
    let points = x.frequencies().zip(amplitude);
    Ok(Some(points.take_while(|(f, _)| *f <= settings.band_hz.1).collect()))
}
