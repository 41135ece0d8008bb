//! Peaks of a series at several torques.

use dynamics::{Window, spectrum};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Body, Facing};
use scene::{LoadCase, Scene};

use super::error::TorqueError;
use super::series::Series;
use crate::model::SteadyStateModel;
use crate::sweep::{Part, Response, SteadySettings, SteadyState};

/// Search for a peak: half-width of the range of speeds about the natural frequency (relative) and number of
/// speeds; then the same about the highest point found.
const SEARCH: (f64, usize) = (0.06, 7);
const CLOSER: (f64, usize) = (0.015, 5);

/// Heights of one series' peaks over torque.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// The resonance.
    pub series: Series,
    /// Speed of the sun's peak at each torque, rpm.
    pub speeds_rpm: Vec<f64>,
    /// Height in the sun at each torque, m or rad.
    pub sun: Vec<f64>,
    /// Height in planet 0.
    pub planet: Vec<f64>,
}

impl Followed {
    /// Heights relative to that at the first torque.
    pub fn growth(heights: &[f64]) -> Vec<f64> {
        heights.iter().map(|h| h / heights[0]).collect()
    }
}

/// Speed (rpm) and amplitude of the largest response over some points; between points from a parabola through
/// the logarithms of three amplitudes.
fn top(points: &[&SteadyState], response: Response, harmonic: usize) -> (f64, f64) {
    let peaks = crate::sweep::peaks(points, response, harmonic, 1.0);
    let highest = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let largest = points
        .iter()
        .map(|p| (p.case.speed_rpm, response.amplitude(p, harmonic)))
        .fold((0.0, 0.0), |a: (f64, f64), b| if b.1 > a.1 { b } else { a });
    highest.map_or(largest, |p| {
        if p.amplitude > largest.1 { (p.speed_rpm, p.amplitude) } else { largest }
    })
}

/// `count` evenly spaced speeds within ±`span` (relative) of a centre, rpm.
fn about(centre: f64, (span, count): (f64, usize)) -> impl Iterator<Item = f64> {
    let at = move |i: usize| 2.0 * i as f64 / (count - 1) as f64 - 1.0;
    (0..count).map(move |i| centre * (1.0 + span * at(i)))
}

/// Follows some series over torques (N m on the sun): a search about the natural frequency, then a finer one
/// about the peaks of the parts in `closer`.
///
/// # Errors
/// [`TorqueError::Model`] if the model fails.
pub fn follow(
    model: &dyn SteadyStateModel,
    scene: &Scene,
    torques_nm: &[f64],
    series: &[Series],
    closer: &[Part],
    tolerance: f64,
) -> Result<Vec<Followed>, TorqueError> {
    let case = LoadCase::of_scene(scene)?;
    let harmonics = SteadySettings::default().harmonics;
    let start = |s: &Series| s.frequency_hz / s.harmonic as f64 / case.mesh_frequency_per_rpm_hz();
    let mut followed: Vec<Followed> = series
        .iter()
        .map(|s| Followed { series: *s, speeds_rpm: vec![], sun: vec![], planet: vec![] })
        .collect();
    for torque in torques_nm {
        let case = case.with_sun_torque(*torque);
        let within = |s: &Series, states: &[SteadyState]| -> Vec<SteadyState> {
            let centre = start(s);
            let is_near = |p: &&SteadyState| {
                (p.case.speed_rpm / centre - 1.0).abs() <= SEARCH.0 + CLOSER.0 + 1e-9
            };
            states.iter().filter(is_near).cloned().collect()
        };
        let mut asked = 0;
        let mut next = |found: &[SteadyState]| -> Option<Vec<f64>> {
            asked += 1;
            match asked {
                // All series in one request: a model may compute speeds in parallel.
                1 => Some(series.iter().flat_map(|s| about(start(s), SEARCH)).collect()),
                2 => {
                    // Sun and planet may peak at different speeds.
                    let mut again = Vec::new();
                    for s in series {
                        let own = within(s, found);
                        let own: Vec<&SteadyState> = own.iter().collect();
                        for part in closer {
                            again.extend(about(top(&own, s.response(*part), s.harmonic).0, CLOSER));
                        }
                    }
                    Some(again)
                }
                _ => None,
            }
        };
        let all = model
            .explore(scene, &case, (harmonics, tolerance), &mut next)
            .map_err(TorqueError::Model)?;
        for own in &mut followed {
            let states = within(&own.series, &all);
            let states: Vec<&SteadyState> = states.iter().collect();
            let of = |part| top(&states, own.series.response(part), own.series.harmonic);
            let (sun, planet) = (of(Part::SUN), of(Part::Body(Body::Planet(0))));
            own.speeds_rpm.push(sun.0);
            own.sun.push(sun.1);
            own.planet.push(planet.1);
        }
    }
    Ok(followed)
}

/// Harmonics of the static deflection over torque: for each torque the amplitudes of harmonics 0 (mean) to 5
/// of the sun's rotation (rad) and translation (m).
///
/// # Errors
/// If a set has no equilibrium.
pub fn static_growth(
    scene: &Scene,
    bodies: &Bodies,
    torques_nm: &[f64],
) -> Result<Vec<[[f64; 6]; 2]>, TorqueError> {
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let set = StaticSet::new(scene, bodies, sense, none)?;
    let mut list = Vec::new();
    for torque in torques_nm {
        let cycle = set.cycle(*torque, 140, &ActiveSet)?;
        let of = |axis: usize| -> Result<[f64; 6], TorqueError> {
            let record: Vec<f64> = cycle.states.iter().map(|s| s.central[2][axis]).collect();
            let lines = spectrum(&record, 1.0, Window::Rectangular, 1)?.lines;
            Ok(std::array::from_fn(|l| lines[l].re.hypot(lines[l].im)))
        };
        let (x, y) = (of(0)?, of(1)?);
        list.push([of(2)?, std::array::from_fn(|l| x[l].hypot(y[l]))]);
    }
    Ok(list)
}
