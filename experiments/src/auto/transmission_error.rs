//! The cheapest settings for the loaded transmission error at rest.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use fe_contact::FeError;
use fe_contact::statics::Bodies;
use gearset::{Geometry, LoadCase, MeshKind, Scene};

use super::analytic_mean::AnalyticMean;
use super::choice::{AutoError, Choice, ErrorPart, Together};
use super::cycle_curve::{Curve, mean, overshoot, range, undershoot};
use super::cycle_request::{CycleRequest, CycleValue, DOUBLINGS, FINER_BELOW, MESHES, POSITIONS};
use super::finer_curve::{Corrected, Sought, corrected};
use super::settings::{AutoSettings, divided, phase_parts, repeats};
use super::trial::Trial;
use crate::error::ExperimentError;

/// Factor on estimates by extrapolation (grid convergence: Roache 1994).
const SAFETY: f64 = 1.25;

/// Flexibility of a mesh of steel teeth in units of 1/(E b).
const TEETH: f64 = 13.0;

/// A finer mesh is first computed at the extremes of the coarser one and at one in so many of its even positions, but at least at so
/// many in the period of the curve.
const COMPARED: [u32; 2] = [5, 4];

/// Share of the tolerance to which a finer mesh's value is known beside all positions of the coarser one.
const OF_TOLERANCE: f64 = 0.05;

/// Doubling the positions divides the part of the positions by this at most, where they are not yet run: the error is of
/// second order where the curve is smooth, of first order at a corner.
const QUARTERED: f64 = 0.25;

/// The cheapest candidate whose estimated error is within the tolerance, with its answer.
///
/// Two parts: elements and cells by what development sets showed, positions by the straight lines that the curve follows
/// on either side of its extremes. Meshes finer than the first that gives an answer are computed at some of its positions, where the curve
/// may have its extremes among them; what may lie between these is a third part.
///
/// # Errors
/// If FE/contact refuses the scene on all meshes, or no candidate is estimated to be within the tolerance.
pub fn choose_transmission_error(
    scene: &Scene,
    case: &LoadCase,
    request: &CycleRequest,
) -> Result<Choice, AutoError> {
    let trial = Trial::new(request.to_string(), "µm", request.tolerance_percent)?;
    let (base, repeats) = (divided(scene, POSITIONS), repeats(scene));
    // The part of the positions of a mean takes every second one, all around the period.
    let is_halved = request.value == CycleValue::PeakToPeak || (base / repeats).is_multiple_of(2);
    let periods = if is_halved { repeats } else { 1 };
    let scenes = std::array::from_fn(|mesh| request.settings(base, mesh, 0).applied_to(scene));
    let in_period = base / periods;
    let bodies = [const { OnceCell::new() }; MESHES.len()];
    let mut search = Search {
        scenes: &scenes,
        case,
        request,
        trial,
        base,
        periods,
        in_period,
        every: compared_every(in_period, base / phase_parts(scene)),
        bodies: &bodies,
        curves: [const { None }; MESHES.len()],
        finer: [const { None }; MESHES.len()],
        run: BTreeMap::default(),
        too_few_cells: 0,
        started: None,
        deflection: deflection(scene, case),
    };
    let in_closed_form = search.in_closed_form(scene);
    let by_contact =
        || request.order().into_iter().find_map(|(mesh, doubled)| search.tried(mesh, doubled));
    let found = in_closed_form.or_else(by_contact);
    search.trial.ended(found)
}

/// A finer mesh is first computed at one in so many of `base` even positions, of which `distinct` are in the period of the curve: a
/// divisor of these, so that all planets pass through the same phases.
fn compared_every(base: u32, distinct: u32) -> u32 {
    let [share, least] = COMPARED;
    let wanted = (distinct / share).max(least);
    let divides = |n: &u32| distinct.is_multiple_of(*n) && base.is_multiple_of(*n);
    (1..=distinct).filter(divides).filter(|n| distinct / n >= wanted).max().unwrap_or(1)
}

