//! Peaks of a series at several torques.

use dynamics::{Window, spectrum};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, LoadCase, Scene};

use super::series::Series;
use crate::error::ExperimentError;
use crate::sweep::{
    FeModel, Memory, Part, Plan, Response, SteadySettings, SteadyState, Sweep, SweepModel, run,
};

/// How far about the natural frequency a peak is looked for, in parts of it, at so many speeds; and
/// how far about the highest of those.
const SEARCH: (f64, usize) = (0.06, 7);
const CLOSER: (f64, usize) = (0.015, 5);

/// Heights of one series' peaks over torque.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// Which resonance.
    pub series: Series,
    /// Speed of the sun's peak at each torque, rpm.
    pub speeds_rpm: Vec<f64>,
    /// Height in the sun at each torque, m or rad.
    pub sun: Vec<f64>,
    /// Height in planet 0.
    pub planet: Vec<f64>,
}

impl Followed {
    /// Heights over that at the first torque.
    pub fn growth(heights: &[f64]) -> Vec<f64> {
        heights.iter().map(|h| h / heights[0]).collect()
    }
}

/// Largest amplitude over some points; between them the parabola through three logarithms.
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

/// Follows some series over torques (N m on the sun); after a search about the natural frequency the
/// peaks of the parts in `closer` are looked at more closely.
///
/// # Errors
/// If a point fails.
pub fn follow(
    scene: &Scene,
    bodies: &Bodies,
    torques_nm: &[f64],
    series: &[Series],
    closer: &[Part],
    tolerance: f64,
) -> Result<Vec<Followed>, ExperimentError> {
    let case = LoadCase::of_scene(scene)?;
    let steady = SteadySettings { tolerance, between_cycles: 0, ..SteadySettings::default() };
    let start = |s: &Series| s.frequency_hz / s.harmonic as f64 / case.mesh_frequency_per_rpm_hz();
    let mut followed: Vec<Followed> = series
        .iter()
        .map(|s| Followed { series: *s, speeds_rpm: vec![], sun: vec![], planet: vec![] })
        .collect();
    for torque in torques_nm {
        let model =
            FeModel::new(scene, bodies, Imperfections::default(), case.with_sun_torque(*torque));
        let model: &dyn SweepModel = &model;
        let centres: Vec<f64> = series.iter().map(start).collect();
        let search = Plan::around(&centres, SEARCH.0, SEARCH.1, steady.clone());
        let wide = run(model, &search, &Memory, &|_| ())?;
        // Sun and planet may peak at speeds of their own.
        let mut centres = Vec::new();
        for ((_, points), s) in wide.chains.iter().zip(series) {
            let points: Vec<&SteadyState> = points.iter().map(|p| &p.state).collect();
            for part in closer {
                centres.push(top(&points, s.response(*part), s.harmonic).0);
            }
        }
        let again = Plan::around(&centres, CLOSER.0, CLOSER.1, steady.clone());
        let near = run(model, &again, &Memory, &|_| ())?;
        for (k, own) in followed.iter_mut().enumerate() {
            let of = |part: Part| {
                let mut chains = vec![wide.chains[k].clone()];
                let count = closer.len();
                chains.extend_from_slice(&near.chains[count * k..count * (k + 1)]);
                let all = Sweep { fidelity: String::new(), chains };
                top(&all.states(), own.series.response(part), own.series.harmonic)
            };
            let (sun, planet) = (of(Part::Sun), of(Part::Planet(0)));
            own.speeds_rpm.push(sun.0);
            own.sun.push(sun.1);
            own.planet.push(planet.1);
        }
    }
    Ok(followed)
}

/// Growth over torque of the static deflection's harmonics: for each torque the amplitudes of
/// harmonics 1…5 of the sun's rotation (rad) and translation (m).
///
/// # Errors
/// If a set has no equilibrium.
pub fn static_growth(
    scene: &Scene,
    bodies: &Bodies,
    torques_nm: &[f64],
) -> Result<Vec<[[f64; 6]; 2]>, ExperimentError> {
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let set = StaticSet::new(scene, bodies, sense, none)?;
    let mut list = Vec::new();
    for torque in torques_nm {
        let cycle = set.cycle(*torque, 140, &ActiveSet)?;
        let of = |axis: usize| -> Result<[f64; 6], ExperimentError> {
            let record: Vec<f64> = cycle.states.iter().map(|s| s.central[2][axis]).collect();
            let lines = spectrum(&record, 1.0, Window::Rectangular, 1)?.lines;
            Ok(std::array::from_fn(|l| lines[l].re.hypot(lines[l].im)))
        };
        let (x, y) = (of(0)?, of(1)?);
        list.push([of(2)?, std::array::from_fn(|l| x[l].hypot(y[l]))]);
    }
    Ok(list)
}
