//! The cheapest settings for the amplitude of a steady state, the largest over the speeds of a sweep.

use gearset::{AutoResponse, LoadCase, MeshKind, Scene};

use super::amplitude_run::{Motions, Turning, on};
use super::choice::{AutoError, Choice, ErrorPart, total};
use super::energy::of_linear;
use super::error_parts::SetSize;
use super::frequency::BODY_INERTIA;
use super::response::{mode_type, name};
use super::settings::{AutoSettings, MESHES, phase_parts, size_ratio};
use super::trial::Trial;
use crate::error::ExperimentError;
use crate::sweep::{SteadySettings, Sweep};

/// The amplitude of a steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct AmplitudeRequest {
    /// Which motion: its root mean square in the harmonics that are kept.
    pub response: AutoResponse,
    /// Speeds of the driven member, ascending, rpm: the largest root mean square over them is asked for.
    pub speeds_rpm: Vec<f64>,
    /// How steady states are found, and the highest harmonic.
    pub steady: SteadySettings,
    /// Wanted accuracy, percent.
    pub tolerance_percent: f64,
}

impl std::fmt::Display for AmplitudeRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, highest) = (name(self.response), self.steady.harmonics);
        write!(f, "root mean square of harmonics 1 to {highest} of the {name}")?;
        match self.speeds_rpm.as_slice() {
            [speed] => write!(f, " at {speed} rpm"),
            [first, .., last] => write!(f, ", the largest from {first} to {last} rpm"),
            [] => Ok(()),
        }
    }
}

/// A choice, and the sweep that gave it.
#[derive(Debug)]
pub struct ChosenSweep {
    /// Settings, value and estimated error.
    pub choice: Choice,
    /// Steady states at all speeds.
    pub sweep: Sweep,
}

/// Fewest steps of a candidate; others are doubled. Fewer than 60 have fewer than 12 in a period of harmonic 5.
const STEPS: u32 = 60;

/// Numbers of steps are compared with one in so many of those of the coarsest candidate, which has the tables.
const EVERY: u32 = 2;

/// Meshes are compared with one in three of its steps, or one in two if all planets pass through the same phases with these
/// alone.
const EVERY_OF_MESHES: [u32; 2] = [3, 2];

/// Quasi-static candidates from cheap to dear: number of the mesh, and how often the steps are doubled.
const QUASI_STATIC: [(usize, u32); 9] =
    [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (0, 2), (1, 2), (2, 2)];

/// Candidates with modes of each body, and how many.
const MODAL: [(usize, u32); 2] = [(0, 1), (1, 2)];
const MODES: u32 = 4;

/// Formal order at which amplitudes converge with the steps; where a candidate moves by more than that explains, its own
/// distance from the coarsest decides.
const STEP_ORDER: f64 = 2.0;

/// Factor on differences of two meshes and of two numbers of steps (grid convergence: Roache 1994).
const SAFETY: f64 = 1.25;

/// Harmonics with a smaller share of the mean square are left out of the part of inertia: one that is off by all of
/// itself changes the root mean square by half of its share.
const MATTERS: f64 = 1e-3;

/// Largest shift of natural frequencies up to which a shift of the speed stands for it.
const LARGEST_SHIFT: f64 = 0.05;

/// Factor from the change in the last cycle to what is left to go: transients fall by a tenth or more in a cycle.
const LEFT_TO_GO: f64 = 10.0;

/// Smallest amplitude over that of the whole motion of the sun: what planet phasing forbids is below it.
const FORBIDDEN: f64 = 1e-7;

impl AmplitudeRequest {
    /// All candidates for a scene, from cheap to dear.
    pub fn candidates(scene: &Scene) -> Vec<AutoSettings> {
        let base = base(scene);
        let of = |list: &[(usize, u32)], modes| -> Vec<AutoSettings> {
            list.iter().map(|(mesh, doubled)| settings(base << doubled, *mesh, modes)).collect()
        };
        let kinds = [MeshKind::SunPlanet, MeshKind::RingPlanet];
        // A planet that vibrates within itself cannot be softer for one mesh alone.
        let has_modes = kinds.iter().all(|k| scene.fe_contact.flexibility_factor.of(*k) == 1.0);
        let modal = if has_modes { of(&MODAL, Some(MODES)) } else { Vec::new() };
        of(&QUASI_STATIC, None).into_iter().chain(modal).collect()
    }
}