/// By how much a mesh of teeth yields under its share of the load, m; 0 for a scene without the geometry that FE/contact needs.
fn deflection(scene: &Scene, case: &LoadCase) -> f64 {
    let Ok(Geometry { sun: Some(sun), face_width, .. }) = Geometry::from_scene(scene) else {
        return 0.0;
    };
    let factor = |kind| scene.fe_contact.flexibility_factor.of(kind);
    let softer = factor(MeshKind::SunPlanet).max(factor(MeshKind::RingPlanet)).max(1.0);
    let force = case.sun_load_nm() / (sun.base_radius * scene.planets.psi_rad.len() as f64);
    TEETH * softer * force / (scene.material.young_modulus_pa * face_width)
}

/// Why FE/contact refuses a mesh; `too_few` is set if it has too few contact cells.
fn reason(error: &ExperimentError, too_few: &mut bool) -> String {
    let is_too_coarse = |e: &FeError| matches!(e, FeError::GridTooCoarse { .. });
    *too_few = match error {
        ExperimentError::Fe(FeError::AtPosition { cause, .. }) => is_too_coarse(cause),
        ExperimentError::Fe(own) => is_too_coarse(own),
        _ => false,
    };
    error.to_string()
}

type Made = Result<Bodies, String>;

/// Position (periods) and value (m) of a candidate's curve, or why there is none.
type Run = Result<Vec<[f64; 2]>, String>;

