//! Modes of a quasi-static set at rest, by which the harmonics of its steady states are corrected.

use std::f64::consts::TAU;

use fe_contact::vibration::{ElasticInertia, LinearSet, RaceMode, VibratingSet};
use gearset::AutoResponse;
use nalgebra::{Complex, DVector};

use super::energy::{ModeEnergy, of_linear};
use crate::error::ExperimentError;
use crate::sweep::{Coordinate, Part, SweepPoint, radial};

/// All modes of the set linearised at rest at position 0.
#[derive(Debug)]
pub(super) struct SetModes {
    /// Energies and shapes.
    pub(super) energies: Vec<ModeEnergy>,
    /// Eigenvalues, damping and mesh forces.
    pub(super) races: Vec<RaceMode>,
    /// What each moves the coordinates of the response by, m.
    pub(super) responses: Vec<Vec<f64>>,
    /// φᵀM of each on the displacements of all bodies as steady states have them, kg and kg m.
    momenta: Vec<Vec<f64>>,
}

impl SetModes {
    /// Those of a set at rest, with what they move a response by. `first_planet_rad`: ψ₀, towards which the sun's radial motion
    /// points; `radius`: base radius of the sun, m.
    ///
    /// # Errors
    /// If the modes are not found.
    pub(super) fn new(
        set: &VibratingSet<'_>,
        linear: &LinearSet,
        response: AutoResponse,
        (first_planet_rad, radius): (f64, f64),
    ) -> Result<Self, ExperimentError> {
        let energies = of_linear(set, linear)?;
        let list = energies.iter().map(|m| ((TAU * m.frequency_hz).powi(2), m.shape.as_slice()));
        let races = ElasticInertia::race_modes(set, linear, list)?;
        let one = |mode: &ModeEnergy| {
            let (central, _) = set.displacements_of(&mode.shape);
            let [_, _, [r, t, theta]] = radial(central, first_planet_rad);
            match response {
                AutoResponse::TransmissionError => vec![radius * theta],
                AutoResponse::SunTranslation => vec![r, t],
            }
        };
        let responses = energies.iter().map(one).collect();
        let momenta = energies.iter().map(|m| momentum(set, first_planet_rad, &m.shape)).collect();
        Ok(Self { energies, races, responses, momenta })
    }

    /// Harmonic l of the modal coordinates of a steady state, y = φᵀM q.
    pub(super) fn amplitudes(&self, point: &SweepPoint, l: usize) -> Vec<Complex<f64>> {
        let of_bodies = self.momenta.first().map_or(0, Vec::len) / 3;
        let lines: Vec<Complex<f64>> = (0..of_bodies)
            .flat_map(|k| Coordinate::DISPLACEMENTS.map(|c| point.state.line(Part::body(k), c, l)))
            .map(|line| line.map_or(ZERO, |l| Complex::from_polar(l.amplitude, l.phase_rad)))
            .collect();
        let along = |own: &Vec<f64>| own.iter().zip(&lines).map(|(p, d)| d * *p).sum();
        self.momenta.iter().map(along).collect()
    }
}

const ZERO: Complex<f64> = Complex::new(0.0, 0.0);

/// φᵀM on the displacements of carrier, ring, sun (radial, tangential, rotation) and planets.
fn momentum(set: &VibratingSet<'_>, first_planet_rad: f64, shape: &[f64]) -> Vec<f64> {
    let planets = set.races().psi.len();
    let unit = |place: usize| {
        let mut all = vec![[0.0; 3]; 3 + planets];
        all[place / 3][place % 3] = 1.0;
        let central = radial([all[0], all[1], all[2]], -first_planet_rad);
        set.coordinates_of(central, &all[3..])
    };
    let along = |q: DVector<f64>| -> f64 {
        shape.iter().zip(set.masses()).zip(q.iter()).map(|((phi, m), q)| phi * m * q).sum()
    };
    (0..3 * (3 + planets)).map(|place| along(unit(place))).collect()
}
