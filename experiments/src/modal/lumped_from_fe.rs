//! The lumped model with parameters from finite elements: same equations, parameters from the meshes.
//!
//! Bearings are the scene's. The linearised FE/contact set differs from this model by effects
//! that a lumped model does not have: flexibility of the carrier, corner contacts that press along another
//! normal than the line of action, slopes of the deformed flanks, and mesh forces that turn with their lines
//! of action.

use fe_contact::statics::{Bodies, Races};
use gearset::PlanetPositions;
use lumped::{LumpedModel, ModeType, NaturalModes, Participation};
use scene::{LumpedInput, PerBody, PerMesh, PlanetOverride, Scene};

use super::error::ModalError;
use super::kinds::type_of;
use super::linear::{Preload, preloaded};
use crate::natural_mode::NaturalMode;

/// The scene with lumped parameters from its meshed bodies at a position and preload; for clockwise torque it
/// is the mirrored set.
///
/// `[eq:lumped-from-fe]` k = 1ᵀS1 over the pairs of a mesh at one frozen position and preload; masses and inertias of
/// the meshed bodies, lines of action of the loaded set.
/// Source: derived here.
/// Checked by:
/// `validation/tests/lumped_from_fe.rs::where_all_pairs_press_along_the_line_of_action_the_models_are_one`,
/// `lumped_from_fe.line_of_action`, `lumped_from_fe.rigid_carrier`.
///
/// # Errors
/// If the set has no equilibrium there, or backside flanks press, which the lumped model does not have.
pub fn lumped_from_fe(
    scene: &Scene,
    bodies: &Bodies,
    preload: &Preload,
) -> Result<Scene, ModalError> {
    let set = preloaded(scene, bodies, preload)?;
    let angles = set.reference().pressure_angles();
    lumped_from_tangents(scene, bodies, set.races(), &angles, &set.linearised()?.mesh_tangents)
}

/// The same with given pressure angles under load (rad; means over the planets are taken) and tangent mesh
/// stiffnesses (N/m): sun meshes, then ring meshes, one per planet.
///
/// # Errors
/// If there are more tangents than meshes, or the scene lacks a mesh or a mass.
pub fn lumped_from_tangents(
    scene: &Scene,
    bodies: &Bodies,
    races: &Races,
    angles: &[f64],
    tangents: &[f64],
) -> Result<Scene, ModalError> {
    let n = races.planets();
    if angles.len() != 2 * n
        || tangents.len() < 2 * n
        || tangents[2 * n..].iter().any(|t| *t != 0.0)
    {
        return Err(ModalError::Incomplete("set whose front flanks alone press"));
    }
    let (sun_meshes, ring_meshes) = (&tangents[..n], &tangents[n..2 * n]);
    let overrides = (0..n).map(|planet| PlanetOverride {
        planet,
        bearing_n_per_m: scene
            .overrides
            .iter()
            .find(|o| o.planet == planet)
            .and_then(|o| o.bearing_n_per_m),
        sun_mesh_n_per_m: Some(sun_meshes[planet]),
        ring_mesh_n_per_m: Some(ring_meshes[planet]),
        ..PlanetOverride::default()
    });
    let (mass, inertia_over_r2) = mass_properties(scene, bodies, races);
    let [carrier, ring, sun, planet] = races.radii.map(Some);
    let mean = |list: &[f64]| list.iter().sum::<f64>() / n as f64;
    let mut from_fe = scene.clone();
    // Assembly steps serve mesh phases, which are not used at a frozen position.
    from_fe.planets = PlanetPositions { psi_rad: races.psi.clone(), steps: None };
    from_fe.overrides = overrides.collect();
    from_fe.lumped = Some(LumpedInput {
        mass_kg: mass,
        inertia_over_r2_kg: inertia_over_r2,
        radius_m: PerBody { carrier, ring, sun, planet },
        mesh_n_per_m: PerMesh { sun_planet: mean(sun_meshes), ring_planet: mean(ring_meshes) },
        pressure_angle_rad: PerMesh {
            sun_planet: mean(&angles[..n]),
            ring_planet: mean(&angles[n..]),
        },
    });
    Ok(from_fe)
}

/// Mass (kg) and I/r² (kg) of the meshed bodies; those of a carrier without geometry are the scene's lumped
/// values.
fn mass_properties(scene: &Scene, bodies: &Bodies, races: &Races) -> (PerBody, PerBody) {
    let [r_carrier, r_ring, r_sun, r_planet] = races.radii.map(|r| r * r);
    let given =
        || scene.lumped.as_ref().and_then(|l| l.mass_kg.carrier.zip(l.inertia_over_r2_kg.carrier));
    let carrier = match &races.carrier {
        Some(body) => Some((body.mass, body.inertia / r_carrier)),
        None => given(),
    };
    let ring = bodies.ring.as_ref().map(|b| (b.mass, b.inertia / r_ring));
    let sun = bodies.sun.as_ref().map(|b| (b.mass, b.inertia / r_sun));
    let planet = Some((bodies.planet.mass, bodies.planet.inertia / r_planet));
    let all = [carrier, ring, sun, planet];
    let per_body =
        |[carrier, ring, sun, planet]: [Option<f64>; 4]| PerBody { carrier, ring, sun, planet };
    (per_body(all.map(|b| b.map(|(m, _)| m))), per_body(all.map(|b| b.map(|(_, i)| i))))
}

/// Frequencies of a lumped scene, ascending, each with its multiplicity and the type that has the
/// larger part of its kinetic energy: at one position planets differ, and kinds mix a little.
///
/// # Errors
/// If the scene has no lumped model, or its eigenproblem fails.
pub fn lumped_frequencies(scene: &Scene) -> Result<Vec<NaturalMode>, ModalError> {
    let model = LumpedModel::from_scene(scene)?;
    let modes = NaturalModes::of(&model)?;
    let of = |group: &lumped::ModeGroup| {
        let mode_type = majority(&group.participation);
        let one = NaturalMode { mode_type, frequency_hz: group.frequency_hz };
        std::iter::repeat_n(one, group.multiplicity)
    };
    Ok(modes.groups.iter().flat_map(of).collect())
}

/// Type by majority of kinetic energy.
pub fn majority(shares: &Participation) -> ModeType {
    type_of(&[shares.rotational, shares.translational, shares.planet])
}
