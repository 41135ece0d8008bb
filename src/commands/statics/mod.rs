//! `static SCENE`: a gear pair or a whole set at rest.

mod approach;
mod auto;
mod pair;
mod pair_load;
mod set;
mod solver;

pub(crate) use approach::ApproachOutput;
pub(crate) use pair::PairOutput;
pub(crate) use set::SetOutput;

use std::io::Write;

use scene::{Scene, SceneKind, Verb};

use crate::arguments::Static;
use crate::error::{Result, refused, unfit};
use crate::inputs::{Run, loads, needs, read_scene};

pub(crate) fn run(arguments: &Static, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    let scene = read_scene(&arguments.scene, err)?;
    if scene.geometry.is_none() {
        let reason = "[geometry] is absent: teeth are needed to touch";
        return Err(unfit(&arguments.scene, reason));
    }
    if let Some(option) = arguments.without_approach() {
        return Err(refused(option, "has no use without --approach-um, which turns a gear pair"));
    }
    let path = &arguments.scene;
    needs::warn(&scene, Some(Verb::Static), arguments.figures.as_deref(), err)?;
    // Where settings are chosen, so is the number of positions; an approach has one.
    if auto::request(&scene).is_none() && arguments.approach_um.is_none() {
        let torques = arguments.sun_torque_nm.len().max(1);
        let slowness = solver::slowness(arguments.solver);
        let run = Run::at_rest(&scene, arguments.position_count(), torques, slowness);
        run.admit(path, arguments.large, err)?;
    }
    match scene.kind {
        SceneKind::GearPair if arguments.approach_um.is_some() => {
            approach::run(arguments, &scene, out, err)
        }
        _ if arguments.approach_um.is_some() => {
            Err(refused("--approach-um", "only a gear pair is turned by an approach"))
        }
        SceneKind::GearPair => {
            let force = pair_force(arguments, &scene, err)?;
            pair::run(arguments, &scene, force, out)
        }
        SceneKind::Planetary => {
            let torques = set_torques(arguments, &scene, err)?;
            let is_given = |argument: &str| {
                argument == "--sun-torque-nm" && !arguments.sun_torque_nm.is_empty()
            };
            needs::require(path, &scene, Verb::Static, is_given)?;
            match auto::request(&scene) {
                Some(value) => auto::run(arguments, &scene, &torques, value, (out, err)),
                None => set::run(arguments, &scene, &torques, None, out),
            }
        }
    }
}

/// Normal force of a gear pair.
fn pair_force(arguments: &Static, scene: &Scene, err: &mut dyn Write) -> Result<f64> {
    if !arguments.sun_torque_nm.is_empty() {
        let argument = "--sun-torque-nm";
        return Err(refused(argument, "a gear pair is loaded by --normal-force-n, in N"));
    }
    loads::normal_force(arguments.normal_force_n, scene, err)
}

/// Torques on the sun: those asked for, or the operating point's.
fn set_torques(arguments: &Static, scene: &Scene, err: &mut dyn Write) -> Result<Vec<f64>> {
    if arguments.normal_force_n.is_some() {
        let argument = "--normal-force-n";
        return Err(refused(argument, "a whole set is loaded by --sun-torque-nm"));
    }
    let path = &arguments.scene;
    if arguments.sun_torque_nm.is_empty() {
        return Ok(vec![loads::sun_torque(None, path, scene, err)?]);
    }
    let each = arguments.sun_torque_nm.iter();
    each.map(|torque| loads::sun_torque(Some(*torque), path, scene, err)).collect()
}
