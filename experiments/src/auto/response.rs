//! Responses of a turning set whose amplitude is asked for.

use gearset::AutoResponse;
use lumped::ModeType;
use nalgebra::Complex;

use crate::sweep::{Coordinate, Part, SweepPoint};

/// Harmonics 1 to H of one response at one speed: complex amplitudes of each of its coordinates, m.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Harmonics {
    /// By coordinate, then by harmonic: real and imaginary part.
    lines: Vec<[f64; 2]>,
    /// Highest harmonic.
    highest: usize,
}

impl Harmonics {
    /// Those of a steady state; `radius` is the sun's base radius, m.
    pub(super) fn of(
        point: &SweepPoint,
        response: AutoResponse,
        radius: f64,
        highest: usize,
    ) -> Self {
        let coordinates: &[(Coordinate, f64)] = match response {
            AutoResponse::TransmissionError => &[(Coordinate::Rotation, radius)],
            AutoResponse::SunTranslation => {
                &[(Coordinate::Radial, 1.0), (Coordinate::Tangential, 1.0)]
            }
        };
        let one = |(coordinate, factor): &(Coordinate, f64), l: usize| {
            let line = point.state.line(Part::Sun, *coordinate, l);
            line.map_or([0.0; 2], |line| {
                let (sin, cos) = line.phase_rad.sin_cos();
                [factor * line.amplitude * cos, factor * line.amplitude * sin]
            })
        };
        let lines = coordinates.iter().flat_map(|c| (1..=highest).map(move |l| one(c, l)));
        Self { lines: lines.collect(), highest }
    }

    /// Root mean square √(Σ |X_l|²/2), m.
    pub(super) fn rms(&self) -> f64 {
        rms(self.lines.iter().copied())
    }

    /// Root mean square of the difference of two motions, m: at least the difference of their root mean squares.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        rms(self.lines.iter().zip(&other.lines).map(|([a, b], [c, d])| [a - c, b - d]))
    }

    /// Real and imaginary parts by coordinate, then by harmonic from 1, m.
    pub(super) fn lines(&self) -> &[[f64; 2]] {
        &self.lines
    }

    /// The harmonics with what `change` gives for each coordinate of harmonic l added, m.
    pub(super) fn changed(&self, change: impl Fn(usize) -> Vec<Complex<f64>>) -> Self {
        let mut own = self.clone();
        for l in 1..=self.highest {
            let of_harmonic = own.lines.iter_mut().skip(l - 1).step_by(self.highest);
            for ([re, im], change) in of_harmonic.zip(change(l)) {
                *re += change.re;
                *im += change.im;
            }
        }
        own
    }

    /// Share of each harmonic in the mean square, from harmonic 1 on.
    pub(super) fn shares(&self) -> Vec<f64> {
        let square = |l: usize| -> f64 {
            let own = self.lines.iter().skip(l).step_by(self.highest);
            own.map(|[re, im]| 0.5 * (re * re + im * im)).sum()
        };
        let all = self.rms().powi(2);
        (0..self.highest).map(|l| square(l) / all).collect()
    }
}

fn rms(lines: impl Iterator<Item = [f64; 2]>) -> f64 {
    lines.map(|[re, im]| 0.5 * (re * re + im * im)).sum::<f64>().sqrt()
}

/// The modes that move it.
pub(super) fn mode_type(response: AutoResponse) -> ModeType {
    match response {
        AutoResponse::TransmissionError => ModeType::Rotational,
        AutoResponse::SunTranslation => ModeType::Translational,
    }
}

/// In words.
pub(super) fn name(response: AutoResponse) -> &'static str {
    match response {
        AutoResponse::TransmissionError => "dynamic transmission error of the sun",
        AutoResponse::SunTranslation => "translation of the sun",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A harmonic of amplitude A has the root mean square A/√2, harmonics add as squares, and two motions that differ in
    /// phase alone are apart although their root mean squares are equal.
    #[test]
    fn harmonics_add_as_squares_and_phases_part_them() {
        let of = |lines: &[[f64; 2]], highest| Harmonics { lines: lines.to_vec(), highest };
        let both = of(&[[3.0, 0.0], [0.0, 4.0]], 2);
        assert!((both.rms() - 12.5f64.sqrt()).abs() < 1e-15);
        let shares = both.shares();
        assert!((shares[0] - 0.36).abs() < 1e-15 && (shares[1] - 0.64).abs() < 1e-15);
        let (ahead, behind) = (of(&[[1.0, 0.0]], 1), of(&[[0.0, 1.0]], 1));
        assert_eq!(ahead.rms(), behind.rms());
        assert!((ahead.distance(&behind) - 1.0).abs() < 1e-15);
        // Two coordinates of one harmonic.
        assert_eq!(of(&[[1.0, 0.0], [0.0, 1.0]], 1).shares(), [1.0]);
    }
}
