//! A set wound up by its load, by three kinematics: linear about the unloaded configuration, linear about the mean
//! loaded one, and exact.

use std::f64::consts::TAU;

use dynamics::{Window, c64, generalized_symmetric, spectrum};
use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, SetCycle, StaticSet};
use fe_contact::vibration::{LinearSet, Loading, NominalRotation, VibratingSet};
use scene::{LoadCase, Scene};

use super::map::MapError;
use crate::modal::mesh_influence;

/// Harmonics that are compared.
const HARMONICS: usize = 5;

/// Least number of positions of a mesh cycle at rest. They have no divisor in common with the number of planets, so
/// that the meshes of a set whose phases are equally spaced pass through different phases.
const POSITIONS: usize = 56;

/// Positions over which natural frequencies are averaged.
const FREQUENCIES_AT: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Length of a time step of the standing sets, s; frequencies do not depend on it.
const STEP: f64 = 1e-6;

/// Largest relative errors of natural frequencies.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrequencyErrors {
    /// Of modes with most of their strain energy in bearings and supports.
    pub supports: f64,
    /// Of modes with most of it in the meshes.
    pub meshes: f64,
}

/// What kinematics linear about one configuration leave.
#[derive(Debug, Clone, Copy)]
pub(super) struct Left {
    /// Largest error of a harmonic of the sun's rotation over its largest one, and the same of its translation: the
    /// larger. A shift of time common to all harmonics is taken out.
    pub harmonics: f64,
    /// Error of the largest harmonic of the sun's rotation, of itself, with the shift of time.
    pub shifted: f64,
    /// Largest error of the approach of a loaded pair, m.
    pub approach: f64,
    /// Of natural frequencies.
    pub frequencies: FrequencyErrors,
}

/// A set under one load.
#[derive(Debug, Clone)]
pub(super) struct WoundUp {
    /// Change of the phase of planet 0's sun mesh by the load, base pitches.
    pub windup: f64,
    /// Mean approach of the meshes, m.
    pub deflection: f64,
    /// Number of the largest harmonic of the sun's rotation.
    pub strongest: usize,
    /// About the unloaded configuration; `None` if no equilibrium was found.
    pub about_unloaded: Option<Left>,
    /// About the mean loaded configuration.
    pub about_loaded: Left,
    /// Kinematic rest about the mean loaded configuration over the peak-to-peak transmission error.
    pub rest: f64,
}

/// The least number from `from` on that has no divisor in common with `with`.
fn coprime(from: usize, with: usize) -> usize {
    let divides_both = |n: usize| (2..=with).any(|d| n.is_multiple_of(d) && with.is_multiple_of(d));
    (from..).find(|n| !divides_both(*n)).unwrap_or(from)
}

/// Harmonics 1 to 5 of the sun's rotation times its base radius, and of its translation in x and y, m.
type Lines = [Vec<c64>; 3];

