//! A set that additional loads hold wound along its mechanism: with isotropic bearings it is the same set,
//! rotated.
//!
//! The planets orbit by κ, rolling in the held ring and on the sun, so that all meshes stay in contact. Loads
//! f = K q(κ) balance the bearing forces of this motion. At equal positions of the tooth pairs only the frame
//! has changed: mesh forces, the magnitude of the sun's translation, and the sun's rotation less the rotation
//! that winding rolls in must stay the same. Kinematics linear about the unloaded set treat displacements of
//! millimetres as straight lines and violate this.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{SetCycle, SetState};
use gearset::{Axis, Body};
use scene::Scene;

use super::{HARMONICS, POSITIONS, control, sun_lines, unloaded};
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};
use crate::worst::{paired, worst};

const TORQUE: f64 = 1130.0;

/// Parts of a mesh cycle by which the set is wound, in 140ths: half of a step, one step, a quarter and
/// the whole of a base pitch.
const WOUND: [(&str, f64); 4] =
    [("half_step", 0.5), ("step", 1.0), ("quarter", 35.0), ("pitch", 140.0)];

/// How a wound set differs from the one that is not.
struct Differences {
    /// Of any mesh force, over the largest.
    force: f64,
    /// Of the sun's translation or rotation at any position, over the vibration.
    motion: f64,
    /// Of amplitudes of harmonics of the sun's rotation and translation, over the largest.
    harmonics: f64,
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    for (name, scene) in [("three", &lab.three), ("four", &lab.four)] {
        let scene = with_rigid_carrier(scene)?;
        let mut base = None;
        for (id, wound) in WOUND {
            let own = |of: &str| format!("fe.kinematics.turned.{of}.{name}.{id}");
            let mut found = None;
            if lab.runs(&own("force"))? {
                if base.is_none() {
                    base = Some(run(lab, &scene, 0.0, About::Loaded)?);
                }
                let turned = run(lab, &scene, wound, About::Loaded)?;
                found = base.as_ref().map(|base| differences(lab, base, &turned)).transpose()?;
            }
            let what = format!(
                "{name} planets, {TORQUE} N·m, wound by {wound}/140 of a mesh cycle along the mechanism"
            );
            let title = format!("{what}: largest change of a mesh force, over the largest force");
            let force = found.as_ref().map(|d| d.force);
            checks.push(lab.about(&own("force"), &title)?.at_most_if_run(force));
            let title = format!(
                "{what}: largest change of the sun's translation or rotation beyond the rolled-in one, over its vibration"
            );
            let motion = found.as_ref().map(|d| d.motion);
            checks.push(lab.about(&own("motion"), &title)?.at_most_if_run(motion));
            let title = format!(
                "{what}: largest change of harmonics 1 to {HARMONICS} of the sun's rotation and translation, over the largest"
            );
            let harmonics = found.as_ref().map(|d| d.harmonics);
            checks.push(lab.about(&own("harmonics"), &title)?.at_most_if_run(harmonics));
        }
    }
    let scene = with_rigid_carrier(&lab.four)?;
    let [base, turned] = [0.0, 1.0].map(|wound| run(lab, &scene, wound, About::Unloaded));
    let found = differences(lab, &base?, &turned?)?;
    for (what, found) in [("force", found.force), ("motion", found.motion)] {
        let id = format!("fe.kinematics.turned.control.{what}");
        let judged_by = format!("fe.kinematics.turned.{what}.four.step");
        checks.push(control(lab, &id, &judged_by, found)?);
    }
    Ok(checks)
}

/// The scene with a rigid carrier: the compliance of an elastic one would not rotate with the planets.
fn with_rigid_carrier(scene: &Scene) -> Result<Scene, ValidationError> {
    let mut scene = scene.clone();
    let geometry = scene.geometry.as_mut().ok_or(ValidationError::Incomplete("geometry"))?;
    let carrier = geometry.carrier.as_mut().ok_or(ValidationError::Incomplete("carrier"))?;
    carrier.is_rigid = true;
    Ok(scene)
}

