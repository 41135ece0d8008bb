//! Resonant peaks of a sweep: where the amplitude of one harmonic is largest.

use super::state::{Coordinate, Part, SteadyState};

/// A quantity whose harmonics have peaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Response {
    /// Rotation of a body, rad.
    Rotation(Part),
    /// Translation of a body: √(R² + T²) of the amplitudes R and T of its radial and tangential displacement
    /// in one harmonic, m. For motion along a straight line it is the amplitude of that motion, for a circular
    /// orbit √2 times the radius.
    Translation(Part),
}

impl Response {
    /// Amplitude of one harmonic.
    pub fn amplitude(self, point: &SteadyState, harmonic: usize) -> f64 {
        match self {
            Self::Rotation(part) => point.amplitude(part, Coordinate::Rotation, harmonic),
            Self::Translation(part) => {
                let of = |c| point.amplitude(part, c, harmonic);
                of(Coordinate::Radial).hypot(of(Coordinate::Tangential))
            }
        }
    }
}

impl Response {
    /// Amplitude and number of the strongest of harmonics 1 to `harmonics`, the lowest of equals; zeros if
    /// all amplitudes are zero.
    pub fn strongest(self, point: &SteadyState, harmonics: usize) -> (f64, usize) {
        let of = |l: usize| (self.amplitude(point, l), l);
        (1..=harmonics).map(of).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a })
    }
}

/// A maximum of one harmonic over speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Harmonic l.
    pub harmonic: usize,
    /// Speed of the input member, rpm.
    pub speed_rpm: f64,
    /// l f_m, Hz.
    pub frequency_hz: f64,
    /// Amplitude there, m or rad.
    pub amplitude: f64,
    /// Amplitude over the larger of the minima to either side, each taken up to where the curve exceeds the
    /// peak; 1 means no peak.
    pub prominence: f64,
}

/// Largest accepted height of a parabola's top above the highest point, in the logarithm of the amplitude.
const HIGHEST: f64 = 0.25;

/// Peaks of one harmonic of points in order of speed: interior maxima with a prominence of at least `least`.
/// Speed and amplitude are those of the parabola through three points in the logarithm of the amplitude.
pub fn peaks(
    points: &[&SteadyState],
    response: Response,
    harmonic: usize,
    least: f64,
) -> Vec<Peak> {
    let a: Vec<f64> = points.iter().map(|p| response.amplitude(p, harmonic)).collect();
    let mut found = Vec::new();
    for i in 1..a.len().saturating_sub(1) {
        if !(a[i] > a[i - 1] && a[i] >= a[i + 1]) {
            continue;
        }
        let lowest = |side: &mut dyn Iterator<Item = &f64>| {
            side.take_while(|x| **x <= a[i]).fold(a[i], |m, x| m.min(*x))
        };
        let left = lowest(&mut a[..i].iter().rev());
        let right = lowest(&mut a[i + 1..].iter());
        let prominence = a[i] / left.max(right);
        if prominence < least || prominence.is_nan() {
            continue;
        }
        let x = [0, 1, 2].map(|k| points[i + k - 1].case.speed_rpm);
        let y = [0, 1, 2].map(|k| a[i + k - 1].max(f64::MIN_POSITIVE).ln());
        let (speed_rpm, top) = match vertex(x, y) {
            // Points that happen to be close together can give steep parabolas.
            Some((speed, top)) if top - y[1] < HIGHEST => (speed, top),
            _ => (x[1], y[1]),
        };
        let hz_per_rpm = points[i].case.mesh_frequency_per_rpm_hz();
        found.push(Peak {
            harmonic,
            speed_rpm,
            frequency_hz: harmonic as f64 * speed_rpm * hz_per_rpm,
            amplitude: top.exp(),
            prominence,
        });
    }
    found
}