/// Steps of a candidate that are not doubled, so that all planets pass through the same phases: a multiple of those with which
/// candidates are compared.
fn base(scene: &Scene) -> u32 {
    let parts = phase_parts(scene);
    let least = |every: u32| STEPS.div_ceil(every * parts) * every * parts;
    // A multiple of six and of the parts; parts that share a factor with six need no more steps for it.
    (least(1)..=least(6)).find(|n| n.is_multiple_of(6) && n.is_multiple_of(parts)).unwrap_or(STEPS)
}

fn settings(steps: u32, mesh: usize, modes: Option<u32>) -> AutoSettings {
    let (elements, cells) = MESHES[mesh];
    let own = match modes {
        Some(modes) => AutoSettings::modal(modes, elements, cells),
        None => AutoSettings::quasi_static(elements, cells),
    };
    own.with_steps(steps)
}

/// Harmonics of the response at all speeds of a request with given settings: by speed, then by coordinate and harmonic,
/// real and imaginary part, µm.
///
/// # Errors
/// If the settings are refused, or a motion does not become steady.
pub fn amplitude_with(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &AmplitudeRequest,
) -> Result<Vec<Vec<[f64; 2]>>, ExperimentError> {
    let found = on((scene, case), settings, request, |own| own.motions(&request.speeds_rpm))?;
    let in_um = |line: &[f64; 2]| line.map(|x| 1e6 * x);
    Ok(found.responses().map(|own| own.lines().iter().map(in_um).collect()).collect())
}

/// The cheapest candidate whose estimated error is within the tolerance, with its answer and its sweep.
///
/// Indicators are taken on the coarsest mesh that gives an answer: half as many of its steps, the next finer mesh at some of
/// them, and speeds shifted by what the inertia that is left out may shift natural frequencies by.
///
/// # Errors
/// If no candidate has the amplitude, or none is estimated to be within the tolerance.
pub fn choose_amplitude(
    scene: &Scene,
    case: &LoadCase,
    request: &AmplitudeRequest,
) -> Result<ChosenSweep, AutoError> {
    let mut trial = Trial::new(request.to_string(), "µm", request.tolerance_percent)?;
    let size = SetSize::new(scene, case)?;
    let (of, base) = ((scene, case), base(scene));
    let first = (0..MESHES.len() - 1).find_map(|mesh| {
        let own = settings(base, mesh, None);
        match on(of, own, request, |turning| indicated(turning, case, (&size, mesh), request)) {
            Ok(found) => Some((mesh, found)),
            Err(e) => {
                trial.refused(own, e);
                None
            }
        }
    });
    let Some((mesh, Indicated { motions, inertia, speeds, of_mesh, of_steps })) = first else {
        return Err(trial.refusal());
    };
    let parts = Parts { mesh, of_mesh, of_steps, inertia };
    let search = Search { of, request, size: &size, base, coarsest: &motions, speeds, parts };
    let found = search.quasi_static(&mut trial).or_else(|| search.modal(&mut trial));
    match found {
        Some((choice, sweep)) => {
            let sweep = sweep.unwrap_or(motions.sweep);
            Ok(ChosenSweep { choice: trial.with(choice), sweep })
        }
        None => Err(trial.refusal()),
    }
}

/// What the coarsest candidate shows.
struct Indicated {
    motions: Motions,
    /// Part of the inertia that is left out; infinite where there is no bound.
    inertia: f64,
    /// Speeds near the top, rpm.
    speeds: Vec<f64>,
    /// Part of elements and cells.
    of_mesh: f64,
    /// Part of the steps.
    of_steps: f64,
}

