//! Whole sets at rest: balance, load sharing, symmetry.

use experiments::models::FeContact;
use experiments::{MeshCycle, RestState, StaticModel};
use fe_contact::statics::{Imperfections, PitchError, SetCycle};
use gearset::MeshKind;
use scene::{LoadCase, Scene};

use crate::check::{Check, Status};
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::lab::of_model;
use crate::suites::{AskedCycle, Checks, Lab};
use crate::variants::{RENUMBERED, mirrored, renumbered};
use crate::worst::{paired, peak_to_peak, worst};

/// Even, and a multiple of 14, the denominator of the OH-58's phases.
const POSITIONS: usize = 28;

const KINDS: [MeshKind; 2] = [MeshKind::SunPlanet, MeshKind::RingPlanet];

/// Torque on the sun of all these checks, N·m.
const TORQUE: f64 = 1413.0;

/// Our own model: the checks of any model, equilibrium of the races and reversed torque, controls.
pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let scenes = [lab.three.clone(), lab.four.clone()];
    let mut checks = asked(&lab.fe, &scenes, lab.reference)?;
    checks.extend(own(lab)?);
    let displaced =
        Imperfections { displaced_planets: vec![(1, 0.0, 50e-6)], ..Imperfections::default() };
    checks.push(control(lab, "fe.sets.control.displaced_planet", &[displaced])?);
    // One of these sun teeth is in mesh with planet 1 in this cycle.
    let pitch = |tooth| Imperfections {
        pitch_errors: vec![PitchError { tooth, amount: 10e-6 }],
        ..Imperfections::default()
    };
    checks.push(control(lab, "fe.sets.control.pitch_error", &[8, 9, 10].map(pitch))?);
    Ok(checks)
}

/// The sharing check on sets with imperfect gears; of several, one that fails it counts.
fn control(
    lab: &Lab<'_>,
    id: &str,
    imperfections: &[Imperfections],
) -> Result<Check, ValidationError> {
    let mut judged = Vec::new();
    for own in imperfections {
        let model = FeContact::sharing(lab.gears.clone()).with_imperfections(own.clone());
        let found = cycle(&model, &lab.three, TORQUE)?;
        judged.push(sharing_of_three(&found, lab.reference)?);
    }
    judged.sort_by_key(|c| c.status != Status::Fail);
    Ok(lab.reference.control(id, &judged)?)
}

/// Mesh cycles that are asked of a scene: of four planets also those of the mirrored and the renumbered set.
pub(crate) fn cycles(scene: &Scene) -> Vec<AskedCycle> {
    let cycle = |set, sun_torque_nm| AskedCycle { set, sun_torque_nm, positions: POSITIONS };
    let mut cycles = vec![cycle(scene.clone(), TORQUE)];
    if scene.planets.count() == RENUMBERED.len() {
        cycles.push(cycle(mirrored(scene), -TORQUE));
        cycles.push(cycle(renumbered(scene), TORQUE));
    }
    cycles
}

/// Checks on the mesh cycles of any model. `scenes`: sets of three or four planets.
pub(crate) fn asked(model: &dyn StaticModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let mut checks = Vec::new();
    for scene in scenes {
        let cycles = cycles(scene).into_iter().map(|c| cycle(model, &c.set, c.sun_torque_nm));
        match cycles.collect::<Result<Vec<_>, _>>()?.as_slice() {
            [found, image, other] => {
                checks.push(sharing_of_four(found, reference)?);
                checks.push(mirror(found, image, reference)?);
                checks.push(numbering(found, other, reference)?);
            }
            all => {
                for found in all {
                    checks.push(sharing_of_three(found, reference)?);
                    checks.push(sun_stays(found, reference)?);
                }
            }
        }
    }
    Ok(checks)
}

fn cycle(
    model: &dyn StaticModel,
    scene: &Scene,
    torque_nm: f64,
) -> Result<MeshCycle, ValidationError> {
    model.mesh_cycle(scene, &LoadCase::standing(torque_nm), POSITIONS).map_err(of_model)
}

fn sharing_of_three(found: &MeshCycle, reference: &Reference) -> Result<Check, ValidationError> {
    let spread = |state: &RestState, kind: MeshKind| {
        let forces = state.forces(kind);
        peak_to_peak(forces.iter().copied()) / worst(forces.iter().copied())
    };
    let all = found.states.iter().flat_map(|s| KINDS.map(|kind| spread(s, kind)));
    let title =
        "three planets: largest difference between mesh forces of the planets at any position";
    Ok(reference.about("fe.sets.sharing.three", title)?.at_most(worst(all)))
}

