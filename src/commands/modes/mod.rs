//! `modes SCENE`.

mod closed_form;
mod result;

pub(crate) use closed_form::{ClosedForm, PARAMETERS};
pub(crate) use result::{KindShares, ModesOutput};

use std::f64::consts::TAU;
use std::io::Write;

use experiments::auto::{AutoModel, FrequencyQuestion, choose_frequency};
use lumped::{AnalyticSet, LumpedError, LumpedModel, NaturalModes, campbell};
use scene::{AutoQuantity, LoadCase, Scene, SceneKind, Verb};

use crate::arguments::{Format, Modes};
use crate::commands::auto_choice;
use crate::error::{Result, refused, unfit};
use crate::inputs::{Working, needs, read_scene};
use crate::output;
use closed_form::StatedErrorEntry;

pub(crate) fn run(arguments: &Modes, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    let scene = read_scene(&arguments.scene, err)?;
    needs::warn(&scene, Some(Verb::Modes), None, err)?;
    let most = scene::SPEEDS_RPM[1];
    // Not `abs() > most`: what is no number is within nothing.
    if let Some(bad) = arguments.carrier_speeds_rpm.iter().find(|s| !(-most..=most).contains(*s)) {
        let reason = format!("{bad:?} is not a finite speed from {:e} to {most:e} rpm", -most);
        return Err(refused("--carrier-speeds-rpm", reason));
    }
    if arguments.details && arguments.format != Format::Text {
        let reason = "JSON holds the sensitivities anyway, and CSV none: leave it out, or take --format text";
        return Err(refused("--details", reason));
    }
    if scene.kind == SceneKind::GearPair && !arguments.carrier_speeds_rpm.is_empty() {
        let reason = "a gear pair has no carrier: leave it out";
        return Err(refused("--carrier-speeds-rpm", reason));
    }
    if arguments.parameters {
        let bare = closed_form::without_numbers(&scene);
        return in_closed_form(arguments, &bare, out);
    }
    if let Some(wanted) = scene.dynamics.auto {
        needs::require(&arguments.scene, &scene, Verb::Modes, |_| false)?;
        // No other quantity is given by this verb, which the line above refuses.
        if let AutoQuantity::NaturalFrequency { mode_type, number } = wanted.quantity {
            let case = LoadCase::of_scene(&scene);
            let case = case.map_err(|e| unfit(&arguments.scene, e))?;
            let question = FrequencyQuestion::new(&scene, &case, mode_type, number);
            return chosen(arguments, &question, wanted.tolerance_percent, out);
        }
    }
    if scene.has_closed_forms() {
        return in_closed_form(arguments, &scene, out);
    }
    let (model, modes) = solve(&scene).map_err(|reason| unfit(&arguments.scene, reason))?;
    for warning in lumped::type_warnings(&model, &modes) {
        writeln!(err, "warning: {warning}")?;
    }
    let mut result = ModesOutput::new(&scene, Some((&model, &modes)), arguments.details);
    if !arguments.carrier_speeds_rpm.is_empty() {
        let speeds: Vec<f64> =
            arguments.carrier_speeds_rpm.iter().map(|rpm| rpm / 60.0 * TAU).collect();
        let found = campbell(&model, &speeds).map_err(|e| unfit(&arguments.scene, e))?;
        result = result.with_campbell(&arguments.carrier_speeds_rpm, &found);
    }
    output::show(arguments.format, &result, out)
}

/// Model and modes of a scene, or why there are none.
pub(crate) fn solve(scene: &Scene) -> Result<(LumpedModel, NaturalModes), String> {
    if let Some(lack) = scene.lacks(Verb::Modes).first().filter(|lack| lack.key == "mesh") {
        return Err(format!("`{}`: {}", lack.key, lack.why));
    }
    if scene.has_closed_forms() {
        return ClosedForm::new(scene).map(|closed| (closed.set.model, closed.modes));
    }
    let model = LumpedModel::from_scene(scene).map_err(|e| e.to_string())?;
    let modes = NaturalModes::of(&model).map_err(|e| e.to_string())?;
    Ok((model, modes))
}

/// The frequency that the scene names, with the cheapest settings within its tolerance; all modes of the lumped model
/// if that is chosen.
fn chosen(
    arguments: &Modes,
    question: &FrequencyQuestion<'_>,
    tolerance_percent: f64,
    out: &mut dyn Write,
) -> Result<()> {
    let (path, scene) = (&arguments.scene, question.scene);
    let is_turning = !arguments.carrier_speeds_rpm.is_empty();
    let why = "chooses settings for a set without gyroscopic terms";
    auto_choice::refuse_given(&[("--carrier-speeds-rpm", is_turning, why)])?;
    let working = Working::new("choosing settings");
    let choice = choose_frequency(question, tolerance_percent)
        .map_err(|e| unfit(path, format!("`dynamics.fidelity` = \"auto\": {e}")))?;
    drop(working);
    let is_lumped = choice.settings.model == AutoModel::Lumped;
    let listed = is_lumped.then(|| of_auto(scene, question.case)).transpose();
    let listed = listed.map_err(|e| unfit(path, e))?;
    let listed = listed.as_ref().map(|(model, modes)| (model, modes));
    let mut result = ModesOutput::new(scene, listed, arguments.details);
    result.auto = Some(choice);
    output::show(arguments.format, &result, out)
}

/// Modes of a set with parameters in closed form, or these parameters.
fn in_closed_form(arguments: &Modes, scene: &Scene, out: &mut dyn Write) -> Result<()> {
    if !arguments.carrier_speeds_rpm.is_empty() {
        let reason = "with parameters in closed form there are no gyroscopic terms: leave it out, or give numbers in [lumped], which \
                      --parameters prints";
        return Err(refused("--carrier-speeds-rpm", reason));
    }
    needs::require(&arguments.scene, scene, Verb::Modes, |_| false)?;
    let closed = ClosedForm::new(scene).map_err(|reason| unfit(&arguments.scene, reason))?;
    let parameters = closed.parameters();
    if arguments.format == Format::Text && arguments.parameters {
        return Ok(parameters.write(&scene.title, out)?);
    }
    let found = (&closed.set.model, &closed.modes);
    let mut result = ModesOutput::new(scene, Some(found), arguments.details);
    for mode in &mut result.modes {
        mode.stated_error =
            closed.errors.get(mode.group).and_then(|errors| StatedErrorEntry::new(errors));
    }
    result.parameters = Some(parameters);
    output::show(arguments.format, &result, out)
}

/// The set whose parameters `auto` takes from the geometry, its modes with the inertia of the bodies behind the teeth.
fn of_auto(scene: &Scene, case: &LoadCase) -> Result<(LumpedModel, NaturalModes), LumpedError> {
    let set = AnalyticSet::new(scene, case, 0.0)?;
    let mut modes = set.modes()?;
    modes.groups.iter_mut().for_each(|group| closed_form::complete(&set, group));
    Ok((set.model, modes))
}