fn indicated(
    turning: &Turning<'_>,
    case: &LoadCase,
    (size, mesh): (&SetSize, usize),
    request: &AmplitudeRequest,
) -> Result<Indicated, ExperimentError> {
    let motions = turning.motions(&request.speeds_rpm)?;
    let all = motions.of_sun(turning);
    // NaN is refused.
    let is_allowed = motions.largest() > FORBIDDEN * all;
    if !is_allowed {
        let highest = request.steady.harmonics;
        let why = format!(
            "planet phasing forbids the {} in harmonics 1 to {highest}: its amplitude is rounding",
            name(request.response)
        );
        return Err(ExperimentError::Model(why.into()));
    }
    let speeds = motions.near_top();
    let shift = shift(turning, case, size, request, &motions)?;
    let inertia = match shift <= LARGEST_SHIFT {
        true => {
            let shifted = |by: f64| -> Result<f64, ExperimentError> {
                let list: Vec<f64> = speeds.iter().map(|rpm| rpm * (1.0 + by)).collect();
                let off = turning.motions(&list)?.largest() / motions.largest() - 1.0;
                Ok(off.abs())
            };
            shifted(shift)?.max(shifted(-shift)?) + 2.0 * shift
        }
        false => f64::INFINITY,
    };
    let fewer = turning.thinned(EVERY, |own| own.motions(&speeds))?;
    let of_steps = SAFETY * motions.apart(&fewer) / (f64::from(EVERY).powf(STEP_ORDER) - 1.0);
    let (steps, parts) = (turning.scene.dynamics.steps_per_cycle, phase_parts(turning.scene));
    let every = EVERY_OF_MESHES.into_iter().find(|n| (steps / n).is_multiple_of(parts));
    let every = every.unwrap_or(EVERY);
    let beside = settings(steps / every, mesh + 1, None);
    let needed = |e: ExperimentError| {
        ExperimentError::Model(format!("{beside}, which its estimate needs: {e}").into())
    };
    let finer = turning.on_mesh(beside, |own| own.motions(&speeds)).map_err(needed)?;
    let of_mesh = match every == EVERY {
        true => fewer.apart(&finer),
        false => turning.thinned(every, |own| own.motions(&speeds))?.apart(&finer),
    };
    let of_mesh = SAFETY * of_mesh;
    Ok(Indicated { motions, inertia, speeds, of_mesh, of_steps })
}

/// What the inertia that is left out may shift the natural frequencies by which the response is excited (share): of each
/// harmonic l that matters the bound of the nearest mode of the kind that moves it, at the higher of its frequency
/// and l f_m, weighted with the harmonic's share of the mean square at the speed of the largest amplitude.
fn shift(
    turning: &Turning<'_>,
    case: &LoadCase,
    size: &SetSize,
    request: &AmplitudeRequest,
    motions: &Motions,
) -> Result<f64, ExperimentError> {
    let (rpm, top) = motions.top().ok_or(ExperimentError::Incomplete("steady state"))?;
    let f_m = case.at_speed(*rpm).mesh_frequency_hz;
    let kind = mode_type(request.response);
    let set = turning.standing()?;
    let linear = set.linearised()?;
    let mut modes = of_linear(&set, &linear)?;
    modes.retain(|mode| mode.mode_type == kind);
    let mut sum = 0.0;
    for (share, l) in top.shares().into_iter().zip(1..).filter(|(share, _)| *share > MATTERS) {
        let f = f64::from(l) * f_m;
        let distance = |hz: f64| (hz / f).ln().abs();
        let nearest = modes
            .iter()
            .min_by(|a, b| distance(a.frequency_hz).total_cmp(&distance(b.frequency_hz)))
            .ok_or(ExperimentError::Incomplete("mode that moves the response"))?;
        let mut own = nearest.clone();
        own.frequency_hz = own.frequency_hz.max(f);
        sum += share * size.body_inertia(&own);
    }
    Ok(sum)
}

/// Parts of the error of the coarsest candidate, shares of the amplitude.
struct Parts {
    /// Number of its mesh.
    mesh: usize,
    of_mesh: f64,
    of_steps: f64,
    inertia: f64,
}

impl Parts {
    /// Elements and cells: the difference of the two coarsest meshes is the error of the coarser one, and it falls with
    /// the size of the elements.
    fn of_mesh(&self, mesh: usize) -> f64 {
        self.of_mesh * size_ratio(self.mesh, mesh)
    }

    /// Steps: by the formal order with each doubling.
    fn of_steps(&self, doubled: u32) -> f64 {
        self.of_steps * 2f64.powf(-STEP_ORDER * f64::from(doubled))
    }

    /// The part of the steps of a candidate that was run: at least what its own distance from the coarsest candidate says,
    /// less what the meshes explain of it.
    fn of_steps_seen(&self, mesh: usize, doubled: u32, apart: f64) -> f64 {
        if doubled == 0 {
            return self.of_steps;
        }
        let explained = if mesh == self.mesh { 0.0 } else { self.of_mesh };
        let ratio = 2f64.powf(STEP_ORDER * f64::from(doubled));
        self.of_steps(doubled).max(SAFETY * (apart - explained).max(0.0) / (ratio - 1.0))
    }
}

const MESH: &str = "finite elements and contact cells";
const TIME_STEPS: &str = "time steps";
const PERIODICITY: &str = "periodicity of the steady state";

