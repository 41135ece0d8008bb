//! Guards: what the program says beyond each border, from both sides of it.

use dynamics::benchmark_subjects::{Scheme, VibratingSystem};
use dynamics::stability::{BouncingBar, HammeringPair};
use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, KinematicRest, pair_cycle};
use gearset::MeshKind;
use lumped::{LumpedModel, NaturalModes, ParametricSet, tolerances_to, type_warnings};
use scene::{LoadCase, LoadSize, Scene, SceneKind, template, warnings};
use schemars::JsonSchema;
use serde::Serialize;

use super::map::MapError;
use super::resonance::{from_rest, slowest};
use crate::branches::{BranchParameter, BranchSettings};
use crate::sweep::{MeshLawModel, SteadyMethod, SteadySettings, SweepPoint, left_of_transient};

/// A guard of the program at a border of a method or of a model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Guard {
    /// What it guards.
    pub name: String,
    /// What is tried on either side of the border.
    pub border: String,
    /// What the program says just within the border; absent if nothing.
    pub within: Option<String>,
    /// What it says just beyond.
    pub beyond: Option<String>,
}

type Said = Result<Option<String>, MapError>;

/// What is tried: `true` beyond the border.
type Attempt = fn(bool) -> Said;

const ALL: [(&str, &str, Attempt); 23] = [
    ("explicit step", "Δt·ω_max of central difference 1.999 and 2.001", explicit_step),
    ("parameter of a scheme", "HHT-α with α = −0.333 and −0.334", parameter),
    ("mass at an obstacle", "Moreau–Jean on a flank with and without mass", massless),
    ("energy at obstacles", "bouncing bar with Moreau–Jean and with average acceleration", energy),
    ("harmonics", "10 harmonics read from 560 and from 559 steps in a mesh cycle", harmonics),
    ("place of a resonance", "5 harmonics read from 91 and from 90 steps", resonance_place),
    ("steps in a mesh cycle", "`dynamics.steps_per_cycle` = 16 and 15", fewest_steps),
    ("steps and phasing", "140 and 141 steps for two opposed pairs of planets", phasing),
    ("locking", "`fe_contact.element` incompatible and linear", locking),
    ("contact cells", "`fe_contact.contact_cells` = 8 and 7", fewest_cells),
    (
        "cells in the loaded patch",
        "fewest cells at which a mesh cycle is accepted, and one fewer",
        loaded_cells,
    ),
    ("matching depth, above", "0.1 % within and beyond the least depth", shallow),
    ("matching depth, below", "0.1 % within and beyond the greatest depth", deep),
    ("matching depth in elements", "0.1 % within and beyond the least depth", few_elements_deep),
    ("linear kinematics", "rest of 9.9 % and 10.1 % of the sun's motion of 10 µm", linear),
    (
        "lines of action of the unloaded set",
        "0.1 % within and beyond a deflection of a quarter of a module",
        turned_lines,
    ),
    ("heavy load", "0.1 % within and beyond a deflection of one module", heavy),
    ("light load", "0.1 % within and beyond a millionth of a module", light),
    ("mesh stiffness below 0", "variation 0.1 % within and beyond what closes the mesh", variation),
    ("types of modes", "equal planets, and one heavier than the border of mode-types", types),
    (
        "types of modes, spacing",
        "equal spacing, and one planet displaced beyond the border of spacing",
        types_by_spacing,
    ),
    (
        "unfinished transient",
        "a march at a resonance to the change that leaves at most 1 % of transient, and to three times that",
        transient,
    ),
    ("damping of a branch", "least factor on the damping 1e-6 and 0", damping),
];

/// All of them with what the program says.
///
/// # Errors
/// If an attempt fails for another reason than its border.
pub fn guards() -> Result<Vec<Guard>, MapError> {
    ALL.iter()
        .map(|(name, border, attempt)| {
            Ok(Guard {
                name: (*name).into(),
                border: (*border).into(),
                within: attempt(false)?,
                beyond: attempt(true)?,
            })
        })
        .collect()
}

/// What a fallible step says.
fn said<T, E: std::fmt::Display>(result: Result<T, E>) -> Said {
    Ok(result.err().map(|e| e.to_string()))
}

fn explicit_step(beyond: bool) -> Said {
    let system = VibratingSystem::oscillator(1.0, 0.0, 1.0)?;
    said(Scheme::CentralDifference.prepare(&system, if beyond { 2.001 } else { 1.999 }))
}

fn parameter(beyond: bool) -> Said {
    let system = VibratingSystem::oscillator(1.0, 0.0, 1.0)?;
    let alpha = if beyond { -0.334 } else { -0.333 };
    said(Scheme::Hht { alpha }.prepare(&system, 0.1))
}

