//! `branches SCENE`: periodic motions over speed, stable or not.

use std::io::Write;

use experiments::ExperimentError;
use experiments::branches::{BranchError, BranchSettings, branch};
use experiments::sweep::{FeModel, MeshLawModel, SteadySettings, SweepModel};
use fe_contact::statics::{Bodies, Imperfections};
use gearset::{Fidelity, LoadCase, Scene, Verb};

use crate::arguments::{Branches, Model, Over, TableFormat};
use crate::error::CommandError;
use crate::output;

use super::branches_output::BranchesOutput;
use super::working::Working;
use super::{fe_refused, loads, needs, read_scene, refused, unfit};

/// Follows the branch: results to `out`, warnings to `err`.
pub(super) fn run(
    arguments: &Branches,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<(), CommandError> {
    let path = &arguments.scene;
    let mut scene = read_scene(path)?;
    let settings = settings(arguments)?;
    needs::not_ring_pair(path, &scene)?;
    let case = case(arguments, &scene, err)?;
    let steps = scene.dynamics.steps_per_cycle as usize;
    let harmonics = SteadySettings { harmonics: settings.harmonics, ..SteadySettings::default() };
    harmonics.check(steps).map_err(|e| unfit(path, e.to_string()))?;
    needs::warn(&scene, err)?;
    #[cfg(feature = "charts")]
    needs::figures(&scene, arguments.figures.as_deref(), err)?;
    let damping = &mut scene.damping;
    damping.mass_proportional_per_s *= arguments.damping_factor;
    damping.stiffness_proportional_s *= arguments.damping_factor;
    damping.bearing_s *= arguments.damping_factor;
    let working = Working::new("meshing the bodies and laying out tables");
    let bodies = Bodies::new(&scene).map_err(fe_refused(path))?;
    let model: Box<dyn SweepModel> = match (arguments.model, scene.dynamics.fidelity) {
        (Model::FeContact, Fidelity::MeshLaw) => {
            Box::new(MeshLawModel::new(&scene, &bodies, case)?)
        }
        (Model::FeContact, _) => {
            Box::new(FeModel::new(&scene, &bodies, Imperfections::default(), case))
        }
        (Model::Lumped, _) => Box::new(MeshLawModel::new(&scene, &bodies, case)?.lumped()),
    };
    working.now("following the branch");
    let found = branch(model.as_ref(), &settings).map_err(|e| match e {
        ExperimentError::Fe(e) => unfit(path, e.to_string()),
        ExperimentError::Branch(e @ BranchError::NoDerivative(_)) => unfit(path, e.to_string()),
        ExperimentError::Branch(e @ BranchError::NoStart { .. }) => {
            refused("--start", e.to_string())
        }
        other => other.into(),
    })?;
    drop(working);
    #[cfg(feature = "charts")]
    if let Some(folder) = &arguments.figures {
        use crate::figures::{of_branch, save};
        let title = format!("{}: {} N·m on the sun", scene.title, case.sun_torque_nm);
        save(&of_branch(&found, &title, settings.harmonics), folder)?;
    }
    let (torque, factor) = (case.sun_torque_nm, arguments.damping_factor);
    let result = BranchesOutput::new(&scene, torque, factor, &settings, found);
    match arguments.format {
        TableFormat::Json => output::json(out, &result),
        TableFormat::Csv => result.write_csv(out),
        TableFormat::Text => result.text(out),
    }
}

/// Range and start, checked before anything is computed.
fn settings(arguments: &Branches) -> Result<BranchSettings, CommandError> {
    let Over::Speed = arguments.over;
    let [from, to] = arguments.speeds_rpm;
    let most_points = arguments.max_points as usize;
    let whole = BranchSettings { start_rpm: to, most_points, ..BranchSettings::over([from, to]) };
    whole.check().map_err(|e| refused("--speeds-rpm", e.to_string()))?;
    let own = BranchSettings { start_rpm: arguments.start.unwrap_or(to), ..whole };
    own.check().map_err(|e| refused("--start", e.to_string()))?;
    Ok(own)
}

/// Torque and driven member.
fn case(
    arguments: &Branches,
    scene: &Scene,
    err: &mut dyn Write,
) -> Result<LoadCase, CommandError> {
    let path = &arguments.scene;
    let verb = Verb::Branches(match arguments.model {
        Model::Lumped => Fidelity::QuasiStatic,
        Model::FeContact => scene.dynamics.fidelity,
    });
    let is_given = |a: &str| a == "--sun-torque-nm" && arguments.sun_torque_nm.is_some();
    needs::require(path, scene, verb, is_given)?;
    let torque_nm = loads::sun_torque(arguments.sun_torque_nm, path, scene, err)?;
    let missing = || unfit(path, "[operation] is absent: it says which member's speed is varied");
    Ok(LoadCase::of_scene(scene).map_err(|_| missing())?.with_sun_torque(torque_nm))
}
