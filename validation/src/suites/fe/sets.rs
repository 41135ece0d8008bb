//! Whole sets at rest: balance, load sharing, symmetry.

use fe_contact::statics::{Imperfections, SetCycle};
use gearset::{MeshKind, Scene};

use super::Lab;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;

/// Even, and a multiple of 14, the denominator of the OH-58's phases.
const POSITIONS: usize = 28;

/// The scene seen in a mirror along planet 0's axis.
fn mirrored(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
    if let Some(steps) = &mut scene.planets.steps {
        steps.iter_mut().for_each(|s| *s = -*s);
    }
    scene
}

/// The scene with its planets listed in another order, planet 0 first.
fn renumbered(scene: &Scene, order: &[usize]) -> Scene {
    let mut other = scene.clone();
    other.planets.psi_rad = order.iter().map(|n| scene.planets.psi_rad[*n]).collect();
    other.planets.steps =
        scene.planets.steps.as_ref().map(|s| order.iter().map(|n| s[*n]).collect());
    other
}

fn mesh_force(cycle: &SetCycle, position: usize, kind: MeshKind, planet: usize) -> f64 {
    let meshes = &cycle.states[position].meshes;
    meshes.iter().find(|m| m.kind == kind && m.planet == planet).map_or(f64::NAN, |m| m.force)
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let torque = 1413.0;
    let run = |scene: &Scene, torque: f64| {
        lab.set(scene, &lab.bodies, torque, POSITIONS, Imperfections::default())
    };
    let (three, four) = (run(&lab.three, torque)?, run(&lab.four, torque)?);
    let mut checks = Vec::new();
    let worst = |cycle: &SetCycle| cycle.states.iter().map(|s| s.residual).fold(0.0, f64::max);
    let title =
        "largest imbalance of force or moment on any race, over the load, three and four planets";
    checks.push(lab.at_most("fe.sets.balance", title, "", worst(&three).max(worst(&four)))?);

    let kinds = [MeshKind::SunPlanet, MeshKind::RingPlanet];
    let mut spread = 0.0f64;
    for i in 0..POSITIONS {
        for kind in kinds {
            let f = [0, 1, 2].map(|n| mesh_force(&three, i, kind, n));
            let most = f.iter().fold(0.0f64, |a, x| a.max(*x));
            spread = spread.max((most - f.iter().fold(most, |a, x| a.min(*x))) / most);
        }
    }
    let title =
        "three planets: largest difference between mesh forces of the planets at any position";
    checks.push(lab.at_most("fe.sets.sharing.three", title, "", spread)?);

    let mut off = 0.0f64;
    for i in 0..POSITIONS {
        let later = (i + POSITIONS / 2) % POSITIONS;
        for kind in kinds {
            for (n, opposite) in [(0, 2), (1, 3)] {
                let (a, b) =
                    (mesh_force(&four, i, kind, n), mesh_force(&four, later, kind, opposite));
                off = off.max((a / b - 1.0).abs());
            }
        }
    }
    let title = "four planets: opposed planets carry the same mesh force half a cycle apart";
    checks.push(lab.at_most("fe.sets.sharing.four", title, "", off)?);

    // Mirrored set, reversed torque: y and θ change sign, nothing else.
    let image = run(&mirrored(&lab.four), -torque)?;
    let scale = four.states[0].central[2][2].abs();
    let mut off = 0.0f64;
    for (a, b) in four.states.iter().zip(&image.states) {
        for (p, q) in a.central.iter().chain(&a.planets).zip(b.central.iter().chain(&b.planets)) {
            for (k, sign) in [1.0, -1.0, -1.0].into_iter().enumerate() {
                off = off.max((p[k] - sign * q[k]).abs() / scale);
            }
        }
    }
    let title =
        "mirrored set with reversed torque: displacements of all races against the mirror image";
    checks.push(lab.at_most("fe.sets.mirror", title, "", off)?);

    // Reversed torque alone: other flanks, other phases, another result.
    let reversed = run(&lab.four, -torque)?;
    let phase = |cycle: &SetCycle, n: usize| cycle.states[0].meshes[n].phase;
    let other = |a: f64, b: f64| (a - b - (a - b).round()).abs() > 1e-6;
    let is_other = other(phase(&four, 1), phase(&reversed, 1));
    let turned = reversed.states[0].central[2][2] < 0.0;
    let subject = Subject {
        id: "fe.sets.reversed",
        title: "reversed torque turns the sun the other way, on flanks with phases of their own",
        kind: ReferenceKind::Analytic,
        source: "phases of the clockwise flanks: rigid polygons in gearset/tests",
        unit: "",
    };
    let told = |x: bool| f64::from(u8::from(x));
    checks.push(Check::equal(subject, vec![1.0, 1.0], vec![told(is_other), told(turned)]));

    let order = [0, 2, 3, 1];
    let other = run(&renumbered(&lab.four, &order), torque)?;
    let mut off = 0.0f64;
    for i in 0..POSITIONS {
        for kind in kinds {
            for (new, old) in order.into_iter().enumerate() {
                let (a, b) = (mesh_force(&other, i, kind, new), mesh_force(&four, i, kind, old));
                off = off.max((a / b - 1.0).abs());
            }
        }
    }
    let title = "mesh forces after renumbering the planets";
    checks.push(lab.at_most("fe.sets.numbering", title, "", off)?);

    let deflection = |cycle: &SetCycle, axis: usize| {
        cycle.states.iter().map(|s| s.central[2][axis].abs()).fold(0.0, f64::max)
    };
    let drift = deflection(&three, 0).max(deflection(&three, 1)) * 1e6;
    let title = "three planets: the sun does not translate";
    checks.push(lab.at_most("fe.sets.sun_stays.three", title, "µm", drift)?);
    Ok(checks)
}
