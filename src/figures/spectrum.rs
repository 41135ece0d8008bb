//! Amplitude spectra of the free decays of an impulse test.

use dynamics::{SpectrumError, Window, spectrum};
use experiments::modal::Decay;
use gearset::Body;

use super::ModalTest;
use super::drawing::{Axis, FOUND, Panel, Picture, Series, curve, panels};

/// Length of a decay after zero padding, over its own length.
const PADDING: usize = 8;

/// Spectra of the sun's translation after a force pulse on the sun and after one on the carrier, as in Fig. 3
/// of Parker, Agashe & Vijayakar (2000); `None` if the test has neither pulse.
pub(super) fn picture(of: &ModalTest<'_>) -> Result<Option<Picture>, SpectrumError> {
    let mut list = Vec::new();
    for body in ["sun", "carrier"] {
        let name = format!("{body} x force");
        let Some(decay) = of.test.decays.iter().find(|d| d.pulse.name == name) else { continue };
        let Some(points) = translation(of, decay)? else { continue };
        list.push(Panel {
            title: format!("The sun's translation after a force pulse on the {body}"),
            x: Axis::within("frequency, Hz", 0.0, of.test.settings.band_hz.1),
            y: Axis::log("amplitude, nm"),
            series: vec![
                Series::uprights("", FOUND, of.frequencies()),
                Series::new("", curve(0), points),
            ],
            ..Panel::default()
        });
    }
    let title = format!("{}: natural frequencies dashed", of.scene.title);
    Ok((!list.is_empty()).then(|| panels([&title, ""], 1, [780.0, 270.0], &list)))
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
