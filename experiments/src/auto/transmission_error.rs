//! The cheapest settings for the loaded transmission error at rest.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{LoadCase, Scene};

use super::choice::{AutoError, Choice, ErrorPart};
use super::settings::{AutoSettings, MESHES, divided, phase_parts, size_ratio};
use super::trial::Trial;
use crate::error::ExperimentError;

/// What is read from the transmission error r_b θ of the sun over a mesh cycle at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleValue {
    /// Its largest less its smallest value.
    PeakToPeak,
    /// Its mean.
    Mean,
}

/// The transmission error under a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleRequest {
    /// What is read from it.
    pub value: CycleValue,
    /// Wanted accuracy, percent.
    pub tolerance_percent: f64,
}

impl std::fmt::Display for CycleRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self.value {
            CycleValue::PeakToPeak => "peak-to-peak transmission error of the sun at rest",
            CycleValue::Mean => "mean transmission error of the sun at rest",
        })
    }
}

/// Fewest positions of a candidate; others have two, four and eight times as many, so that those of fewer are among
/// those of more.
const POSITIONS: u32 = 60;

/// Candidates from cheap to dear: number of the mesh, and how often the positions are doubled. A finer mesh costs as much as
/// 5, 15, 60 or 200 positions: gears are meshed and factored, cells of a pair are more.
const ORDER: [(usize, u32); 16] = [
    (0, 0),
    (1, 0),
    (2, 0),
    (0, 1),
    (1, 1),
    (2, 1),
    (0, 2),
    (1, 2),
    (3, 0),
    (2, 2),
    (3, 1),
    (3, 2),
    (0, 3),
    (1, 3),
    (2, 3),
    (3, 3),
];

/// Factor on estimates by extrapolation (grid convergence: Roache 1994).
const SAFETY: f64 = 1.25;

/// Factor on a difference of two means, whose order of convergence is not observed (Roache 1994).
const NO_ORDER: f64 = 3.0;

/// The two coarsest meshes are compared at every second to fifth position, the first of these with which all planets
/// pass through the same phases.
const EVERY: std::ops::RangeInclusive<u32> = 2..=5;

/// Doubling the positions divides the part of the positions by this at most, where they are not yet run: the error is of
/// second order where the curve is smooth, of first order at a corner.
const QUARTERED: f64 = 0.25;

impl CycleRequest {
    /// All candidates for a scene, from cheap to dear.
    pub fn candidates(scene: &Scene) -> Vec<AutoSettings> {
        let base = divided(scene, POSITIONS);
        ORDER.iter().map(|(mesh, doubled)| settings(base, *mesh, *doubled)).collect()
    }

    /// The value of a curve at even positions, m.
    fn of(&self, curve: &[f64]) -> f64 {
        match self.value {
            CycleValue::PeakToPeak => range(curve),
            CycleValue::Mean => mean(curve),
        }
    }
}

fn settings(base: u32, mesh: usize, doubled: u32) -> AutoSettings {
    let (elements, cells) = MESHES[mesh];
    AutoSettings::quasi_static(elements, cells).at_positions(base << doubled)
}

/// The transmission error with given settings, µm.
///
/// # Errors
/// If FE/contact refuses the scene, or the settings have no positions.
pub fn transmission_error_with(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &CycleRequest,
) -> Result<f64, ExperimentError> {
    let own = settings.applied_to(scene);
    let positions = settings.positions.ok_or(ExperimentError::Incomplete("number of positions"))?;
    Ok(1e6 * request.of(&curve(&own, &Bodies::new(&own)?, case, positions)?))
}

/// r_b θ of the sun at even positions of a mesh cycle, m.
fn curve(
    scene: &Scene,
    bodies: &Bodies,
    case: &LoadCase,
    positions: u32,
) -> Result<Vec<f64>, ExperimentError> {
    let sun = bodies.geometry.sun.as_ref().ok_or(ExperimentError::Incomplete("sun"))?;
    let set = StaticSet::new(scene, bodies, case.sense(), Imperfections::default())?;
    let cycle = set.cycle(case.sun_load_nm(), positions as usize, &ActiveSet)?;
    Ok(cycle.states.iter().map(|s| s.transmission_error(sun.base_radius)).collect())
}

