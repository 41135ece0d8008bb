//! The bodies of a vibrating set, at the level of fidelity of its scene.

use std::sync::Arc;

use dynamics::AverageAcceleration;
use gearset::{Body, MeshKind};
use nalgebra::DMatrix;
use scene::{Fidelity, Freedom, GivenInertia, Scene, SceneKind};

use super::body::{Port, VibratingBody};
use super::damping::Proportional;
use super::fixed_race_mode::{FixedRaceMode, fixed_race_modes};
use super::full_body::{FullBody, SharedFactors};
use super::gear::VibratingGear;
use super::modal_body::ModalBody;
use super::teeth::tooth_points;
use crate::body::{BodyMatrices, GearBody, number_unknowns};
use crate::error::FeError;
use crate::statics::{Bodies, FLEXIBILITY_FACTOR, SetTables, StaticSet};

/// Settings that all bodies of a set share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settings {
    pub(super) fidelity: Fidelity,
    pub(super) damping: Proportional,
    pub(super) rule: AverageAcceleration,
}

/// Refuses flexibility factors other than 1 where bodies have elastic states of their own, which
/// several meshes share.
pub(super) fn one_flexibility(scene: &Scene, bodies: &Bodies) -> Result<(), FeError> {
    if scene.dynamics.fidelity == Fidelity::QuasiStatic {
        return Ok(());
    }
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let factor = bodies.flexibility_factor(kind);
        if factor != 1.0 {
            return Err(FeError::Unfit {
                key: format!("{FLEXIBILITY_FACTOR}.{}", kind.name()),
                value: format!("{factor}"),
                allowed: "1, or `dynamics.fidelity` = \"quasi_static\"".into(),
                why: "a planet that vibrates within itself cannot be softer for one mesh alone"
                    .into(),
            });
        }
    }
    Ok(())
}

/// Ring, sun and planets; tooth 0 of every body of the set, carrier first, stands at its angle (rad) at the start.
pub(super) fn gears<'s>(
    statics: &StaticSet<'s>,
    scene: &Scene,
    angles: &[f64],
    settings: &Settings,
) -> Result<Vec<VibratingGear<'s>>, FeError> {
    let bodies = statics.bodies;
    let races = &statics.races;
    let missing = |key: &str| FeError::Missing { key: key.into(), why: "a set needs it" };
    let sun = bodies.sun.as_ref().ok_or_else(|| missing("geometry.sun"))?;
    // A pair has no ring: a gear without mass and mesh has its number, so that bodies are numbered as in a set.
    let ring = match scene.kind {
        SceneKind::Planetary => bodies.ring.as_ref().ok_or_else(|| missing("geometry.ring"))?,
        SceneKind::GearPair => &bodies.planet,
    };
    let kinds = [(Body::Ring, ring), (Body::Sun, sun), (Body::Planet(0), &bodies.planet)];
    let mut gears = Vec::with_capacity(2 + races.planets());
    for (kind, body) in kinds {
        let is_absent = kind == Body::Ring && scene.kind == SceneKind::GearPair;
        let absent = Settings { fidelity: Fidelity::QuasiStatic, ..*settings };
        let settings = if is_absent { &absent } else { settings };
        let mass = body_mass(statics, scene, kind)?;
        let radius = races.radii[kind.kind()];
        let make = flexible(settings, body.mesh.name, radius, mass, &|| {
            BodyMatrices::of_gear(&body.mesh, &body.material, body.face_width)
        })?;
        let count = if kind == Body::Planet(0) { races.planets() } else { 1 };
        let vibrating: Vec<_> = (0..count).map(|_| make()).collect();
        // Bodies without elastic states have no ports.
        let is_elastic = vibrating.iter().any(|own| own.unknowns() > 0);
        let unknown_of =
            Arc::new(if is_elastic { number_unknowns(&body.mesh) } else { Vec::new() });
        for (n, vibrating) in vibrating.into_iter().enumerate() {
            gears.push(VibratingGear {
                body,
                vibrating,
                unknown_of: unknown_of.clone(),
                start: angles[kind.index() + n],
                // Relative to the carrier the sun turns forwards, planets and ring turn backwards.
                rate: body.mesh.outline.gear().pitch_angle()
                    * if kind == Body::Sun { 1.0 } else { -1.0 },
            });
        }
    }
    Ok(gears)
}

/// A function that makes bodies of one kind, which share factors and modes.
fn flexible<'a>(
    settings: &Settings,
    name: &'static str,
    radius: f64,
    mass: [f64; 3],
    matrices: &dyn Fn() -> Result<BodyMatrices, FeError>,
) -> Result<Box<dyn Fn() -> Box<dyn VibratingBody> + 'a>, FeError> {
    let Settings { fidelity, damping, rule } = *settings;
    match fidelity {
        Fidelity::Full => {
            let shared = SharedFactors::new(Arc::new(matrices()?), name, radius, damping, rule)?;
            Ok(Box::new(move || Box::new(FullBody::new(mass, shared.clone()))))
        }
        Fidelity::MeshLaw => Err(FeError::NoContact),
        Fidelity::QuasiStatic | Fidelity::Modal(_) => {
            let modes: Arc<[FixedRaceMode]> = match fidelity {
                Fidelity::Modal(n) => {
                    fixed_race_modes(&matrices()?, n as usize, radius, name)?.into()
                }
                _ => Arc::new([]),
            };
            Ok(Box::new(move || Box::new(ModalBody::new(mass, damping, modes.clone(), rule))))
        }
    }
}