struct Search<'s> {
    /// The scene on each mesh.
    scenes: &'s [Scene; MESHES.len()],
    case: &'s LoadCase,
    request: &'s CycleRequest,
    trial: Trial,
    /// Positions in a mesh cycle that are not doubled.
    base: u32,
    /// Periods of the curve in a mesh cycle, and those positions in each.
    periods: u32,
    in_period: u32,
    /// A finer mesh is first computed at one in so many of them.
    every: u32,
    bodies: &'s [OnceCell<Made>; MESHES.len()],
    /// The positions computed on each mesh up to the coarsest that has an answer.
    curves: [Option<Result<Curve<'s>, String>>; MESHES.len()],
    /// Those computed on each finer mesh, about the mean configuration of that one.
    finer: [Option<Curve<'s>>; MESHES.len()],
    /// Curves by mesh and doublings, or why there is none.
    run: BTreeMap<(usize, u32), Run>,
    /// Contact cells of which a mesh had too few under the load.
    too_few_cells: u32,
    /// The first mesh that has an answer.
    started: Option<Result<usize, String>>,
    /// By how much a mesh of teeth yields, m.
    deflection: f64,
}

impl<'s> Search<'s> {
    /// The lumped model in closed form, of which the mean alone has an estimate.
    fn in_closed_form(&mut self, scene: &Scene) -> Option<Choice> {
        if !self.is_mean() {
            return None;
        }
        let settings = AutoSettings::LUMPED;
        match AnalyticMean::of(scene, self.case) {
            Ok(found) => {
                let (value, parts) = (1e6 * found.transmission_error, found.error_parts());
                let no_bound = || "the transmission error is zero".into();
                self.trial.judged(settings, value, parts, Together::Squares, no_bound)
            }
            Err(why) => {
                self.trial.refused(settings, why);
                None
            }
        }
    }

    fn tried(&mut self, mesh: usize, doubled: u32) -> Option<Choice> {
        let settings = self.request.settings(self.base, mesh, doubled);
        let coarsest = match self.started() {
            Ok(found) => found,
            Err(why) => {
                self.trial.refused(settings, why);
                return None;
            }
        };
        let value = self.largest_expected(coarsest);
        let of_mesh = self.request.error_of_mesh(mesh, self.deflection, value);
        let expected = 100.0 * (of_mesh + self.expected_of_positions(doubled));
        if mesh < coarsest {
            let refused = self.run.get(&(mesh, 0)).and_then(|run| run.as_ref().err());
            let finer_first = || {
                format!(
                    "not run: below a tolerance of {FINER_BELOW} % finer elements are the first"
                )
            };
            let why = refused.cloned().unwrap_or_else(finer_first);
            self.trial.refused(settings, why);
            return None;
        }
        if !self.trial.is_expected(settings, expected) {
            return None;
        }
        let found = match mesh > coarsest {
            true => self.corrected((coarsest, mesh), doubled),
            false => self.curve(mesh, doubled).map(|points| Corrected { points, doubt: 0.0 }),
        };
        let Corrected { points, doubt } = match found {
            Ok(found) => found,
            Err(why) => {
                self.trial.refused(settings, why);
                return None;
            }
        };
        let value = self.request.of(&points);
        let mut of_mesh = self.request.error_of_mesh(mesh, self.deflection, value);
        if mesh > coarsest {
            // Beside a finer mesh the first may prove to be worse than thought, and then this one as well.
            let thought = self.request.error_of_mesh(coarsest, self.deflection, value);
            of_mesh *= (self.beside_first(coarsest, mesh) / thought).max(1.0);
        }
        let mut parts = vec![
            ErrorPart::new("finite elements and contact cells", of_mesh),
            ErrorPart::new("positions of the mesh cycle", between_positions(self.request, &points)),
        ];
        if mesh > coarsest {
            let source = "positions at which the coarser mesh stands for the finer one";
            parts.push(ErrorPart::new(source, (doubt / value).abs()));
        }
        let no_bound = || "the transmission error is constant".into();
        self.trial.judged(settings, 1e6 * value, parts, Together::Sum, no_bound)
    }

    fn bodies(&self, mesh: usize) -> Result<&'s Bodies, String> {
        let (all, scenes) = (self.bodies, self.scenes);
        let made = all[mesh].get_or_init(|| {
            // The same elements with other cells are the same bodies.
            let same = (0..mesh).filter(|own| MESHES[*own].0 == MESHES[mesh].0);
            match same.filter_map(|own| all[own].get()?.as_ref().ok()).next() {
                Some(known) => Ok(known.with_cells(MESHES[mesh].1)),
                None => Bodies::new(&scenes[mesh]).map_err(|e| e.to_string()),
            }
        });
        made.as_ref().map_err(Clone::clone)
    }

    /// The positions computed on a mesh.
    fn positions(&mut self, mesh: usize) -> Result<&mut Curve<'s>, String> {
        if self.curves[mesh].is_none() {
            let division = (self.periods, self.in_period << DOUBLINGS);
            let (scenes, case) = (self.scenes, self.case);
            let mut too_few = false;
            let made = self.bodies(mesh).and_then(|bodies| {
                let made = Curve::new(&scenes[mesh], bodies, case, division);
                made.map_err(|e| reason(&e, &mut too_few))
            });
            self.curves[mesh] = Some(made);
            self.note_cells(mesh, too_few);
        }
        match &mut self.curves[mesh] {
            Some(Ok(curve)) => Ok(curve),
            Some(Err(why)) => Err(why.clone()),
            None => Err(String::new()),
        }
    }

    /// The curve of a candidate: position (cycles) and value (m).
    fn curve(&mut self, mesh: usize, doubled: u32) -> Result<Vec<[f64; 2]>, String> {
        if let Some(known) = self.run.get(&(mesh, doubled)) {
            return known.clone();
        }
        let (base, value) = (self.in_period, self.request.value);
        let mut too_few = false;
        let found = self.positions(mesh).and_then(|curve| {
            let found = match value {
                CycleValue::PeakToPeak if doubled > 0 => curve.refine(base, base << doubled),
                _ => curve.at(&curve.even(base << doubled)).map(drop),
            };
            found.map(|()| curve.points()).map_err(|e| reason(&e, &mut too_few))
        });
        self.note_cells(mesh, too_few);
        self.run.insert((mesh, doubled), found.clone());
        found
    }

    fn note_cells(&mut self, mesh: usize, too_few: bool) {
        if too_few {
            self.too_few_cells = self.too_few_cells.max(MESHES[mesh].1);
        }
    }

    /// The curve of a candidate on a mesh finer than the coarsest, at its even positions and those about its extremes.
    fn corrected(
        &mut self,
        (coarsest, mesh): (usize, usize),
        doubled: u32,
    ) -> Result<Corrected, String> {
        self.curve(coarsest, if self.is_mean() { doubled } else { 0 })?;
        let mut finer = match self.finer[mesh].take() {
            Some(finer) => finer,
            None => self.beside(coarsest, mesh)?,
        };
        let share = 0.01 * OF_TOLERANCE * self.request.tolerance_percent;
        let about = self.in_period << doubled;
        let (even, sought) = match self.request.value {
            CycleValue::Mean => (about, Sought::Mean),
            CycleValue::PeakToPeak => (self.in_period, Sought::Extremes { about }),
        };
        let coarse = &*self.positions(coarsest)?;
        let found = corrected((coarse, even), &mut finer, sought, share);
        let found = found.map_err(|e| e.to_string());
        let points = found.as_ref().map(|found| found.points.clone());
        self.run.insert((mesh, doubled), points.map_err(Clone::clone));
        self.finer[mesh] = Some(finer);
        found
    }

    fn is_mean(&self) -> bool {
        self.request.value == CycleValue::Mean
    }

    /// A finer mesh about the mean configuration of a coarser one, at the positions at which they are compared.
    fn beside(&mut self, coarse: usize, finer: usize) -> Result<Curve<'s>, String> {
        let bodies = self.bodies(finer)?;
        let list = self.positions_beside(coarse)?;
        let mut own = self.positions(coarse)?.on_bodies(bodies);
        own.at(&list).map_err(|e| e.to_string())?;
        Ok(own)
    }

    /// Some even positions, and of peak to peak those of the extremes: p changes by as much as the curve there, to first
    /// order.
    fn positions_beside(&mut self, mesh: usize) -> Result<Vec<u32>, String> {
        let (base, every, is_mean) = (self.in_period, self.every, self.is_mean());
        let coarse = self.positions(mesh)?;
        let even = coarse.even(base);
        let values = coarse.at(&even).map_err(|e| e.to_string())?;
        let mut list: Vec<u32> = even.iter().step_by(every as usize).copied().collect();
        if !is_mean {
            let place = |sign: f64| {
                let of = |k: &usize| sign * values[*k];
                (0..values.len()).max_by(|a, b| of(a).total_cmp(&of(b))).map(|k| even[k])
            };
            list.extend([place(1.0), place(-1.0)].into_iter().flatten());
            list.sort_unstable();
            list.dedup();
        }
        Ok(list)
    }

    /// By what part the value on the first mesh is another than that on a finer one, at the positions of that.
    fn beside_first(&mut self, coarsest: usize, mesh: usize) -> f64 {
        let fine = self.finer[mesh].as_ref().map(Curve::known);
        let list: Vec<(u32, f64)> = fine.into_iter().flatten().map(|(x, y)| (*x, *y)).collect();
        let (positions, fine): (Vec<u32>, Vec<f64>) = list.into_iter().unzip();
        let coarse = self.positions(coarsest).ok().map(|curve| curve.at(&positions));
        let coarse = coarse.and_then(Result::ok).unwrap_or_default();
        between_meshes(self.request, &coarse, &fine).abs()
    }

    /// The first mesh that has an answer.
    fn started(&mut self) -> Result<usize, String> {
        if self.started.is_none() {
            let mut why = String::new();
            let first = self.request.first_mesh();
            let found = (first..MESHES.len()).find_map(|mesh| {
                let cells = MESHES[mesh].1;
                if cells <= self.too_few_cells {
                    let why = format!("not run: {cells} contact cells are too few, as above");
                    self.run.insert((mesh, 0), Err(why));
                    return None;
                }
                self.curve(mesh, 0).map_err(|e| why = e).ok().map(|_| mesh)
            });
            self.started = Some(found.ok_or(why));
        }
        self.started.clone().unwrap_or_else(|| Err(String::new()))
    }

    /// The value on the first mesh at the most positions that are known, and of a peak to peak what corners between them may add, m;
    /// infinite if none are.
    fn largest_expected(&self, coarsest: usize) -> f64 {
        let own = self.run.iter().rev().filter(|((mesh, _), _)| *mesh == coarsest);
        let Some(points) = own.flat_map(|(_, points)| points.as_ref().ok()).next() else {
            return f64::INFINITY;
        };
        let added = if self.is_mean() { 0.0 } else { between_positions(self.request, points) };
        self.request.of(points) * (1.0 + added)
    }

    /// The least part of the positions that is expected with so many; 0 if nothing is known.
    fn expected_of_positions(&self, doubled: u32) -> f64 {
        let at = |d: &u32| {
            let mut own = self.run.iter().filter(|((_, n), _)| n == d);
            own.find_map(|(_, points)| Some((*d, points.as_ref().ok()?)))
        };
        let nearest = (0..=doubled).rev().find_map(|d| at(&d));
        nearest.map_or(0.0, |(d, points)| {
            between_positions(self.request, points) * QUARTERED.powi((doubled - d) as i32)
        })
    }
}