/// The cheapest candidate whose estimated error is within the tolerance, with its answer.
///
/// Two parts: elements and cells by the curves on two meshes, positions by the straight lines that the curve follows
/// on either side of its extremes.
///
/// # Errors
/// If FE/contact refuses the scene on all meshes, or no candidate is estimated to be within the tolerance.
pub fn choose_transmission_error(
    scene: &Scene,
    case: &LoadCase,
    request: &CycleRequest,
) -> Result<Choice, AutoError> {
    let trial = Trial::new(request.to_string(), "µm", request.tolerance_percent)?;
    let (base, parts) = (divided(scene, POSITIONS), phase_parts(scene));
    let every = EVERY.into_iter().find(|n| base.is_multiple_of(n * parts)).unwrap_or(1);
    let mut search = Search {
        scene,
        case,
        request,
        trial,
        base,
        every,
        bodies: Default::default(),
        curves: BTreeMap::default(),
        compared: None,
    };
    let found = ORDER.iter().find_map(|(mesh, doubled)| search.tried(*mesh, *doubled));
    search.trial.ended(found)
}

struct Search<'s> {
    scene: &'s Scene,
    case: &'s LoadCase,
    request: &'s CycleRequest,
    trial: Trial,
    /// Positions that are not doubled.
    base: u32,
    /// Meshes are compared at one in so many of them.
    every: u32,
    bodies: [OnceCell<Result<Bodies, String>>; MESHES.len()],
    /// Curves by mesh and number of positions, or why there is none.
    curves: BTreeMap<(usize, u32), Result<Vec<f64>, String>>,
    /// The coarsest mesh that has an answer, and the part of its elements and cells.
    compared: Option<Result<(usize, f64), String>>,
}

