//! `sweep` with `fidelity = "auto"`: the settings are chosen for the largest amplitude over the speeds.

use std::io::Write;

use experiments::auto::{AmplitudeQuestion, choose_amplitude};
use scene::{AutoQuantity, AutoResponse, Scene, Verb};

use super::Task;
use super::result::SweepOutput;
use crate::arguments::{Format, Model};
use crate::commands::auto_choice;
use crate::error::{CommandError, Result, unfit};
use crate::inputs::{Working, needs};
use crate::output;

/// The response for whose amplitude the scene asks to choose settings, if for any.
pub(super) fn response(scene: &Scene) -> Option<AutoResponse> {
    match scene.dynamics.auto?.quantity {
        AutoQuantity::Amplitude { response } => Some(response),
        _ => None,
    }
}

/// The sweep with the cheapest settings within the tolerance. Beside a table (CSV) the choice goes to `err`.
pub(super) fn run(
    Task { arguments, case, plan, .. }: &Task<'_>,
    scene: &Scene,
    response: AutoResponse,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<bool> {
    let one_motion = "compares settings by one motion at each speed";
    let named_speeds = "gives the largest amplitude over the speeds that are named";
    let no_folder = "has no folder of points, which belong to one named fidelity";
    auto_choice::refuse_given(&[
        ("--model", arguments.model == Model::Lumped, "chooses the model"),
        ("--refine", arguments.refine > 0, named_speeds),
        ("--both-ways", arguments.both_ways, one_motion),
        ("--random-starts", arguments.random_starts > 0, one_motion),
        ("--harmonics", arguments.harmonics > 5, "chooses steps that resolve up to 5 harmonics"),
        ("--out", arguments.out.is_some(), no_folder),
    ])?;
    needs::warn(
        scene,
        Some(Verb::Sweep(scene.dynamics.fidelity)),
        arguments.figures.as_deref(),
        err,
    )?;
    let speeds_rpm = plan.chains.iter().flat_map(|c| c.speeds_rpm.iter().copied()).collect();
    let tolerance_percent = scene.dynamics.auto.map_or(f64::NAN, |a| a.tolerance_percent);
    let steady = plan.steady.clone();
    let question = AmplitudeQuestion::new((scene, case), response, speeds_rpm, steady);
    let working = Working::new("choosing settings");
    let found = choose_amplitude(&question, tolerance_percent)
        .map_err(|e| unfit(&arguments.scene, format!("`dynamics.fidelity` = \"auto\": {e}")))?;
    drop(working);
    let own = found.choice.settings.applied_to(scene);
    let saved: Result<()> = Ok(());
    #[cfg(feature = "charts")]
    let saved = arguments.figures.as_ref().map_or(saved, |folder| {
        let bodies = fe_contact::statics::Bodies::new(&own)
            .map_err(crate::error::fe_refused(&arguments.scene))?;
        super::draw(&own, &bodies, *case, &found.sweep, folder)
    });
    let (torque, sweep) = (case.sun_torque_nm, &found.sweep);
    let result = SweepOutput::new(&own, torque, &plan.steady, sweep);
    // Beside a table, which has no place for them, choice and failed speeds go to `err`.
    let said = match arguments.format {
        Format::Csv => auto_choice::write(&found.choice, err)
            .map_err(CommandError::from)
            .and_then(|()| result.write_failed(err)),
        _ => Ok(()),
    };
    // What was computed is shown also where its figures cannot be saved.
    let result = result.chosen_by(found.choice);
    let shown = output::show(arguments.format, &result, out);
    saved.and(shown).and(said).map(|()| result.failed.is_empty())
}
