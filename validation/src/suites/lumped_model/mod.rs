//! Natural frequencies, mode shapes and matrices of any set beside this project's lumped model of the same parameters,
//! or beside its limit of rotations alone.

mod matrices;
mod shapes;

use gearset::{Axis, Body};
use lumped::{LumpedModel, NaturalModes, SpringId};
use scene::Scene;

use super::Checks;
use super::lab::Lab;
use crate::check::Check;
use crate::compare::{ListedMode, ModelMode, compare, rigid_body_hz};
use crate::error::ValidationError;
use crate::reference::Reference;

pub(crate) use matrices::{Beside, Difference};
pub(crate) use shapes::ListedShape;
pub(crate) use shapes::beside as with_shapes;

/// Frequencies that differ by less than this part are one.
const EQUAL: f64 = 1e-9;

/// Modes of a model; of rotations alone if `is_torsional`.
fn modes_of(model: &LumpedModel, is_torsional: bool) -> Result<Vec<ModelMode>, ValidationError> {
    let mode = |group: &lumped::ModeGroup| ModelMode {
        frequency_hz: group.frequency_hz,
        mode_type: if is_torsional { "torsional" } else { group.mode_type.name() }.to_owned(),
        multiplicity: group.multiplicity,
    };
    let mut modes: Vec<ModelMode> = Vec::new();
    for next in NaturalModes::of(model)?.groups.iter().map(mode) {
        // The N − 1 modes of the planets against one another are one frequency of a model of rotations.
        let is_same = |last: &&mut ModelMode| {
            is_torsional
                && (next.frequency_hz - last.frequency_hz).abs() <= EQUAL * next.frequency_hz
        };
        match modes.last_mut().filter(is_same) {
            Some(last) => last.multiplicity += next.multiplicity,
            None => modes.push(next),
        }
    }
    Ok(modes)
}

/// Listed modes of the scene with that id. Modes above the highest of the list are not asked for.
pub(crate) fn beside(
    id: &str,
    title: &str,
    model: &LumpedModel,
    listed: &[ListedMode],
    is_torsional: bool,
    reference: &Reference,
) -> Checks {
    let percent = reference.registry.check("lumped_model.*")?.percent.unwrap_or_default();
    let modes = modes_of(model, is_torsional)?;
    let found = compare(listed, &modes, percent, false);
    let rigid_hz = rigid_body_hz(&modes);
    // A list without the type of every mode is matched by frequency, and its rows name no type.
    let is_typed = is_torsional || listed.iter().all(|mode| mode.mode_type.is_some());
    let mut numbers: Vec<(&str, usize)> = Vec::new();
    let mut checks = Vec::new();
    for pair in &found.matches {
        let mode_type = pair.model_type.as_deref().filter(|_| is_typed).unwrap_or("untyped");
        let kind = if pair.model_hz.is_some() { mode_type } else { "without_partner" };
        let number = match numbers.iter_mut().find(|(name, _)| *name == kind) {
            Some((_, number)) => {
                *number += 1;
                *number
            }
            None => {
                numbers.push((kind, 1));
                1
            }
        };
        let check = format!("lumped_model.{id}.{kind}.{number}");
        let title = match (pair.model_hz, is_typed) {
            (Some(_), true) => format!("{title}: {mode_type} mode {number}"),
            (Some(_), false) => format!("{title}: frequency {number}"),
            (None, _) => format!("{title}: frequency {number} without a mode of the model"),
        };
        let about = reference.about(&check, &title)?;
        checks.push(match (pair.model_hz, pair.difference_percent) {
            (Some(hz), None) => about.number_if_run(hz, (!pair.is_beyond_list).then_some(f64::NAN)),
            (Some(_), Some(_)) if let Some(listed) = &pair.listed_type => {
                about.equal(mode_type, listed.as_str())
            }
            (Some(hz), Some(difference)) => match &pair.remark {
                Some(remark) if difference.abs() <= percent => {
                    about.equal(format!("{} times", pair.model_multiplicity), remark.as_str())
                }
                _ => match pair.listed_hz.iter().copied().max_by(f64::total_cmp) {
                    Some(highest) if hz <= rigid_hz && highest <= rigid_hz => {
                        let reason = "rigid-body motion: below a ten-thousandth of the highest frequency of the model";
                        about.at_most_within(highest, rigid_hz, reason)
                    }
                    _ => about.number(hz, hz * (1.0 + 0.01 * difference)),
                },
            },
            (None, _) => {
                let hz = pair.listed_hz.first().copied().unwrap_or(f64::NAN);
                about.equal("no such mode", format!("{hz} Hz"))
            }
        });
    }
    Ok(checks)
}

