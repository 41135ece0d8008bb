//! Mesh stiffness over the mesh cycle of any set with tooth geometry, beside this project's finite-element/contact pair
//! of the same gears under the same load.
//!
//! With k_j = F/δ_j at the positions p_j of a table and κ_j of the pair at the same phases, k̄ and κ̄ their means:
//!
//! ```text
//! mean    k̄ against κ̄
//! shape   √(Σ_j (k_j/k̄ − κ_j/κ̄)² / Σ_j (κ_j/κ̄ − 1)²) against 0; 1 of a constant stiffness
//! F = |T_s|/(N r_bs);   phase of the sun mesh p_j, of the ring mesh p_j + φ_r0 − φ_s0
//! ```
//!
//! A cycle that starts elsewhere, runs backwards or holds two cycles has the right mean and another shape.

use experiments::{BodiesCache, MeshStiffness};
use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Imperfections, at_phase};
use gearset::{MeshKind, Phasing};
use scene::{LoadCase, Scene};

use super::lab::MESHES;
use super::{Checks, Lab};
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::worst::{paired, worst};

/// Most positions of a cycle that are held against the pair; of more every second, third and so on is taken.
const MOST_POSITIONS: usize = 56;

/// Whether a set has all that the pair is computed from.
pub(crate) fn has_geometry(set: &Scene) -> bool {
    set.tooth_geometry().is_ok_and(|g| g.sun.is_some() && Phasing::new(&g, &set.planets).is_some())
}

/// Cycles of planet 0's meshes of the scene with that id, in any order; none without tooth geometry.
pub(crate) fn beside(
    id: &str,
    set: &Scene,
    cycles: &[&MeshStiffness],
    gears: &BodiesCache,
    reference: &Reference,
) -> Checks {
    let mut checks = Vec::new();
    for kind in MESHES {
        let mut of_kind: Vec<&MeshStiffness> =
            cycles.iter().filter(|cycle| cycle.kind == kind).copied().collect();
        of_kind.sort_by(|a, b| a.case.sun_torque_nm.total_cmp(&b.case.sun_torque_nm));
        for (number, cycle) in of_kind.into_iter().enumerate() {
            let every = cycle.positions.len().div_ceil(MOST_POSITIONS).max(1);
            let sample = |list: &[f64]| list.iter().step_by(every).copied().collect::<Vec<f64>>();
            let [positions, found] = [&cycle.positions, &cycle.secant_n_per_m].map(|l| sample(l));
            let Some(pair) = pair(set, kind, cycle.case.sun_torque_nm, &positions, gears)? else {
                return Ok(Vec::new());
            };
            let (mean, pair_mean) = (mean(&found), mean(&pair));
            let off = paired(&found, &pair).map(|(k, of_pair)| k / mean - of_pair / pair_mean);
            let squares: f64 = off.map(|off| off * off).sum();
            let of_pair: f64 = pair.iter().map(|of_pair| (of_pair / pair_mean - 1.0).powi(2)).sum();
            // Not a number, which fails, if a value is none.
            let shape = 100.0 * (squares / of_pair).sqrt();
            let front = format!("pair_stiffness.{id}.{}.{}", kind.name(), number + 1);
            let mesh = format!(
                "{}: {} mesh at {} N·m",
                set.title,
                kind.name().replace('_', "–"),
                cycle.case.sun_torque_nm
            );
            let (id, title) = (format!("{front}.mean"), format!("{mesh}, mean secant stiffness"));
            checks.push(reference.about(&id, &title)?.number(1e-6 * pair_mean, 1e-6 * mean));
            let title = format!(
                "{mesh}, RMS difference of k/mean from that of the pair, over its variation"
            );
            let id = format!("{front}.shape");
            checks.push(reference.about(&id, &title)?.at_most(worst([shape])));
        }
    }
    Ok(checks)
}

fn mean(list: &[f64]) -> f64 {
    list.iter().sum::<f64>() / list.len() as f64
}

/// Secant stiffness of the pair at some phases of the sun mesh, N/m; `None` of a set without tooth geometry.
fn pair(
    set: &Scene,
    kind: MeshKind,
    sun_torque_nm: f64,
    positions: &[f64],
    gears: &BodiesCache,
) -> Result<Option<Vec<f64>>, FeError> {
    let Ok(geometry) = set.tooth_geometry() else { return Ok(None) };
    let (Some(sun), Some(phasing)) = (&geometry.sun, Phasing::new(&geometry, &set.planets)) else {
        return Ok(None);
    };
    let force = sun_torque_nm.abs() / (set.planets.count() as f64 * sun.base_radius);
    let phases = phasing.phases(0.0, LoadCase::standing(sun_torque_nm).sense());
    let shift = match kind {
        MeshKind::SunPlanet => 0.0,
        MeshKind::RingPlanet => phases.ring_planet[0] - phases.sun_planet[0],
    };
    let bodies = gears.of(set)?;
    let secant = |position: &f64| {
        let phase = (position + shift).rem_euclid(1.0);
        at_phase(&bodies, kind, force, phase, &ActiveSet).map(|found| force / found.deflection)
    };
    positions.iter().map(secant).collect::<Result<_, _>>().map(Some)
}

/// Meshes of planet 0 in a whole set of three planets, which carry equal loads, against the pair; control: the cycle
/// begun half a cycle later.
pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let torque_nm = 1130.0;
    let set = lab.set(&lab.three, &lab.bodies, torque_nm, 28, Imperfections::default())?;
    let cycle = |kind: MeshKind| -> Result<MeshStiffness, ValidationError> {
        let mut secant_n_per_m = Vec::new();
        for state in &set.states {
            let mesh = state.meshes.iter().find(|mesh| mesh.planet == 0 && mesh.kind == kind);
            let mesh = mesh.ok_or(ValidationError::Incomplete("mesh of planet 0"))?;
            secant_n_per_m.push(mesh.secant_stiffness());
        }
        let positions = set.states.iter().map(|state| state.position).collect();
        Ok(MeshStiffness { case: LoadCase::standing(torque_nm), kind, positions, secant_n_per_m })
    };
    let mut cycles = MESHES.map(cycle).into_iter().collect::<Result<Vec<_>, _>>()?;
    let judged = |cycles: &[MeshStiffness]| {
        let cycles: Vec<&MeshStiffness> = cycles.iter().collect();
        beside("oh58_3p", &lab.three, &cycles, &lab.gears, lab.reference)
    };
    let mut checks = judged(&cycles)?;
    cycles.iter_mut().for_each(|cycle| cycle.secant_n_per_m.rotate_left(14));
    let spoilt = judged(&cycles)?;
    checks.push(lab.reference.control("pair_stiffness.control.half_a_cycle_late", &spoilt)?);
    Ok(checks)
}