impl Search<'_> {
    fn tried(&mut self, mesh: usize, doubled: u32) -> Option<Choice> {
        let settings = settings(self.base, mesh, doubled);
        let (coarsest, of_coarsest) = match self.compared() {
            Ok(found) => found,
            Err(why) => {
                self.trial.refused(settings, why);
                return None;
            }
        };
        if mesh < coarsest {
            let why = self.curve(mesh, self.base).err().cloned().unwrap_or_default();
            self.trial.refused(settings, why);
            return None;
        }
        let of_mesh = of_coarsest * size_ratio(coarsest, mesh);
        let expected = 100.0 * (of_mesh + self.expected_of_positions(doubled));
        if !self.trial.is_expected(settings, expected) {
            return None;
        }
        let curve = match self.curve(mesh, self.base << doubled) {
            Ok(curve) => curve.clone(),
            Err(why) => {
                let why = why.clone();
                self.trial.refused(settings, why);
                return None;
            }
        };
        // Beside a finer mesh the coarsest may prove to be worse than thought.
        let nested: Vec<f64> = curve.iter().step_by(1 << doubled).copied().collect();
        let coarse = self.curve(coarsest, self.base).cloned().unwrap_or_default();
        let seen = match mesh > coarsest {
            true => between_meshes(self.request, &coarse, &nested),
            false => 0.0,
        };
        let of_mesh = of_mesh.max(seen * size_ratio(coarsest, mesh));
        let parts = vec![
            ErrorPart::new("finite elements and contact cells", of_mesh),
            ErrorPart::new("positions of the mesh cycle", between_positions(self.request, &curve)),
        ];
        let value = 1e6 * self.request.of(&curve);
        self.trial.judged(settings, value, parts, || "the transmission error is constant".into())
    }

    /// The curve on a mesh at so many positions, m.
    fn curve(&mut self, mesh: usize, positions: u32) -> Result<&Vec<f64>, &String> {
        let Self { scene, case, base, bodies, curves, .. } = self;
        let found = curves.entry((mesh, positions)).or_insert_with(|| {
            let own = settings(*base, mesh, 0).applied_to(scene);
            let made = bodies[mesh].get_or_init(|| Bodies::new(&own).map_err(|e| e.to_string()));
            let made = made.as_ref().map_err(Clone::clone)?;
            curve(&own, made, case, positions).map_err(|e| e.to_string())
        });
        found.as_ref()
    }

    /// The coarsest mesh that has an answer, and the part of its elements and cells by the next finer one.
    fn compared(&mut self) -> Result<(usize, f64), String> {
        if let Some(known) = &self.compared {
            return known.clone();
        }
        let (base, every) = (self.base, self.every);
        let mut why = String::new();
        let mut coarsest = None;
        for mesh in 0..MESHES.len() - 1 {
            match self.curve(mesh, base) {
                Ok(own) => {
                    coarsest = Some((mesh, own.iter().step_by(every as usize).copied().collect()));
                    break;
                }
                Err(e) => why = e.clone(),
            }
        }
        let found: Result<(usize, f64), String> = match coarsest {
            None => Err(why),
            Some((mesh, own)) => {
                let own: Vec<f64> = own;
                let request = self.request;
                let finer = self.curve(mesh + 1, base / every).map_err(Clone::clone);
                finer.map(|finer| (mesh, between_meshes(request, &own, finer)))
            }
        };
        self.compared = Some(found.clone());
        found
    }

    /// The least part of the positions that is expected with so many; 0 if nothing is known.
    fn expected_of_positions(&self, doubled: u32) -> f64 {
        let at = |d: &u32| {
            let mut own = self.curves.iter().filter(|((_, n), _)| *n == self.base << d);
            own.find_map(|(_, curve)| Some((*d, curve.as_ref().ok()?)))
        };
        let nearest = (0..=doubled).rev().find_map(|d| at(&d));
        nearest.map_or(0.0, |(d, curve)| {
            between_positions(self.request, curve) * QUARTERED.powi((doubled - d) as i32)
        })
    }
}

/// Part of elements and cells of the coarser of two meshes, from both curves at the same positions. Of peak to peak p the
/// difference, but at least half of what it can be,
///
/// ```text
/// |p(a) − p(b)| ≤ p(a − b),   p(x) = max x − min x
/// ```
///
/// so that no cancellation makes it small; of means three times their difference.
fn between_meshes(request: &CycleRequest, coarse: &[f64], fine: &[f64]) -> f64 {
    let difference: Vec<f64> = coarse.iter().zip(fine).map(|(a, b)| a - b).collect();
    match request.value {
        CycleValue::PeakToPeak => {
            let apart = (range(coarse) - range(fine)).abs();
            SAFETY * apart.max(0.5 * range(&difference)) / range(fine)
        }
        CycleValue::Mean => (NO_ORDER * mean(&difference) / mean(fine)).abs(),
    }
}

/// Part of the positions. For peak to peak: between two positions the curve is taken to stay below the straight lines
/// that it follows on either side; what their intersections exceed the highest position by, above and below. Of
/// the mean: its difference to that at every second position.
fn between_positions(request: &CycleRequest, curve: &[f64]) -> f64 {
    SAFETY
        * match request.value {
            CycleValue::PeakToPeak => {
                let mirrored: Vec<f64> = curve.iter().map(|x| -x).collect();
                (overshoot(curve) + overshoot(&mirrored)) / range(curve)
            }
            CycleValue::Mean => {
                let second: Vec<f64> = curve.iter().step_by(2).copied().collect();
                (mean(&second) / mean(curve) - 1.0).abs()
            }
        }
}

fn range(curve: &[f64]) -> f64 {
    let high = curve.iter().fold(f64::NEG_INFINITY, |a, x| a.max(*x));
    high - curve.iter().fold(f64::INFINITY, |a, x| a.min(*x))
}