/// By what part the value of a curve on a coarser mesh is another than that on a finer one, from both at the same positions.
fn between_meshes(request: &CycleRequest, coarse: &[f64], fine: &[f64]) -> f64 {
    let of = |list: &[f64]| request.of(&list.iter().map(|y| [0.0, *y]).collect::<Vec<_>>());
    of(coarse) / of(fine) - 1.0
}

/// Part of the positions. For peak to peak: between two positions the curve is taken to stay below the straight lines
/// that it follows on either side; what their intersections exceed the highest position by, above and below. Of
/// the mean: its difference to that at every second position.
fn between_positions(request: &CycleRequest, points: &[[f64; 2]]) -> f64 {
    SAFETY
        * match request.value {
            CycleValue::PeakToPeak => (overshoot(points) + undershoot(points)) / range(points),
            CycleValue::Mean => {
                let second: Vec<[f64; 2]> = points.iter().step_by(2).copied().collect();
                (mean(&second) / mean(points) - 1.0).abs()
            }
        }
}

#[cfg(test)]
mod tests {
    use super::super::cycle_with_settings::transmission_error_with;
    use super::*;
    use gearset::{SceneKind, template};

    fn request(value: CycleValue, tolerance_percent: f64) -> CycleRequest {
        CycleRequest { value, tolerance_percent }
    }

