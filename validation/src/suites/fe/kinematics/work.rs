//! Virtual work: over a mesh cycle the mean torques on carrier and ring are those given by the numbers of
//! teeth, whatever the deflections.
//!
//! The potential of a set at rest is the same a mesh cycle later, while the sun's torque has done its
//! work on the rolled angle. Linear kinematics about the unloaded set have no such potential.
//!
//! The mean of N even positions of a periodic function f is off that over the cycle by V/(8 N²) at most,
//! V the variation of f' (Peano's kernel of the trapezoidal rule), which the second differences of the
//! positions give as N Σ|Δ²f|. The bound has to use V and not the range of f: with planets out of phase the
//! torques even out, but the kinks where pairs enter and leave contact remain.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{SetCycle, SetState};
use scene::Scene;

use super::{POSITIONS, control, unloaded};
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

const TORQUE: f64 = 2260.0;

/// Positions of the finer mean, which only the full profile computes.
const FINE: usize = 4 * POSITIONS;

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let five = scene(PublishedScene::FivePlanets)?;
    let of_five = lab.gears.of(&five)?;
    let mut checks = Vec::new();
    let sets = [
        ("three", &lab.three, &*lab.bodies),
        ("four", &lab.four, &*lab.bodies),
        ("five", &five, &*of_five),
    ];
    for (name, scene, bodies) in sets {
        let set = unloaded(scene, bodies)?.under(TORQUE)?;
        let run = |positions: usize| set.cycle_here(TORQUE, positions, &ActiveSet);
        let cycle = run(POSITIONS)?;
        let finer = format!("fe.kinematics.work.carrier.{name}.{FINE}");
        let fine = if lab.runs(&finer)? { Some(run(FINE)?) } else { None };
        for (count, cycle) in [(POSITIONS, Some(&cycle)), (FINE, fine.as_ref())] {
            let found = cycle.map(|cycle| means(scene, cycle)).transpose()?;
            let parts = [("carrier", found.map(|f| f[0])), ("ring", found.map(|f| f[1]))];
            for (body, found) in parts {
                let id = format!("fe.kinematics.work.{body}.{name}.{count}");
                let title = format!(
                    "{name} planets, {TORQUE} N·m: mean torque on the {body} over {count} positions against that by numbers of teeth, over what the trapezoidal rule may be off"
                );
                checks.push(lab.about(&id, &title)?.at_most_if_run(found));
            }
        }
        let id = format!("fe.kinematics.work.balance.{name}");
        let title = format!(
            "{name} planets, {TORQUE} N·m: largest sum of the torques on carrier and ring less the sun's at any position, over the sun's"
        );
        checks.push(lab.about(&id, &title)?.at_most(open(&cycle)));
        if name == "four" {
            let old = unloaded(scene, bodies)?.cycle_here(TORQUE, FINE, &ActiveSet)?;
            let judged_by = format!("fe.kinematics.work.ring.four.{FINE}");
            let id = "fe.kinematics.work.control.unloaded";
            checks.push(control(lab, id, &judged_by, means(scene, &old)?[1])?);
        }
    }
    Ok(checks)
}

/// How far the mean torques on carrier and ring are off those by numbers of teeth, over what the
/// trapezoidal rule may be off.
///
/// `[eq:virtual-work]` Mean torques T (1 + Z_r/Z_s) on the carrier and −T Z_r/Z_s on the ring over a mesh cycle.
/// Source: closed form.
/// Checked by: `fe.kinematics.work`.
fn means(scene: &Scene, cycle: &SetCycle) -> Result<[f64; 2], ValidationError> {
    let missing = || ValidationError::Incomplete("numbers of teeth");
    let (sun, ring) = scene.teeth.and_then(|t| t.sun_ring()).ok_or_else(missing)?;
    let ratio = f64::from(ring) / f64::from(sun);
    let t = cycle.torque_nm;
    let one = |of: fn(&SetState) -> f64, expected: f64| {
        let list: Vec<f64> = cycle.states.iter().map(of).collect();
        let n = list.len() as f64;
        let mean = list.iter().sum::<f64>() / n;
        let at = |i: usize| list[i % list.len()];
        let bent: f64 = (0..list.len()).map(|i| (at(i + 2) - 2.0 * at(i + 1) + at(i)).abs()).sum();
        (mean - expected).abs() / (bent / (8.0 * n))
    };
    Ok([
        one(|s| s.reactions.carrier_nm, t * (1.0 + ratio)),
        one(|s| s.reactions.ring_nm, -t * ratio),
    ])
}

/// Unbalanced moment on the set, over the sun's torque.
fn open(cycle: &SetCycle) -> f64 {
    let t = cycle.torque_nm;
    let sum = |s: &SetState| s.reactions.carrier_nm + s.reactions.ring_nm - t;
    worst(cycle.states.iter().map(|s| sum(s) / t))
}