struct Search<'s> {
    of: (&'s Scene, &'s LoadCase),
    request: &'s AmplitudeRequest,
    size: &'s SetSize,
    /// Steps that are not doubled.
    base: u32,
    coarsest: &'s Motions,
    /// Speeds near the top, rpm.
    speeds: Vec<f64>,
    parts: Parts,
}

/// A choice with its sweep, which is absent if it is that of the coarsest candidate.
type Found = Option<(Choice, Option<Sweep>)>;

impl Search<'_> {
    fn quasi_static(&self, trial: &mut Trial) -> Found {
        QUASI_STATIC.iter().find_map(|(mesh, doubled)| self.tried(trial, *mesh, *doubled))
    }

    fn tried(&self, trial: &mut Trial, mesh: usize, doubled: u32) -> Found {
        let own = settings(self.base << doubled, mesh, None);
        if mesh < self.parts.mesh {
            // At its fewest steps it is in the list already.
            if doubled > 0 {
                trial.refused(own, "its mesh is refused, as above");
            }
            return None;
        }
        let parts = |of_steps: f64, motions: &Motions| {
            vec![
                ErrorPart::new(MESH, self.parts.of_mesh(mesh)),
                ErrorPart::new(TIME_STEPS, of_steps),
                ErrorPart::new(BODY_INERTIA, self.parts.inertia),
                ErrorPart::new(PERIODICITY, LEFT_TO_GO * motions.residual()),
            ]
        };
        let no_bound = || {
            let first = self.size.first_mode_hz();
            format!(
                "the inertia that is left out may shift natural frequencies by more than {:.0} %, or a harmonic that \
                 matters is above the first mode of a body that is left out, about {first:.0} Hz",
                100.0 * LARGEST_SHIFT
            )
        };
        let value = |motions: &Motions| 1e6 * motions.largest();
        if mesh == self.parts.mesh && doubled == 0 {
            let parts = parts(self.parts.of_steps, self.coarsest);
            let judged = trial.judged(own, value(self.coarsest), parts, no_bound);
            return judged.map(|choice| (choice, None));
        }
        let expected = total(&parts(self.parts.of_steps(doubled), self.coarsest));
        if !trial.is_expected(own, expected) {
            return None;
        }
        let found = self.run(trial, own, &self.request.speeds_rpm)?;
        let of_steps = self.parts.of_steps_seen(mesh, doubled, found.apart(self.coarsest));
        let parts = parts(of_steps, &found);
        let choice = trial.judged(own, value(&found), parts, no_bound)?;
        Some((choice, Some(found.sweep)))
    }

    /// Modes of the bodies move the response by d from that of quasi-static bodies with the same mesh and steps. If they
    /// leave a third of the error of quasi-static bodies (saturation assumption), d/2 is left.
    fn modal(&self, trial: &mut Trial) -> Found {
        let all = AmplitudeRequest::candidates(self.of.0);
        let has_modes = all.iter().any(|own| own.modes.is_some());
        let list = MODAL.iter().filter(|_| has_modes);
        // What modes on a coarser mesh or with fewer steps have shown that they leave.
        let mut left_out = 0.0;
        list.clone().find_map(|(mesh, doubled)| {
            let own = settings(self.base << doubled, *mesh, Some(MODES));
            let mut parts = vec![
                ErrorPart::new(MESH, self.parts.of_mesh(*mesh)),
                ErrorPart::new(TIME_STEPS, self.parts.of_steps(*doubled)),
            ];
            if !trial.is_expected(own, total(&parts) + 100.0 * left_out) {
                return None;
            }
            let rigid = self.run(trial, settings(self.base << doubled, *mesh, None), &self.speeds);
            let rigid = rigid?;
            let found = self.run(trial, own, &self.request.speeds_rpm)?;
            left_out = 0.5 * found.apart(&rigid);
            parts.push(ErrorPart::new(BODY_INERTIA, left_out));
            parts.push(ErrorPart::new(PERIODICITY, LEFT_TO_GO * found.residual()));
            let choice = trial.judged(own, 1e6 * found.largest(), parts, String::new)?;
            Some((choice, Some(found.sweep)))
        })
    }

    fn run(&self, trial: &mut Trial, own: AutoSettings, speeds_rpm: &[f64]) -> Option<Motions> {
        match on(self.of, own, self.request, |turning| turning.motions(speeds_rpm)) {
            Ok(found) => Some(found),
            Err(e) => {
                trial.refused(own, e);
                None
            }
        }
    }
}
