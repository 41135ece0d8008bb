//! `static` of a whole set with `fidelity = "auto"`: the settings are chosen for a transmission error.

use std::io::Write;

use experiments::auto::{AutoModel, CycleQuestion, CycleValue, choose_transmission_error};
use scene::{AutoQuantity, LoadCase, Scene};

use super::set::{self, SetOutput};
use crate::arguments::{ContactSolver, Format, Static};
use crate::commands::auto_choice;
use crate::error::{Result, refused, unfit};
use crate::inputs::Working;
use crate::output;

/// What the scene asks `static` to choose settings for, if anything.
pub(super) fn request(scene: &Scene) -> Option<CycleValue> {
    let wanted = scene.dynamics.auto?;
    match wanted.quantity {
        AutoQuantity::TransmissionError => Some(CycleValue::PeakToPeak),
        AutoQuantity::MeanTransmissionError => Some(CycleValue::Mean),
        // Statics have no fidelity: what is chosen for other verbs changes nothing here.
        AutoQuantity::NaturalFrequency { .. } | AutoQuantity::Amplitude { .. } => None,
    }
}

/// The mesh cycle with the cheapest settings within the tolerance. Beside a table (CSV) the choice goes to `err`.
pub(super) fn run(
    arguments: &Static,
    scene: &Scene,
    torques: &[f64],
    value: CycleValue,
    (out, err): (&mut dyn Write, &mut dyn Write),
) -> Result<()> {
    let path = &arguments.scene;
    let [torque] = torques else {
        let reason = "`dynamics.fidelity` = \"auto\" chooses settings for one torque: name one";
        return Err(refused("--sun-torque-nm", reason));
    };
    let is_other_solver = arguments.solver != ContactSolver::ActiveSet;
    auto_choice::refuse_given(&[
        ("--positions", arguments.positions.is_some(), "chooses the number of positions"),
        ("--solver", is_other_solver, "solves by active sets"),
    ])?;
    // The lumped model, which may be enough for a mean, has no tooth pairs to list or draw.
    if value == CycleValue::Mean {
        let reason = "`dynamics.quantity` = \"mean_transmission_error\" may be answered by the lumped model, which has no \
                      positions: leave it out, or name the settings";
        if arguments.format == Format::Csv {
            return Err(refused("--format csv", reason));
        }
        if arguments.figures.is_some() {
            return Err(refused("--figures", reason));
        }
    }
    let working = Working::new("choosing settings");
    let case = LoadCase::standing(*torque);
    let question = CycleQuestion { scene, case: &case, value };
    let tolerance_percent = scene.dynamics.auto.map_or(f64::NAN, |a| a.tolerance_percent);
    let choice = choose_transmission_error(&question, tolerance_percent)
        .map_err(|e| unfit(path, format!("`dynamics.fidelity` = \"auto\": {e}")))?;
    drop(working);
    if arguments.format == Format::Csv {
        auto_choice::write(&choice, err)?;
    }
    if choice.settings.model == AutoModel::Lumped {
        // The lumped model has no positions to show.
        let answer = SetOutput::of_lumped(scene, choice);
        return output::show(arguments.format, &answer, out);
    }
    set::run(arguments, &choice.settings.applied_to(scene), torques, Some(choice), out)
}