/// What kinematics are linear about.
#[derive(Clone, Copy)]
enum About {
    /// The mean configuration under all loads.
    Loaded,
    /// The set without load.
    Unloaded,
}

/// A mesh cycle of a wound set.
struct Wound {
    cycle: SetCycle,
    /// Rotation that winding rolls into the sun, rad.
    rolled_in: f64,
}

/// A mesh cycle of the set wound by `wound`/140 of a mesh cycle.
fn run(lab: &Lab<'_>, scene: &Scene, wound: f64, about: About) -> Result<Wound, ValidationError> {
    let missing = || ValidationError::Incomplete("numbers of teeth");
    let (_, ring_teeth) = scene.teeth.and_then(|t| t.sun_ring()).ok_or_else(missing)?;
    let angle = std::f64::consts::TAU * wound / 140.0 / f64::from(ring_teeth);
    let set = unloaded(scene, &lab.bodies)?;
    let races = set.races();
    let [arm, ring, sun, planet] = races.radii;
    let mut along = set.reference().q.clone();
    along.fill(0.0);
    let of_planet = [arm * (angle.cos() - 1.0), arm * angle.sin(), -(ring - planet) * angle];
    for n in 0..races.planets() {
        for (place, value) in races.places(Body::Planet(n)).into_iter().zip(of_planet) {
            along[place.ok_or(ValidationError::Incomplete("planet"))?] = value;
        }
    }
    let rolled_in = (sun + ring) * angle;
    let free =
        races.of(Body::Sun, Axis::Rotation).ok_or(ValidationError::Incomplete("free sun"))?;
    along[free] = rolled_in;
    let loads = &races.stiffness * &along;
    let set = match about {
        About::Loaded => set.under_with(TORQUE, &loads)?,
        About::Unloaded => set,
    };
    let cycle = set.cycle_with(TORQUE, &loads, POSITIONS, &ActiveSet)?;
    Ok(Wound { cycle, rolled_in: rolled_in / sun })
}

fn differences(
    lab: &Lab<'_>,
    base: &Wound,
    turned: &Wound,
) -> Result<Differences, ValidationError> {
    let missing = || ValidationError::Incomplete("sun");
    let radius = lab.bodies.geometry.sun.as_ref().ok_or_else(missing)?.base_radius;
    let (a, b) = (&base.cycle.states, &turned.cycle.states);
    let forces = |states: &[SetState]| -> Vec<f64> {
        states.iter().flat_map(|s| s.meshes.iter().map(|m| m.force)).collect()
    };
    let force = off(&forces(a), &forces(b), worst(forces(a)));
    let rotation = |w: &Wound| -> Vec<f64> {
        let beyond = w.cycle.states.iter().map(|s| s.central[2][2] - w.rolled_in);
        beyond.map(|angle| radius * angle).collect()
    };
    let translation = |states: &[SetState]| -> Vec<f64> {
        states.iter().map(|s| s.central[2][0].hypot(s.central[2][1])).collect()
    };
    let vibration = rotation(base);
    let mean = vibration.iter().sum::<f64>() / vibration.len() as f64;
    let size = worst(vibration.iter().map(|u| u - mean));
    let motion = worst([
        off(&rotation(base), &rotation(turned), size),
        off(&translation(a), &translation(b), size),
    ]);
    let amplitudes = |w: &Wound| -> Result<Vec<f64>, ValidationError> {
        let [rotation, x, y] = sun_lines(&w.cycle, &lab.bodies)?;
        let size = |line: &[f64; 2]| line[0].hypot(line[1]);
        let both = x.iter().zip(&y).map(|(x, y)| size(x).hypot(size(y)));
        Ok(rotation.iter().map(size).chain(both).collect())
    };
    let (own, other) = (amplitudes(base)?, amplitudes(turned)?);
    let harmonics = off(&own, &other, worst(own.iter().copied()));
    Ok(Differences { force, motion, harmonics })
}

/// Largest difference of two lists of equal length over a size.
fn off(a: &[f64], b: &[f64], size: f64) -> f64 {
    worst(paired(a, b).map(|(a, b)| (a - b) / size))
}
