//! A quasi-static set at rest: the energies of its modes, and what its coordinates move a response by.

use fe_contact::vibration::VibratingSet;
use gearset::AutoResponse;
use nalgebra::{Complex, DVector};

use super::energy::{ModeEnergy, of_linear};
use crate::error::ExperimentError;
use crate::sweep::radial;

/// All modes of the set linearised at rest at position 0.
#[derive(Debug)]
pub(super) struct SetModes {
    /// Energies and shapes.
    pub(super) energies: Vec<ModeEnergy>,
    /// What each coordinate of the races moves the coordinates of the response by.
    responses: Vec<Vec<f64>>,
}

impl SetModes {
    /// Those of a set at rest, with what its coordinates move a response by. `first_planet_rad`: ψ₀, towards which the sun's radial
    /// motion points; `radius`: base radius of the sun, m.
    ///
    /// # Errors
    /// If the modes are not found.
    pub(super) fn new(
        set: &VibratingSet<'_>,
        response: AutoResponse,
        (first_planet_rad, radius): (f64, f64),
    ) -> Result<Self, ExperimentError> {
        let energies = of_linear(set, &set.linearised()?)?;
        let count = set.races().count;
        let one = |i: usize| {
            let unit: Vec<f64> = (0..count).map(|j| if i == j { 1.0 } else { 0.0 }).collect();
            let (central, _) = set.displacements_of(&unit);
            let [_, _, [r, t, theta]] = radial(central, first_planet_rad);
            match response {
                AutoResponse::TransmissionError => vec![radius * theta],
                AutoResponse::SunTranslation => vec![r, t],
            }
        };
        Ok(Self { energies, responses: (0..count).map(one).collect() })
    }

    /// Coordinates of the response to a line of the races' coordinates, m.
    pub(super) fn response(&self, line: &DVector<Complex<f64>>) -> Vec<Complex<f64>> {
        let count = self.responses.first().map_or(0, Vec::len);
        let mut sum = vec![Complex::new(0.0, 0.0); count];
        for (own, x) in self.responses.iter().zip(line.iter()) {
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += *x * *own);
        }
        sum
    }
}