/// `[eq:resonant-peak]` Vertex of the parabola through the highest of (place, amplitude) pairs and its neighbours in
/// 1/a², which near a single resonance is a parabola up to terms of third order: with points a half-width apart the
/// error is at most 0.4 % in height and 0.05 % in place.
///
/// Source: closed form.
/// Checked by: `experiments/src/sweep/peaks.rs::three_points_find_a_resonance`.
///
/// Place and height of the peak of pairs in order of place; `None` if the highest is at an end.
pub fn top_of_three(points: impl Iterator<Item = (f64, f64)>) -> Option<(f64, f64)> {
    let list: Vec<(f64, f64)> = points.collect();
    let highest = (0..list.len()).max_by(|i, k| list[*i].1.total_cmp(&list[*k].1))?;
    let three = list.get(highest.checked_sub(1)?..highest + 2)?;
    let (x, y) = ([0, 1, 2].map(|k| three[k].0), [0, 1, 2].map(|k| -three[k].1.powi(-2)));
    vertex(x, y).filter(|(_, top)| *top < 0.0).map(|(place, top)| (place, (-top).powf(-0.5)))
}

/// Top of the parabola through three points, if it has one between them.
fn vertex(x: [f64; 3], y: [f64; 3]) -> Option<(f64, f64)> {
    // Newton's form: y = y₀ + s (x − x₀) + c (x − x₀)(x − x₁)
    let s = (y[1] - y[0]) / (x[1] - x[0]);
    let c = ((y[2] - y[1]) / (x[2] - x[1]) - s) / (x[2] - x[0]);
    let top = 0.5 * (x[0] + x[1]) - 0.5 * s / c;
    let value = y[0] + s * (top - x[0]) + c * (top - x[0]) * (top - x[1]);
    (c < 0.0 && top >= x[0] && top <= x[2]).then_some((top, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The peak may be anywhere between points that are a half-width apart.
    #[test]
    fn three_points_find_a_resonance() {
        for centre in [1618.0, 1624.0, 1630.0, 1641.0] {
            let at = |x: f64| {
                let r = x / centre;
                (x, 1.0 / ((1.0 - r * r).powi(2) + (0.036 * r).powi(2)).sqrt())
            };
            let (place, height) =
                top_of_three([1600.0, 1630.0, 1660.0].map(at).into_iter()).unwrap();
            assert!((place / centre - 1.0).abs() < 1e-3, "{centre}: {place}");
            assert!((height * 0.036 - 1.0).abs() < 4e-3, "{centre}: {height}");
        }
        assert!(top_of_three([(1.0, 1.0), (2.0, 3.0), (3.0, 4.0)].into_iter()).is_none());
    }
    use crate::sweep::Line;

    /// |H| of one degree of freedom at 778 Hz with 2 % damping, excited by the first harmonic.
    #[test]
    fn a_resonance_is_found_and_nothing_else() {
        let points: Vec<SteadyState> = (0..60)
            .map(|i| {
                let f = 600.0 + 6.0 * f64::from(i);
                let r = f / 778.0;
                let amplitude = 1e-6 / ((1.0 - r * r).powi(2) + (0.04 * r).powi(2)).sqrt();
                let line = Line {
                    part: Part::SUN,
                    coordinate: Coordinate::Radial,
                    harmonic: 1,
                    amplitude,
                    phase_rad: 0.0,
                };
                SteadyState {
                    case: scene::LoadCase::turning(1130.0, 2.0 * f, f),
                    lines: vec![line],
                }
            })
            .collect();
        let points: Vec<&SteadyState> = points.iter().collect();
        let found = peaks(&points, Response::Translation(Part::SUN), 1, 1.5);
        assert_eq!(found.len(), 1);
        assert!((found[0].frequency_hz / 777.4 - 1.0).abs() < 1e-3, "{:?}", found[0]);
        assert!((found[0].amplitude / 25e-6 - 1.0).abs() < 0.01, "{:?}", found[0]);
        assert!(peaks(&points, Response::Rotation(Part::SUN), 1, 1.5).is_empty());
    }
}