fn massless(beyond: bool) -> Said {
    let scheme = Scheme::MoreauJean { theta: 0.5, restitution: 1.0 };
    let system = match beyond {
        true => HammeringPair { landing_speed: 1.0 }.system()?,
        false => BouncingBar::PUBLISHED.system(4, false)?,
    };
    said(scheme.prepare(&system, 1e-3))
}

fn energy(beyond: bool) -> Said {
    let sound = Scheme::MoreauJean { theta: 0.5, restitution: 1.0 };
    let scheme = if beyond { Scheme::AverageAcceleration } else { sound };
    Ok(scheme.caution(&BouncingBar::PUBLISHED.system(4, false)?))
}

fn harmonics(beyond: bool) -> Said {
    let settings = SteadySettings { harmonics: 10, ..SteadySettings::default() };
    said(settings.check(if beyond { 559 } else { 560 }))
}

fn resonance_place(beyond: bool) -> Said {
    let settings = SteadySettings { harmonics: 5, ..SteadySettings::default() };
    Ok(settings.caution(if beyond { 90 } else { 91 }))
}

/// The scene that `scene new` writes with one line changed.
fn changed(kind: SceneKind, from: &str, to: &str) -> Result<Scene, String> {
    Scene::from_toml(&template(kind).replacen(from, to, 1)).map_err(|e| e.to_string())
}

/// The same where the change must be accepted.
fn accepted(kind: SceneKind, from: &str, to: &str) -> Result<Scene, MapError> {
    changed(kind, from, to).map_err(MapError::Template)
}

const STEPS: &str = "steps_per_cycle = 140";
const ELEMENT: &str = "element = \"quadratic\"";
const CELLS: &str = "contact_cells = 40";
const FLANK: &str = "flank_elements = 14";
const DEPTH: &str = "# matching_depth_mm = 0.57";
const DEPTH_IN_ELEMENTS: &str = "# matching_depth_elements = 0.85";
const TORQUE: &str = "torque_nm = 1413";

fn fewest_steps(beyond: bool) -> Said {
    let steps = if beyond { "steps_per_cycle = 15" } else { "steps_per_cycle = 16" };
    said(changed(SceneKind::Planetary, STEPS, steps))
}

/// Warnings of one key.
fn warned(scene: &Scene, key: &str) -> Option<String> {
    warnings(scene).into_iter().find(|w| w.key == key).map(|w| w.to_string())
}

fn phasing(beyond: bool) -> Said {
    let steps = if beyond { "steps_per_cycle = 141" } else { STEPS };
    let scene = accepted(SceneKind::Planetary, STEPS, steps)?;
    Ok(warned(&scene, "dynamics.steps_per_cycle"))
}

fn locking(beyond: bool) -> Said {
    let element = if beyond { "element = \"linear\"" } else { "element = \"incompatible\"" };
    let scene = accepted(SceneKind::Planetary, ELEMENT, element)?;
    Ok(warned(&scene, "fe_contact.element"))
}

fn fewest_cells(beyond: bool) -> Said {
    let cells = if beyond { "contact_cells = 7" } else { "contact_cells = 8" };
    said(changed(SceneKind::Planetary, CELLS, cells))
}

/// Normal force on one mesh, N, and positions in the mesh cycle.
const FORCE_N: f64 = 1e4;
const POSITIONS: usize = 4;

fn loaded_cells(beyond: bool) -> Said {
    let mut scene = accepted(SceneKind::GearPair, FLANK, "flank_elements = 8")?;
    let mut before = None;
    for cells in 8..40 {
        scene.fe_contact.contact_cells = cells;
        let bodies = Bodies::new(&scene)?;
        let found = pair_cycle(&bodies, MeshKind::SunPlanet, FORCE_N, POSITIONS, &ActiveSet);
        match found {
            Ok(_) => return Ok(if beyond { before } else { None }),
            Err(error @ FeError::GridTooCoarse { .. }) => before = Some(error.to_string()),
            Err(other) => return Err(other.into()),
        }
    }
    Ok(before)
}

fn shallow(beyond: bool) -> Said {
    at_depth(DEPTH, 0, if beyond { 0.999 } else { 1.001 })
}

fn deep(beyond: bool) -> Said {
    at_depth(DEPTH, 1, if beyond { 1.001 } else { 0.999 })
}

fn few_elements_deep(beyond: bool) -> Said {
    at_depth(DEPTH_IN_ELEMENTS, 0, if beyond { 0.999 } else { 1.001 })
}

/// A matching depth, by the line of the template that holds its key, at a factor on one of its limits, which a refusal
/// names.
fn at_depth(line: &str, limit: usize, factor: f64) -> Said {
    let key = line.trim_start_matches("# ").split(' ').next().unwrap_or(line);
    let at = |depth: f64| {
        let mut scene = accepted(SceneKind::Planetary, line, &format!("{key} = {depth}"))?;
        scene.fe_contact.flank_elements = 8;
        Ok::<_, MapError>(Bodies::new(&scene).err())
    };
    let Some(FeError::Unfit { allowed, .. }) = at(1e-6)? else {
        return Ok(None);
    };
    let limits: Vec<f64> = allowed.split(' ').filter_map(|word| word.parse().ok()).collect();
    let Some(depth) = limits.get(limit) else { return Ok(None) };
    Ok(at(depth * factor)?.map(|e| e.to_string()))
}