fn mean(curve: &[f64]) -> f64 {
    curve.iter().sum::<f64>() / curve.len() as f64
}

/// What the intersections of the lines through two positions before and two after each interval of a periodic curve
/// exceed its highest position by, at least 0.
fn overshoot(curve: &[f64]) -> f64 {
    let n = curve.len();
    let highest = curve.iter().fold(f64::NEG_INFINITY, |a, x| a.max(*x));
    let top = |k: usize| {
        let [before, left, right, after] = [0, 1, 2, 3].map(|i| curve[(k + i) % n]);
        // y = left + rise x from the left, y = right + fall (1 − x) from the right
        let (rise, fall) = (left - before, right - after);
        let x = (right + fall - left) / (rise + fall);
        let is_between = rise > 0.0 && fall > 0.0 && (0.0..=1.0).contains(&x);
        if is_between { left + rise * x } else { highest }
    };
    (0..n).map(top).fold(highest, f64::max) - highest
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearset::{SceneKind, template};

    fn request(value: CycleValue, tolerance_percent: f64) -> CycleRequest {
        CycleRequest { value, tolerance_percent }
    }

    fn samples(n: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n).map(|i| of(i as f64 / n as f64)).collect()
    }

    /// The top of a corner wherever it lies between positions, exactly; of a sine at least what the positions miss, and
    /// of second order.
    #[test]
    fn what_positions_miss_is_bounded_at_corners_and_where_the_curve_is_smooth() {
        for place in [0.21, 0.2345, 0.249] {
            let curve = samples(40, |x| 1.0 - (x - place).abs());
            let missed = 1.0 - curve.iter().fold(0.0f64, |a, x| a.max(*x));
            assert!((overshoot(&curve) - missed).abs() < 1e-12, "{place}");
        }
        let sine = |n: usize| samples(n, |x| (std::f64::consts::TAU * (x - 0.2341)).sin());
        let parts = [30, 60, 120].map(|n| {
            let curve = sine(n);
            let missed = 1.0 - curve.iter().fold(0.0f64, |a, x| a.max(*x));
            let part = overshoot(&curve);
            assert!(part >= missed, "{n}: {part} {missed}");
            part
        });
        assert!(parts[0] > 3.0 * parts[1] && parts[1] > 3.0 * parts[2], "{parts:?}");
        assert_eq!(overshoot(&[2.0; 8]), 0.0);
    }

    /// The estimates hold beside a finer mesh at more positions; a smaller tolerance has no cheaper choice, and the
    /// smallest none.
    #[test]
    fn choices_are_within_their_estimates_and_follow_the_tolerance() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let finer = AutoSettings::quasi_static(20, 60).at_positions(divided(&scene, 480));
        for value in [CycleValue::PeakToPeak, CycleValue::Mean] {
            let order = CycleRequest::candidates(&scene);
            let mut last = 0;
            for tolerance in [30.0, 5.0] {
                let asked = request(value, tolerance);
                let choice = choose_transmission_error(&scene, &case, &asked).unwrap();
                let truth = transmission_error_with(&scene, &case, finer, &asked).unwrap();
                let error = 100.0 * (choice.value / truth - 1.0).abs();
                let estimate = choice.estimated_error_percent;
                assert!(error <= estimate && estimate <= tolerance, "{error} {estimate}");
                let place = order.iter().position(|s| *s == choice.settings).unwrap();
                assert!(place >= last, "{tolerance}: {}", choice.settings);
                last = place;
            }
        }
        let refusal =
            choose_transmission_error(&scene, &case, &request(CycleValue::PeakToPeak, 1e-4));
        let Err(AutoError::NothingMeets { passed_over, .. }) = refusal else {
            panic!("{refusal:?}")
        };
        let tried: Vec<AutoSettings> = passed_over.iter().map(|p| p.settings).collect();
        assert_eq!(tried, CycleRequest::candidates(&scene));
    }
}