/// A carrier, the ports of its seats (radial and tangential of each), their static flexibility
/// (2N×2N, m/N).
pub(super) type SeatedCarrier = (Box<dyn VibratingBody>, Vec<Port>, DMatrix<f64>);

/// The carrier with its seats' ports and static flexibility (2N×2N, m/N).
pub(super) fn carrier(
    statics: &StaticSet<'_>,
    scene: &Scene,
    settings: &Settings,
) -> Result<SeatedCarrier, FeError> {
    let races = &statics.races;
    let n = races.seated;
    let mass = body_mass(statics, scene, Body::Carrier)?;
    let Some(body) = races.carrier.as_ref().filter(|b| !b.is_rigid) else {
        let rigid = Settings { fidelity: Fidelity::QuasiStatic, ..*settings };
        let make = flexible(&rigid, "carrier", races.radii[0], mass, &|| {
            Err(FeError::NoEquilibrium("a rigid carrier has no matrices".into()))
        })?;
        return Ok((make(), vec![Port::default(); 2 * n], DMatrix::zeros(2 * n, 2 * n)));
    };
    let make = flexible(settings, "carrier", races.radii[0], mass, &|| Ok(body.matrices.clone()))?;
    let port = |k: usize| Port { terms: body.seat_terms(k / 2, k % 2).to_vec() };
    Ok((make(), (0..2 * n).map(port).collect(), body.flexibility.clone()))
}

/// Mass, mass and polar inertia over r² of a body, kg, from its FE
/// mesh. A carrier without geometry has the mass and inertia of the lumped parameters, or 0 if it
/// is held; planets include the mass and inertia fixed to them.
pub(super) fn body_mass(
    statics: &StaticSet<'_>,
    scene: &Scene,
    body: Body,
) -> Result<[f64; 3], FeError> {
    let races = &statics.races;
    let bodies = statics.bodies;
    let of_gear = |gear: &GearBody, radius: f64, given: GivenInertia| {
        let mass = given.mass_kg.unwrap_or(gear.mass);
        [mass, mass, given.inertia_kg_m2.unwrap_or(gear.inertia) / (radius * radius)]
    };
    let pair = scene.supports.pair;
    let none = GivenInertia::default();
    let missing = |key: &str| FeError::Missing { key: key.into(), why: "its motion needs a mass" };
    match body {
        Body::Carrier => {
            if let Some(own) = &races.carrier {
                return Ok([own.mass, own.mass, own.inertia / races.radii[0].powi(2)]);
            }
            if scene.supports.carrier.motion == Freedom::Held {
                return Ok([0.0; 3]);
            }
            let lumped = scene.lumped.as_ref();
            let mass = lumped.and_then(|l| l.mass_kg.carrier);
            let mass = mass.ok_or_else(|| missing("geometry.carrier"))?;
            let turning = lumped.and_then(|l| l.inertia_over_r2_kg.carrier).unwrap_or(0.0);
            Ok([mass, mass, turning])
        }
        Body::Ring if pair.is_some() => Ok([0.0; 3]),
        Body::Ring => {
            let ring = bodies.ring.as_ref().ok_or_else(|| missing("geometry.ring"))?;
            Ok(of_gear(ring, races.radii[1], none))
        }
        Body::Sun => {
            let sun = bodies.sun.as_ref().ok_or_else(|| missing("geometry.sun"))?;
            Ok(of_gear(sun, races.radii[2], pair.map_or(none, |p| p.sun_inertia)))
        }
        Body::Planet(_) => {
            let added = scene.supports.planet_added;
            let given = pair.map_or(none, |p| p.planet_inertia);
            let [mass, _, turning] = of_gear(&bodies.planet, races.radii[3], given);
            let mass = mass + added.mass_kg;
            Ok([mass, mass, turning + added.inertia_kg_m2 / races.radii[3].powi(2)])
        }
    }
}

/// Angle of tooth 0 of every body at a position (carrier first, 0), rad: that of a tooth in
/// contact.
pub(super) fn start_angles(
    statics: &StaticSet<'_>,
    tables: &SetTables,
    start: f64,
) -> Result<Vec<f64>, FeError> {
    let mut angles = vec![0.0; 3 + statics.races.planets()];
    let mut known = vec![false; angles.len()];
    for (which, placed) in statics.place(start, tables).iter().enumerate() {
        for ends in tooth_points(statics, which, placed)? {
            for end in ends {
                if !std::mem::replace(&mut known[end.body.index()], true) {
                    angles[end.body.index()] = end.axis;
                }
            }
        }
    }
    Ok(angles)
}
