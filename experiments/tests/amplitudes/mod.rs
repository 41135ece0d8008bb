//! Amplitudes by which motions are compared.

use experiments::sweep::{Coordinate, Part, SteadyState};

/// Amplitudes of the sun's rotation, harmonics 1 to 5, rad.
pub(crate) fn rotation(state: &SteadyState) -> [f64; 5] {
    [1, 2, 3, 4, 5].map(|l| state.amplitude(Part::SUN, Coordinate::Rotation, l))
}

/// Largest difference of two motions relative to the larger amplitude of the first.
pub(crate) fn off(a: &[f64; 5], b: &[f64; 5]) -> f64 {
    let size = a.iter().fold(0.0f64, |s, x| s.max(*x));
    a.iter().zip(b).fold(0.0f64, |s, (a, b)| s.max((a - b).abs())) / size
}