    /// A set that turns into itself has at the position of the turned set the same transmission error; a set that does not, has not.
    #[test]
    fn transmission_errors_repeat_where_sets_turn_into_themselves() {
        let with = |steps: &[i64]| {
            let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
            let total = 27 + 99;
            scene.planets.steps = Some(steps.to_vec());
            let psi = steps.iter().map(|s| std::f64::consts::TAU * *s as f64 / f64::from(total));
            scene.planets.psi_rad = psi.collect();
            AutoSettings::quasi_static(6, 20).applied_to(&scene)
        };
        // 27 teeth of the sun: two pairs opposite each other, three evenly spaced planets in phase, four with one moved.
        for (steps, expected) in [
            (&[0i64, -31, 63, 32][..], 2),
            (&[0, 42, 84], 1),
            (&[0, 31, 63, 95], 1),
            (&[0, 32, 63, 95], 2),
        ] {
            let scene = with(steps);
            assert_eq!(repeats(&scene), expected, "{steps:?}");
            let case = LoadCase::of_scene(&scene).unwrap();
            let bodies = Bodies::new(&scene).unwrap();
            let mut curve = Curve::new(&scene, &bodies, &case, (1, 12)).unwrap();
            let all = curve.at(&curve.even(12)).unwrap();
            let apart: Vec<f64> = (0..6).map(|i| all[i + 6] - all[i]).collect();
            let size = |list: &[f64]| list.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            let most = size(&apart) / range(&curve.points());
            println!("{steps:?}: half a cycle on {most:.1e} of peak to peak");
            assert_eq!(most < 1e-4, expected == 2, "{steps:?}: {most:e}");
        }
    }

    /// The estimates hold beside a finer mesh at more positions; a smaller tolerance has no cheaper choice, and the
    /// smallest none.
    #[test]
    fn choices_are_within_their_estimates_and_follow_the_tolerance() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let finer = AutoSettings::quasi_static(20, 60).at_positions(divided(&scene, 480));
        for value in [CycleValue::PeakToPeak, CycleValue::Mean] {
            let order = request(value, 1.0).candidates(&scene);
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
        assert_eq!(tried, request(CycleValue::PeakToPeak, 1.0).candidates(&scene));
    }
}