impl WoundUp {
    /// Computes everything under a load.
    ///
    /// # Errors
    /// If there is no equilibrium about the loaded configuration or by exact kinematics.
    pub(super) fn of(scene: &Scene, bodies: &Bodies, case: &LoadCase) -> Result<Self, MapError> {
        let torque = case.sun_load_nm();
        let sun = bodies.geometry.sun.as_ref().ok_or(MapError::Incomplete("sun"))?;
        let radius = sun.base_radius;
        let positions = coprime(POSITIONS, scene.planets.count());
        let unloaded = StaticSet::new(scene, bodies, case.sense(), Imperfections::default())?;
        let loaded = unloaded.clone().under(torque)?;
        let windup = loaded.reference().lead();
        let exact_cycle = loaded.exact_kinematics_cycle(torque, positions)?;
        let exact = lines(&exact_cycle, radius)?;
        let (strongest, _) = largest(&exact[..1]);
        let frequencies = Frequencies::exact(scene, bodies, case, &loaded)?;
        // Position x about the unloaded configuration is x + w of the gears as they stand.
        let left = |cycle: &SetCycle, late: f64, about: f64| -> Result<Left, MapError> {
            let own = lines(cycle, radius)?;
            let first = (own[0][strongest - 1] - exact[0][strongest - 1]).norm();
            let rests = cycle.states.iter().map(|s| s.kinematic_rest);
            Ok(Left {
                harmonics: off(&moved(own, -late), &exact),
                shifted: first / exact[0][strongest - 1].norm(),
                approach: rests.fold(0.0, f64::max),
                frequencies: frequencies.off(scene, bodies, case, (about, late))?,
            })
        };
        let about = |set: &StaticSet<'_>, late: f64, about: f64| {
            left(&set.cycle_here(torque, positions, &ActiveSet)?, late, about)
        };
        let about_unloaded = match about(&unloaded, windup, 0.0) {
            // Gaps of corners that are far off let teeth through or leave nothing to balance.
            Err(MapError::Fe(
                FeError::NoEquilibrium(_)
                | FeError::NotConverged { .. }
                | FeError::AtPosition { .. },
            )) => None,
            found => Some(found?),
        };
        let about_loaded = about(&loaded, 0.0, torque)?;
        let errors = exact_cycle.states.iter().map(|s| s.transmission_error(radius));
        let (low, high) = errors
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let meshes = || exact_cycle.states.iter().flat_map(|s| &s.meshes);
        let deflection = meshes().map(|m| m.approach).sum::<f64>() / meshes().count() as f64;
        Ok(Self {
            windup: windup.abs(),
            deflection,
            strongest,
            about_unloaded,
            about_loaded,
            rest: about_loaded.approach / (high - low),
        })
    }
}

/// What the coarser tables from which the linearised set takes the slopes of the flanks change in its harmonics: the
/// largest difference between exact cycles with either.
pub(super) fn of_slopes(scene: &Scene, bodies: &Bodies, case: &LoadCase) -> Result<f64, MapError> {
    let torque = case.sun_load_nm();
    let sun = bodies.geometry.sun.as_ref().ok_or(MapError::Incomplete("sun"))?;
    let positions = coprime(POSITIONS, scene.planets.count());
    let set = StaticSet::new(scene, bodies, case.sense(), Imperfections::default())?;
    let set = set.under(torque)?;
    let fine = lines(&set.exact_cycle(torque, positions)?, sun.base_radius)?;
    let coarse = lines(&set.exact_kinematics_cycle(torque, positions)?, sun.base_radius)?;
    Ok(off(&coarse, &fine))
}

fn lines(cycle: &SetCycle, radius: f64) -> Result<Lines, MapError> {
    let of = |axis: usize, scale: f64| -> Result<Vec<c64>, MapError> {
        let record: Vec<f64> = cycle.states.iter().map(|s| scale * s.central[2][axis]).collect();
        let found = spectrum(&record, 1.0 / record.len() as f64, Window::Rectangular, 1)?;
        Ok(found.lines.into_iter().skip(1).take(HARMONICS).collect())
    };
    Ok([of(2, radius)?, of(0, 1.0)?, of(1, 1.0)?])
}

/// Harmonics of the same motion some cycles later.
fn moved(lines: Lines, cycles: f64) -> Lines {
    let turned = |(k, x): (usize, c64)| x * c64::from_polar(1.0, TAU * (k + 1) as f64 * cycles);
    lines.map(|of| of.into_iter().enumerate().map(turned).collect())
}

/// The largest harmonic of some motions, counted from 1, and its size.
fn largest(of: &[Vec<c64>]) -> (usize, f64) {
    let size = |l: usize| of.iter().map(|lines| lines[l].norm_sqr()).sum::<f64>().sqrt();
    let all = (0..HARMONICS).map(|l| (l + 1, size(l)));
    all.fold((1, 0.0), |most, next| if next.1 > most.1 { next } else { most })
}

