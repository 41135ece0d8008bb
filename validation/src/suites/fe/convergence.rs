//! Sensitivity of the result to matching depth, contact cells, elements and contact solver.

use dynamics::extrapolate;
use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, Lemke};
use fe_contact::statics::{Bodies, PairCycle, at_phase};
use gearset::MeshKind;

use crate::check::Check;
use crate::error::ValidationError;
use crate::suites::lab::MESHES;
use crate::suites::{Checks, Lab};
use crate::worst::{paired, peak_to_peak, worst};

/// Positions of the mesh cycle; corner contacts and single pairs are among them.
const POSITIONS: usize = 20;

/// Depths over the default one: a plateau of a factor 2.
const DEPTHS: [f64; 4] = [0.7, 0.9, 1.15, 1.4];

/// Largest relative change of the deflection at any position.
fn largest_change(a: &PairCycle, b: &PairCycle) -> f64 {
    let deflections = |c: &PairCycle| c.positions.iter().map(|p| p.deflection).collect::<Vec<_>>();
    worst(paired(&deflections(a), &deflections(b)).map(|(a, b)| a / b - 1.0))
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    for kind in MESHES {
        checks.push(depth(lab, kind, 1.0)?);
        checks.push(cells(lab, kind)?);
        checks.extend(solvers(lab, kind)?);
    }
    checks.extend(elements(lab)?);
    let spoilt = [depth(lab, MeshKind::SunPlanet, 0.2)?];
    checks.push(lab.reference.control("fe.convergence.control.shallow", &spoilt)?);
    Ok(checks)
}

/// Matching depths about the default one times a factor.
fn depth(lab: &Lab<'_>, kind: MeshKind, factor: f64) -> Result<Check, ValidationError> {
    let name = kind.name();
    let mut varied = Bodies::clone(&lab.bodies);
    let mut stiffness = Vec::new();
    for times in DEPTHS {
        varied.settings.matching.depth = factor * times * lab.bodies.settings.matching.depth;
        stiffness.push(lab.pair(&varied, kind, POSITIONS)?.mean_secant_stiffness());
    }
    let least = stiffness.iter().fold(f64::INFINITY, |a, k| a.min(*k));
    let id = format!("fe.convergence.depth.{name}");
    let title = format!(
        "{name} mesh: change of the mean stiffness over matching depths from 0.7 to 1.4 of the default"
    );
    Ok(lab.about(&id, &title)?.at_most(100.0 * peak_to_peak(stiffness) / least))
}

fn cells(lab: &Lab<'_>, kind: MeshKind) -> Result<Check, ValidationError> {
    let name = kind.name();
    let base = lab.pair(&lab.bodies, kind, POSITIONS)?;
    let mut varied = Bodies::clone(&lab.bodies);
    varied.settings.input.contact_cells *= 2;
    let finer = lab.pair(&varied, kind, POSITIONS)?;
    let id = format!("fe.convergence.cells.{name}");
    let title = format!("{name} mesh: largest change of δ at any position with twice the cells");
    Ok(lab.about(&id, &title)?.at_most(100.0 * largest_change(&base, &finer)))
}

/// Three grids of elements.
fn elements(lab: &Lab<'_>) -> Checks {
    let default = lab.four.fe_contact.flank_elements;
    let grids = [10, default, 20];
    // One grid after the other, so that at most two sets of gears are in memory.
    let mut cycles = Vec::new();
    for flank in grids {
        let mut scene = lab.four.clone();
        scene.fe_contact.flank_elements = flank;
        scene.fe_contact.matching_depth_m = Some(lab.bodies.settings.matching.depth);
        let made;
        let bodies: &Bodies = if flank == default {
            &lab.bodies
        } else {
            made = Bodies::new(&scene)?;
            &made
        };
        let of = |kind| lab.pair(bodies, kind, POSITIONS);
        cycles.push(MESHES.map(of).into_iter().collect::<Result<Vec<PairCycle>, _>>()?);
    }
    let mut checks = Vec::new();
    for (k, kind) in MESHES.into_iter().enumerate() {
        let name = kind.name();
        let values = [0, 1, 2].map(|grid| cycles[grid][k].mean_secant_stiffness());
        let limit = extrapolate(&values, &grids.map(f64::from), None);
        let gci = limit.error_of(values[1]) / values[2];
        let id = format!("fe.convergence.gci.{name}");
        let title = format!(
            "{name} mesh: grid convergence index of the mean stiffness at the default mesh, from 10, 14 and 20 flank elements"
        );
        checks.push(lab.about(&id, &title)?.at_most(100.0 * gci));
        let change = largest_change(&cycles[1][k], &cycles[2][k]);
        let id = format!("fe.convergence.elements.{name}");
        let title = format!(
            "{name} mesh: largest change of δ at any position from the default to 20 flank elements"
        );
        checks.push(lab.about(&id, &title)?.at_most(100.0 * change));
    }
    Ok(checks)
}

/// The interior-point solver, if it is built in.
fn interior_point() -> Option<&'static dyn ComplementaritySolver> {
    #[cfg(feature = "interior_point")]
    return Some(&fe_contact::complementarity::InteriorPoint);
    #[cfg(not(feature = "interior_point"))]
    return None;
}

/// Three solvers on the same contact problem, which includes a corner contact.
fn solvers(lab: &Lab<'_>, kind: MeshKind) -> Checks {
    let name = kind.name();
    let phase = 0.95;
    let solve = |solver: &dyn ComplementaritySolver| {
        Ok::<_, ValidationError>(
            at_phase(&lab.bodies, kind, lab.force, phase, solver)?.answer.cell_forces,
        )
    };
    let active = solve(&ActiveSet)?;
    let peak = worst(active.iter().copied());
    let others: [(&str, Option<&dyn ComplementaritySolver>); 2] =
        [("lemke", Some(&Lemke)), ("interior_point", interior_point())];
    let mut checks = Vec::new();
    for (other, solver) in others {
        let off = match solver {
            Some(solver) => {
                let forces = solve(solver)?;
                Some(worst(paired(&active, &forces).map(|(a, b)| a - b)) / peak)
            }
            None => None,
        };
        let id = format!("fe.convergence.solvers.{other}.{name}");
        let title = format!(
            "{name} mesh at phase {phase}: cell forces by active set and by {other}, over the peak"
        );
        checks.push(lab.about(&id, &title)?.at_most_if_run(off));
    }
    Ok(checks)
}