/// The limit of rigid bearings: the frequencies of rotations alone from the whole model.
pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let reference = lab.reference;
    let [scene] = <[Scene; 1]>::try_from(super::scenes_of(&[super::P::LinParkerFourPlanets])?)
        .map_err(|_| ValidationError::Incomplete("set of four planets"))?;
    let mut judged = limit(&scene, &scene, reference)?;
    let mut softer = scene.clone();
    if let Some(lumped) = &mut softer.lumped {
        lumped.mesh_n_per_m.ring_planet *= 0.99;
    }
    let spoilt = limit(&scene, &softer, reference)?;
    judged.push(reference.control("lumped_model.control.ring_mesh_softer", &spoilt)?);
    let spoilt = ring_axes_turned(&scene, reference)?;
    judged.push(reference.control("lumped_model.control.ring_axes_turned", &spoilt)?);
    Ok(judged)
}

/// The stiffness matrix with ψ_n − α_r in place of ψ_n + α_r, which changes no frequency.
fn ring_axes_turned(scene: &Scene, reference: &Reference) -> Checks {
    let model = LumpedModel::from_scene(scene)?;
    let mut turned = model.clone();
    let alpha = scene.lumped.as_ref().map_or(0.0, |lumped| lumped.pressure_angle_rad.ring_planet);
    let place = |axis| model.coordinates.of(Body::Ring, axis);
    for spring in &mut turned.springs {
        let SpringId::RingMesh(n) = spring.id else { continue };
        let (sin, cos) = (model.psi[n] - alpha).sin_cos();
        for (i, b) in spring.rows.iter_mut().flatten() {
            match Some(*i) {
                x if x == place(Axis::First) => *b = -sin,
                y if y == place(Axis::Second) => *b = cos,
                _ => {}
            }
        }
    }
    let beside = Beside {
        name: "stiffness",
        unit: "N/m",
        coordinates: &model.coordinates,
        given: &turned.stiffness(),
        model: &model.stiffness(),
    };
    let id = super::P::LinParkerFourPlanets.id();
    Ok(vec![beside.check(id, &scene.title, reference, |_| None)?])
}

/// Frequencies of `scene` with rotations alone against those of `stiffened` with bearings of 1e15 N/m.
fn limit(scene: &Scene, stiffened: &Scene, reference: &Reference) -> Checks {
    let mut stiff = stiffened.clone();
    let supports = &mut stiff.supports;
    for support in [&mut supports.sun, &mut supports.ring, &mut supports.carrier] {
        support.bearing_n_per_m = 1e15;
    }
    supports.planet_bearing_n_per_m = 1e15;
    let each = |modes: Vec<ModelMode>| -> Vec<f64> {
        let times = |m: &ModelMode| std::iter::repeat_n(m.frequency_hz, m.multiplicity);
        modes.iter().flat_map(times).collect()
    };
    let turning = LumpedModel::from_scene(scene)?.torsional();
    let stiff = LumpedModel::from_scene(&stiff)?;
    let (limit, whole) = (each(modes_of(&turning, true)?), each(modes_of(&stiff, false)?));
    let row = |(k, hz): (usize, &f64)| -> Result<Check, ValidationError> {
        let id = format!("lumped_model.limit.{}", k + 1);
        let title = format!("frequency {} of rotations alone, from rigid bearings", k + 1);
        Ok(reference.about(&id, &title)?.number(*hz, whole.get(k).copied().unwrap_or(f64::NAN)))
    };
    limit.iter().enumerate().filter(|(_, hz)| **hz > 0.0).map(row).collect()
}