/// Largest difference of harmonics of rotation, and of translation, over the largest of `exact`.
fn off(own: &Lines, exact: &Lines) -> f64 {
    let of = |range: std::ops::Range<usize>| {
        let pairs = own[range.clone()].iter().zip(&exact[range.clone()]);
        let rest: Vec<Vec<c64>> =
            pairs.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect();
        largest(&rest).1 / largest(&exact[range]).1
    };
    of(0..1).max(of(1..3))
}

/// Natural frequencies by exact kinematics, each the mean over some positions, Hz.
struct Frequencies {
    exact: Vec<f64>,
    /// Whether most of a mode's strain energy is in the meshes.
    is_of_meshes: Vec<bool>,
}

impl Frequencies {
    fn exact(
        scene: &Scene,
        bodies: &Bodies,
        case: &LoadCase,
        loaded: &StaticSet<'_>,
    ) -> Result<Self, MapError> {
        let torque = case.sun_load_nm();
        let linear = linearised(scene, bodies, case, torque, 0.0)?;
        let masses: Vec<f64> = linear.mass.diagonal().iter().copied().collect();
        // Half of ∂ln f/∂ln k is the share of the strain energy.
        let is_of_meshes = mesh_influence(&linear)?.iter().map(|m| m.all_meshes > 0.25).collect();
        let at = |position: f64| -> Result<Vec<f64>, MapError> {
            let tangent = loaded.exact_tangent(torque, position)?;
            let lambda = generalized_symmetric(&tangent, &masses)?.lambda;
            Ok(lambda.iter().map(|x| x.max(0.0).sqrt() / TAU).collect())
        };
        Ok(Self { exact: mean(at)?, is_of_meshes })
    }

    /// Errors of the frequencies linearised about the mean configuration under `about.0` (N·m), at positions that are
    /// `about.1` cycles earlier.
    fn off(
        &self,
        scene: &Scene,
        bodies: &Bodies,
        case: &LoadCase,
        (about, late): (f64, f64),
    ) -> Result<FrequencyErrors, MapError> {
        let own = mean(|position| {
            let position = (position - late).rem_euclid(1.0);
            Ok(linearised(scene, bodies, case, about, position)?.undamped()?.0)
        })?;
        let largest = |of_meshes: bool| {
            let all = own.iter().zip(&self.exact).zip(&self.is_of_meshes);
            let group = all.filter(|((_, exact), own)| **own == of_meshes && **exact > 0.0);
            group.map(|((own, exact), _)| (own / exact - 1.0).abs()).fold(0.0, f64::max)
        };
        Ok(FrequencyErrors { supports: largest(false), meshes: largest(true) })
    }
}

/// Mean of what is found at each position.
fn mean(at: impl Fn(f64) -> Result<Vec<f64>, MapError>) -> Result<Vec<f64>, MapError> {
    let mut sum: Vec<f64> = Vec::new();
    for position in FREQUENCIES_AT {
        let found = at(position)?;
        sum.resize(found.len(), 0.0);
        sum.iter_mut().zip(found).for_each(|(sum, x)| *sum += x / FREQUENCIES_AT.len() as f64);
    }
    Ok(sum)
}

/// The standing set in equilibrium under its load at a position, its kinematics linear about the mean configuration
/// under `about` (N·m), which is the unloaded one for 0.
fn linearised(
    scene: &Scene,
    bodies: &Bodies,
    case: &LoadCase,
    about: f64,
    position: f64,
) -> Result<LinearSet, MapError> {
    let torque = case.sun_load_nm();
    let sun = bodies.geometry.sun.as_ref().ok_or(MapError::Incomplete("sun"))?;
    let mesh_force = torque / sun.base_radius / scene.planets.count() as f64;
    let rotation = NominalRotation::Standing { position, step: STEP };
    let loading = Loading { torque_nm: about, mesh_force };
    let (sense, none) = (case.sense(), Imperfections::default());
    let mut set = VibratingSet::new(scene, bodies, sense, none, rotation, loading)?;
    set.rest(torque)?;
    Ok(set.linearised()?)
}
