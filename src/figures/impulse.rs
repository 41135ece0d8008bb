//! Figures of an impulse test.

use dynamics::SpectrumError;
use experiments::modal::{FrequencyBand, ImpulseTest};
use fe_contact::statics::Races;
use gearset::Geometry;
use scene::Scene;

use super::{Figure, frequency_band, mode_shapes, spectrum, stabilisation};

/// An impulse test with the set it was made on.
#[derive(Debug, Clone, Copy)]
pub struct ModalTest<'a> {
    /// Scene of the set.
    pub scene: &'a Scene,
    /// Its gears.
    pub geometry: &'a Geometry,
    /// Its coordinates.
    pub races: &'a Races,
    /// The test.
    pub test: &'a ImpulseTest,
    /// Linearised frequencies over the mesh cycle, if they are to be drawn.
    pub band: Option<&'a FrequencyBand>,
}

impl ModalTest<'_> {
    /// Frequencies of the identified modes, Hz.
    pub(super) fn frequencies(&self) -> Vec<f64> {
        self.test.modes.iter().map(|m| m.frequency_hz).collect()
    }
}

/// Figures of an impulse test: `spectrum` (if a force pulse on sun or carrier was possible), `stabilisation`,
/// `mode_shapes`, and `band` if there is one.
///
/// # Errors
/// If a record has no spectrum, being too short or not finite.
pub fn of_impulse_test(of: &ModalTest<'_>) -> Result<Vec<Figure>, SpectrumError> {
    let mut figures = Vec::new();
    figures.extend(spectrum::picture(of)?.map(|picture| Figure::new("spectrum", picture)));
    figures.push(Figure::new("stabilisation", stabilisation::picture(of)));
    figures.push(Figure::new("mode_shapes", mode_shapes::picture(of)));
    if let Some(band) = of.band {
        figures.push(Figure::new("band", frequency_band::picture(of, band)));
    }
    Ok(figures)
}
