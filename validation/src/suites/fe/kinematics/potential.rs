//! The forces of the meshes are the gradient of one potential, their energy over the races' displacements.

use fe_contact::statics::StaticSet;

use super::{control, unloaded};
use crate::error::ValidationError;
use crate::suites::lab::MESHES;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

const TORQUE: f64 = 1130.0;

/// Half of the span of a central difference, m.
const STEP: f64 = 0.2e-6;

/// Largest displacement of a race from the mean loaded configuration, m.
const MOVED: f64 = 3e-6;

/// Positions in the mesh cycle; the first is that of the quick profile.
const AT: [f64; 3] = [0.15, 0.4, 0.8];

/// Largest differences between difference quotients of the potential and forces, over an even share of the
/// torque.
struct Differences {
    /// Against the gradient.
    gradient: f64,
    /// Against the part of the gradient along the lines of action.
    along_lines: f64,
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let set = unloaded(&lab.four, &lab.bodies)?.under(TORQUE)?;
    let mut random = fastrand::Rng::with_seed(1);
    let mut checks = Vec::new();
    for (k, position) in AT.into_iter().enumerate() {
        let id = format!("fe.kinematics.potential.{k}");
        let is_run = lab.runs(&id)?;
        let found = is_run.then(|| differences(lab, &set, position, &mut random)).transpose()?;
        let title = format!(
            "four planets, {TORQUE} N·m, races displaced by up to {:.0} µm from the mean loaded configuration, position {position}: forces of the meshes on each race's coordinates against differences of the meshes' energy, over an even share of the torque",
            1e6 * MOVED
        );
        let gradient = found.as_ref().map(|d| d.gradient);
        checks.push(lab.about(&id, &title)?.at_most_if_run(gradient));
        if let (0, Some(found)) = (k, &found) {
            let own = "fe.kinematics.potential.control.along_lines";
            checks.push(control(lab, own, &id, found.along_lines)?);
        }
    }
    Ok(checks)
}

fn differences(
    lab: &Lab<'_>,
    set: &StaticSet<'_>,
    position: f64,
    random: &mut fastrand::Rng,
) -> Result<Differences, ValidationError> {
    let mut q = set.reference().q.clone();
    for x in q.iter_mut() {
        *x += MOVED * (2.0 * random.f64() - 1.0);
    }
    let (_, gradient) = set.mesh_potential(TORQUE, position, &q)?;
    let along_lines = along_lines(lab, set, q.as_slice(), gradient.as_slice())?;
    let mut moved = q.clone();
    let mut off = [Vec::new(), Vec::new()];
    // The carrier's coordinates enter no mesh.
    let carrier = set.races().places(gearset::Body::Carrier);
    for i in (0..q.len()).filter(|i| !carrier.contains(&Some(*i))) {
        let mut at = |step: f64| {
            moved[i] = q[i] + step;
            set.mesh_potential(TORQUE, position, &moved).map(|found| found.0)
        };
        let slope = (at(STEP)? - at(-STEP)?) / (2.0 * STEP);
        moved[i] = q[i];
        off[0].push((slope - gradient[i]).abs());
        off[1].push((slope - along_lines[i]).abs());
    }
    let sun = lab.bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    let share = TORQUE / sun.base_radius / set.races().planets() as f64;
    let [gradient, along_lines] = off.map(|list| worst(list) / share);
    Ok(Differences { gradient, along_lines })
}

/// The part of a gradient (N) on the races' coordinates q that forces of the meshes along their lines of
/// action can make up.
fn along_lines(
    lab: &Lab<'_>,
    set: &StaticSet<'_>,
    q: &[f64],
    gradient: &[f64],
) -> Result<Vec<f64>, ValidationError> {
    let races = set.races();
    let mut part = vec![0.0; q.len()];
    // Gradients of the meshes' approaches, orthonormalised one after the other.
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for kind in MESHES {
        let missing = || ValidationError::Incomplete("mesh");
        let mesh = lab.bodies.geometry.mesh(kind).ok_or_else(missing)?;
        for planet in 0..races.planets() {
            // The line of action does not depend on the phase.
            let places = races.mesh_displacements(kind, planet, q);
            let displaced = mesh.displaced(0.0, &places).map_err(|_| missing())?;
            let mut row = races.approach(kind, planet, &displaced.gradients().approach);
            for other in &rows {
                let share = dot(&row, other);
                row.iter_mut().zip(other).for_each(|(x, other)| *x -= share * other);
            }
            let length = dot(&row, &row).sqrt();
            row.iter_mut().for_each(|x| *x /= length);
            let share = dot(gradient, &row);
            part.iter_mut().zip(&row).for_each(|(x, row)| *x += share * row);
            rows.push(row);
        }
    }
    Ok(part)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