fn sun_stays(found: &MeshCycle, reference: &Reference) -> Result<Check, ValidationError> {
    let drift = worst(found.states.iter().flat_map(|s| [s.sun[0], s.sun[1]]));
    let title = "three planets: the sun does not translate";
    Ok(reference.about("fe.sets.sun_stays.three", title)?.at_most(1e6 * drift))
}

fn sharing_of_four(found: &MeshCycle, reference: &Reference) -> Result<Check, ValidationError> {
    let half = found.states.len() / 2;
    let later = found.states.iter().cycle().skip(half);
    let mut off = Vec::new();
    for (now, later) in found.states.iter().zip(later) {
        for kind in KINDS {
            let (a, b) = (now.forces(kind), later.forces(kind));
            off.extend(
                [(0, 2), (1, 3)].map(|(n, opposite)| force(a, n) / force(b, opposite) - 1.0),
            );
        }
    }
    let title = "four planets: opposed planets carry the same mesh force half a cycle apart";
    Ok(reference.about("fe.sets.sharing.four", title)?.at_most(worst(off)))
}

/// Mirrored set, reversed torque: y and θ change sign, nothing else.
fn mirror(
    own: &MeshCycle,
    image: &MeshCycle,
    reference: &Reference,
) -> Result<Check, ValidationError> {
    let scale = own.states.first().map_or(f64::NAN, |s| s.sun[2].abs());
    let flat = |c: &MeshCycle, signs: [f64; 3]| -> Vec<f64> {
        c.states.iter().flat_map(|s| [0, 1, 2].map(|k| signs[k] * s.sun[k])).collect()
    };
    let (a, b) = (flat(own, [1.0; 3]), flat(image, [1.0, -1.0, -1.0]));
    let off = worst(paired(&a, &b).map(|(a, b)| (a - b) / scale));
    let title =
        "mirrored set with reversed torque: displacements of the sun against the mirror image";
    Ok(reference.about("fe.sets.mirror", title)?.at_most(off))
}

fn numbering(
    own: &MeshCycle,
    other: &MeshCycle,
    reference: &Reference,
) -> Result<Check, ValidationError> {
    let mut off = Vec::new();
    if own.states.len() != other.states.len() {
        off.push(f64::NAN);
    }
    for (own, other) in own.states.iter().zip(&other.states) {
        for kind in KINDS {
            let of =
                |(new, old)| force(other.forces(kind), new) / force(own.forces(kind), old) - 1.0;
            off.extend(RENUMBERED.into_iter().enumerate().map(of));
        }
    }
    let title = "mesh forces after renumbering the planets";
    Ok(reference.about("fe.sets.numbering", title)?.at_most(worst(off)))
}

/// Force of a planet's mesh; not a number if there is none.
fn force(forces: &[f64], planet: usize) -> f64 {
    forces.get(planet).copied().unwrap_or(f64::NAN)
}

/// Equilibrium of all races, and the flanks that reversed torque loads.
fn own(lab: &Lab<'_>) -> Checks {
    let run = |scene: &Scene, torque: f64| {
        lab.set(scene, &lab.bodies, torque, POSITIONS, Imperfections::default())
    };
    let (three, four) = (run(&lab.three, TORQUE)?, run(&lab.four, TORQUE)?);
    let residuals = three.states.iter().chain(&four.states).map(|s| s.residual);
    let title =
        "largest imbalance of force or moment on any race, over the load, three and four planets";
    let balance = lab.about("fe.sets.balance", title)?.at_most(worst(residuals));
    // Torque reversed without mirroring the set: other flanks with other phases carry the load.
    let reversed = run(&lab.four, -TORQUE)?;
    let phase = |cycle: &SetCycle, n: usize| cycle.states[0].meshes[n].phase;
    let other = |a: f64, b: f64| (a - b - (a - b).round()).abs() > 1e-6;
    let is_other = other(phase(&four, 1), phase(&reversed, 1));
    let turned = reversed.states[0].central[2][2] < 0.0;
    let told = |x: bool| f64::from(u8::from(x));
    let title = "reversed torque turns the sun the other way, on flanks with phases of their own";
    let about = lab.about("fe.sets.reversed", title)?;
    Ok(vec![balance, about.equal(vec![1.0, 1.0], vec![told(is_other), told(turned)])])
}
