//! Kinematics linear about the loaded configuration against exact kinematics at every step of the search:
//! harmonics of the sun at rest.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, SetCycle};
use scene::Scene;

use super::{HARMONICS, POSITIONS, control, sun_lines, unloaded};
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};
use crate::worst::{peak_to_peak, worst};

/// 0.1, 0.5, 1 and 2 times the paper's preload, N·m.
const TORQUES: [f64; 4] = [113.0, 565.0, 1130.0, 2260.0];

/// The torque of the quick profile, N·m.
const TORQUE: f64 = 1130.0;

/// Harmonics below this count as this large, µm.
const SMALL: f64 = 1.0;

/// Flexibilities of the meshes that make those of three planets as stiff as the lumped ones printed,
/// rounded.
const SOFT: [f64; 2] = [1.9, 2.6];

/// How linear kinematics differ from exact ones under one torque.
#[derive(Clone, Copy)]
struct Differences {
    torque: f64,
    /// Largest error of a harmonic of the sun's rotation or translation, over its largest harmonic, percent.
    harmonics: f64,
    /// Largest error of an approach by linear kinematics, over the peak-to-peak transmission error, percent.
    rest: f64,
}

/// Differences, with the cycle of exact kinematics.
struct Compared {
    found: Differences,
    exact: SetCycle,
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let Compared { found, exact } = differences(&lab.four, &lab.bodies, TORQUE)?;
    let words = format!("four planets, {TORQUE} N·m");
    let mut checks = judged(lab, "four", &words, Some(&[found]))?;
    let old = unloaded(&lab.four, &lab.bodies)?.cycle_here(TORQUE, POSITIONS, &ActiveSet)?;
    let off = off(&old, &exact, &lab.bodies)?;
    let id = "fe.kinematics.exact.control.unloaded";
    checks.push(control(lab, id, "fe.kinematics.exact.harmonics.four", off)?);
    for (planets, is_soft, set) in sets()? {
        // `Bodies` do not contain the carrier, so that both carriers share them.
        let meshes = if is_soft { "soft" } else { "own" };
        let is_run =
            lab.runs(&format!("fe.kinematics.exact.harmonics.{planets}.{meshes}.rigid"))?;
        let bodies = is_run.then(|| lab.gears.of(&set)).transpose()?;
        for is_rigid in [false, true] {
            let mut set = set.clone();
            let geometry = set.geometry.as_mut().ok_or(ValidationError::Incomplete("geometry"))?;
            let carrier =
                geometry.carrier.as_mut().ok_or(ValidationError::Incomplete("carrier"))?;
            carrier.is_rigid = is_rigid;
            let seats = if is_rigid { "rigid" } else { "elastic" };
            let words = format!(
                "{planets} planets, meshes as {}, {seats} carrier",
                if is_soft { "soft as the printed lumped ones" } else { "they are" }
            );
            let under = |bodies: &Bodies| -> Result<Vec<Differences>, ValidationError> {
                TORQUES.into_iter().map(|t| Ok(differences(&set, bodies, t)?.found)).collect()
            };
            let found = bodies.as_deref().map(under).transpose()?;
            let id = format!("{planets}.{meshes}.{seats}");
            checks.extend(judged(lab, &id, &words, found.as_deref())?);
        }
    }
    Ok(checks)
}

/// Sets with their names, and whether their meshes are softened.
fn sets() -> Result<Vec<(&'static str, bool, Scene)>, ValidationError> {
    use PublishedScene as P;
    let five = scene(P::FivePlanets)?;
    let mut softened = five.clone();
    let factor = &mut softened.fe_contact.flexibility_factor;
    [factor.sun_planet, factor.ring_planet] = SOFT;
    Ok(vec![
        ("three", false, scene(P::Oh58ThreePlanets)?),
        ("three", true, scene(P::Oh58ThreePlanetsPublishedStiffness)?),
        ("four", false, scene(P::Oh58FourPlanets)?),
        ("four", true, scene(P::Oh58FourPlanetsPublishedStiffness)?),
        ("five", false, five),
        ("five", true, softened),
    ])
}

/// Checks of one set by the differences under each torque; not run if there are none.
fn judged(lab: &Lab<'_>, id: &str, words: &str, found: Option<&[Differences]>) -> Checks {
    let most = |of: fn(&Differences) -> f64| {
        let found = found?;
        let most = worst(found.iter().map(of));
        let at = found.iter().find(|d| of(d) == most).map_or(f64::NAN, |d| d.torque);
        Some((most, format!("largest at {at} N·m")))
    };
    let mut checks = Vec::new();
    for (name, what, most) in [
        (
            "harmonics",
            format!(
                "harmonics 1 to {HARMONICS} of the sun's rotation and translation at rest against exact kinematics, over the largest, which counts as {SMALL} µm at least"
            ),
            most(|d| d.harmonics),
        ),
        (
            "rest",
            "what linear kinematics leave of the approach of a loaded pair, over the peak-to-peak transmission error".into(),
            most(|d| d.rest),
        ),
    ] {
        let id = format!("fe.kinematics.exact.{name}.{id}");
        let title = format!("{words}: {what}");
        let mut about = lab.about(&id, &title)?;
        if let Some((_, at)) = &most {
            about = about.note(at.as_str());
        }
        checks.push(about.at_most_if_run(most.map(|m| m.0)));
    }
    Ok(checks)
}

/// Linear about the loaded configuration against exact kinematics under one torque.
fn differences(scene: &Scene, bodies: &Bodies, torque: f64) -> Result<Compared, ValidationError> {
    let set = unloaded(scene, bodies)?.under(torque)?;
    let cycle = set.cycle_here(torque, POSITIONS, &ActiveSet)?;
    let exact = set.exact_cycle(torque, POSITIONS)?;
    let sun = bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    let errors = || cycle.states.iter().map(|s| s.transmission_error(sun.base_radius));
    let peak_to_peak = peak_to_peak(errors());
    let rest = worst(cycle.states.iter().map(|s| s.kinematic_rest));
    let found = Differences {
        torque,
        harmonics: off(&cycle, &exact, bodies)?,
        rest: 100.0 * rest / peak_to_peak,
    };
    Ok(Compared { found, exact })
}

/// Largest difference of harmonics of the sun's rotation, and of its translation, over the largest,
/// percent.
fn off(cycle: &SetCycle, exact: &SetCycle, bodies: &Bodies) -> Result<f64, ValidationError> {
    let (cycle, exact) = (sun_lines(cycle, bodies)?, sun_lines(exact, bodies)?);
    let share = |axes: &[usize]| {
        let size = |of: &dyn Fn(usize, usize, usize) -> f64| {
            worst((0..HARMONICS).map(|l| {
                let parts = axes.iter().flat_map(|axis| [of(*axis, l, 0), of(*axis, l, 1)]);
                parts.map(|x| x * x).sum::<f64>().sqrt()
            }))
        };
        let most = worst([SMALL, size(&|axis, l, part| exact[axis][l][part])]);
        100.0 * size(&|axis, l, part| cycle[axis][l][part] - exact[axis][l][part]) / most
    };
    let (rotation, translation) = (share(&[0]), share(&[1, 2]));
    Ok(worst([rotation, translation]))
}
