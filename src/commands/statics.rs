//! `static SCENE`: a gear pair or a whole set at rest.

use std::io::Write;
use std::path::Path;

#[cfg(feature = "interior_point")]
use fe_contact::complementarity::InteriorPoint;
use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, Lemke};
use gearset::{LoadCase, Scene, SceneKind, Verb};

use crate::arguments::{ContactSolver, Static};
use crate::error::CommandError;

use super::{needs, read_scene, static_approach, static_pair, static_set, unfit};

pub(crate) fn run(
    arguments: &Static,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<(), CommandError> {
    let scene = read_scene(&arguments.scene)?;
    if scene.geometry.is_none() {
        let reason = "[geometry] is absent: teeth are needed to touch";
        return Err(unfit(&arguments.scene, reason));
    }
    if let Some(option) = arguments.without_approach() {
        return Err(refused(option, "has no use without --approach-um, which turns a gear pair"));
    }
    let path = &arguments.scene;
    needs::warn(&scene, err)?;
    #[cfg(feature = "charts")]
    needs::warn_of_title(&scene, arguments.figures.as_deref(), err)?;
    match scene.kind {
        SceneKind::GearPair if arguments.approach_um.is_some() => {
            static_approach::run(arguments, &scene, out)
        }
        _ if arguments.approach_um.is_some() => {
            Err(refused("--approach-um", "only a gear pair is turned by an approach"))
        }
        SceneKind::GearPair => {
            let force = pair_force(arguments, &scene)?;
            static_pair::run(arguments, &scene, force, out)
        }
        SceneKind::Planetary => {
            let torques = set_torques(arguments, &scene)?;
            let is_given = |argument: &str| {
                argument == "--sun-torque-nm" && !arguments.sun_torque_nm.is_empty()
            };
            needs::require(path, &scene, Verb::Static, is_given)?;
            static_set::run(arguments, &scene, &torques, out)
        }
    }
}

/// The solver asked for.
pub(super) fn solver(which: ContactSolver) -> &'static (dyn ComplementaritySolver + Sync) {
    match which {
        ContactSolver::ActiveSet => &ActiveSet,
        ContactSolver::Lemke => &Lemke,
        #[cfg(feature = "interior_point")]
        ContactSolver::InteriorPoint => &InteriorPoint,
    }
}

pub(super) fn refused(argument: &'static str, reason: impl Into<String>) -> CommandError {
    CommandError::Argument { argument, reason: reason.into() }
}

fn pair_force(arguments: &Static, scene: &Scene) -> Result<f64, CommandError> {
    if !arguments.sun_torque_nm.is_empty() {
        let argument = "--sun-torque-nm";
        return Err(refused(argument, "a gear pair is loaded by --normal-force-n, in N"));
    }
    let Some(force) = arguments.normal_force_n else {
        let name = &scene.title;
        let reason = format!("is absent: `{name}` is a gear pair, loaded by a normal force in N");
        return Err(refused("--normal-force-n", reason));
    };
    if !(force.is_finite() && force > 0.0) {
        let reason = format!("{force}: allowed is a finite force above 0 N; flanks only press");
        return Err(refused("--normal-force-n", reason));
    }
    Ok(force)
}

/// Torques on the sun: those asked for, or the operating point's.
fn set_torques(arguments: &Static, scene: &Scene) -> Result<Vec<f64>, CommandError> {
    if arguments.normal_force_n.is_some() {
        let argument = "--normal-force-n";
        return Err(refused(argument, "a whole set is loaded by --sun-torque-nm"));
    }
    if let Some(bad) = arguments.sun_torque_nm.iter().find(|t| !t.is_finite() || **t == 0.0) {
        let reason = format!("{bad}: allowed are finite torques other than 0 N·m");
        return Err(refused("--sun-torque-nm", reason));
    }
    if !arguments.sun_torque_nm.is_empty() {
        return Ok(arguments.sun_torque_nm.clone());
    }
    Ok(vec![operating_torque(&arguments.scene, scene)?])
}

/// Torque on the sun at the operating point, other than 0.
pub(super) fn operating_torque(path: &Path, scene: &Scene) -> Result<f64, CommandError> {
    let torque = LoadCase::of_scene(scene).ok().map(|case| case.sun_torque_nm);
    torque.filter(|t| *t != 0.0).ok_or_else(|| {
        let reason =
            "`operation.torque_nm` is absent or 0: give it, or the argument --sun-torque-nm";
        unfit(path, reason)
    })
}