fn linear(beyond: bool) -> Said {
    let motion = 1e-5;
    said(KinematicRest::new(if beyond { 0.101 } else { 0.099 } * motion, motion).check())
}

/// What is said of a torque on the sun of the template at a factor on the greatest or least that is accepted.
fn at_load(limit: fn(&LoadSize, f64) -> f64, factor: f64) -> Said {
    let scene = accepted(SceneKind::Planetary, TORQUE, TORQUE)?;
    let size = |torque| scene.size_of_sun_torque(torque).ok_or(MapError::NoOperation);
    let torque = factor * limit(&size(1.0)?, 1.0);
    Ok(size(torque)?.refusal(torque, "N·m"))
}

/// A quarter of the load with which teeth give way by a module.
fn turned_lines(beyond: bool) -> Said {
    let scene = accepted(SceneKind::Planetary, TORQUE, TORQUE)?;
    let size = scene.size_of_sun_torque(1.0).ok_or(MapError::NoOperation)?;
    let torque = 0.25 * if beyond { 1.001 } else { 0.999 } * size.most(1.0);
    let scene = accepted(SceneKind::Planetary, TORQUE, &format!("torque_nm = {torque}"))?;
    Ok(warned(&scene, "operation.torque_nm"))
}

fn heavy(beyond: bool) -> Said {
    at_load(LoadSize::most, if beyond { 1.001 } else { 0.999 })
}

fn light(beyond: bool) -> Said {
    at_load(LoadSize::least, if beyond { 0.999 } else { 1.001 })
}

fn variation(beyond: bool) -> Said {
    let scene = accepted(SceneKind::Planetary, TORQUE, TORQUE)?;
    let set = ParametricSet::from_scene(&scene, 0.0)?;
    // 1 − 2 c′ ε = 0
    let high = set.waves().iter().map(lumped::MeshWave::high_part).fold(0.0, f64::max);
    said(set.with_variation(if beyond { 1.001 } else { 0.999 } * 0.5 / high))
}

fn types(beyond: bool) -> Said {
    let scene = accepted(SceneKind::Planetary, TORQUE, TORQUE)?;
    let mut model = LumpedModel::from_scene(&scene)?;
    if beyond {
        let modes = NaturalModes::of(&model)?;
        let least = tolerances_to(&model, &modes, 0)
            .iter()
            .map(|t| t.pure_up_to)
            .fold(f64::INFINITY, f64::min);
        model = model.with_heavier_planet(0, 2.0 * least)?;
    }
    let modes = NaturalModes::of(&model)?;
    Ok(type_warnings(&model, &modes).into_iter().next())
}

fn types_by_spacing(beyond: bool) -> Said {
    let scene = accepted(SceneKind::Planetary, TORQUE, TORQUE)?;
    let mut model = LumpedModel::from_scene(&scene)?;
    if beyond {
        let pattern: Vec<f64> =
            (0..model.psi.len()).map(|n| if n == 0 { 1.0 } else { 0.0 }).collect();
        let changes = model.spacing_changes(&NaturalModes::of(&model)?, &pattern)?;
        let least = changes.iter().map(|c| c.pure_up_to).fold(f64::INFINITY, f64::min);
        model = model
            .with_displaced_planets(&pattern.iter().map(|a| 2.0 * least * a).collect::<Vec<_>>())?;
    }
    let modes = NaturalModes::of(&model)?;
    Ok(type_warnings(&model, &modes).into_iter().next())
}

fn transient(beyond: bool) -> Said {
    let scene = accepted(SceneKind::Planetary, FLANK, "flank_elements = 8")?;
    let case = LoadCase::of_scene(&scene).map_err(|_| MapError::NoOperation)?;
    let bodies = Bodies::new(&scene)?;
    let model = MeshLawModel::new(&scene, &bodies, case)?;
    let case = case.at_speed(slowest(&model)?);
    let shooting = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let found = from_rest(&model, &case, 1.0, &shooting)?;
    let border = 0.01 / left_of_transient(&found.multipliers);
    let tolerance = if beyond { 3.0 } else { 1.0 } * border;
    let marching = SteadySettings { method: SteadyMethod::Marching, tolerance, ..shooting };
    let found = from_rest(&model, &case, 1.0, &marching)?;
    Ok(SweepPoint::new(case, &found, &marching, 0)?.caution())
}

fn damping(beyond: bool) -> Said {
    let least = if beyond { 0.0 } else { 1e-6 };
    said(BranchSettings::along(BranchParameter::Damping, [least, 1.0]).check())
}
