//! `branches SCENE`: periodic motions over speed, torque, damping or a number of the scene, stable or not.

use std::io::Write;
use std::path::Path;

use experiments::branches::{
    BranchError, BranchParameter, BranchSettings, BranchStore, Search, branches_kept, finished,
};
use experiments::sweep::{
    KeyedModel, LUMPED, Memory, SteadySettings, SweepError, SweepModel, fidelity_name, steps_needed,
};
use fe_contact::statics::Bodies;
use gearset::{Fidelity, LoadCase, MOST_SCENE_BYTES, Scene, Verb};

use crate::arguments::{Branches, DAMPING_FACTORS, Model, TableFormat};
use crate::error::CommandError;
use crate::output;

use super::branches_manifest::{BranchesManifest, RESULTS};
use super::branches_output::{BranchesOutput, Fixed};
use super::kept_files::write_whole;
use super::working::Working;
use super::{fe_refused, loads, needs, read_scene, refused, turning, unfit};

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
    let case = case(arguments, &scene, &settings, err)?;
    let steps = scene.dynamics.steps_per_cycle as usize;
    let harmonics = SteadySettings { harmonics: settings.harmonics, ..SteadySettings::default() };
    harmonics.check(steps).map_err(|e| unfit(path, e.to_string()))?;
    needs::caution(&harmonics, steps, err)?;
    needs::warn(&scene, err)?;
    #[cfg(feature = "charts")]
    needs::figures(&scene, arguments.figures.as_deref(), err)?;
    let fixed = Fixed { case, damping_factor: arguments.damping_factor };
    let search = Search { switch: arguments.switch };
    let fidelity = match arguments.model {
        Model::FeContact => fidelity_name(scene.dynamics.fidelity),
        Model::Lumped => LUMPED.into(),
    };
    // Bodies and tables take minutes: a folder that cannot be used is refused before.
    let failed = |source| CommandError::File { what: "cannot read", path: path.into(), source };
    let text = gearset::read_text(path, MOST_SCENE_BYTES).map_err(failed)?;
    if let BranchParameter::Key(key) = settings.over {
        for (argument, value) in ["--from", "--to"].into_iter().zip(settings.range) {
            KeyedModel::check(&text, key, value).map_err(|e| refused(argument, e.to_string()))?;
        }
    }
    let mut kept = None;
    if let Some(folder) = &arguments.out {
        let (own, text) = (settings.clone(), text.clone());
        let manifest = BranchesManifest::new(text, fidelity, &fixed, own, search);
        kept = Some(manifest.open(folder)?);
    }
    let store: &dyn BranchStore = kept.as_ref().map_or(&Memory, |(_, steps)| steps);
    scene.damping = scene.damping.times(arguments.damping_factor);
    let found = match finished(store)? {
        Some(found) => found,
        None => {
            let working = Working::new("meshing the bodies and laying out tables");
            let bodies = Bodies::new(&scene).map_err(fe_refused(path))?;
            let model: Box<dyn SweepModel + '_> = match settings.over {
                BranchParameter::Key(key) => {
                    let (at, factor) = ((key, settings.start), arguments.damping_factor);
                    let is_lumped = arguments.model == Model::Lumped;
                    let own = KeyedModel::new(&text, at, factor, &bodies, case, is_lumped);
                    Box::new(own.map_err(|e| not_computed(e, path, &settings))?)
                }
                _ => turning::model(arguments.model, &scene, &bodies, case)?,
            };
            let slowest_rpm = match settings.over {
                BranchParameter::Speed => settings.range[0],
                _ => case.speed_rpm,
            };
            // A set that cannot be built is refused by the search below.
            if let Ok(Some(needed)) = steps_needed(model.as_ref(), slowest_rpm) {
                writeln!(
                    err,
                    "warning: at {slowest_rpm} rpm the vibrations of the set need {needed} steps in a mesh cycle, not {steps} (`dynamics.steps_per_cycle`): \
                     with longer steps motions that attract may seem unstable"
                )?;
            }
            working.now("following the branch");
            branches_kept(model.as_ref(), &settings, &search, store).map_err(|e| match e {
                BranchError::NoDerivative(_) => unfit(path, e.to_string()),
                BranchError::NoStart { .. } => refused("--start", e.to_string()),
                BranchError::NoEffect { .. } => refused("--over", e.to_string()),
                BranchError::Sweep(e) => not_computed(e, path, &settings),
                BranchError::Range { .. } | BranchError::Points(_) => e.into(),
            })?
        }
    };
    #[cfg(feature = "charts")]
    let drawn = arguments.figures.as_ref().map(|folder| {
        use crate::figures::{of_branches, save};
        let title = format!("{}: {}", scene.title, fixed.words(settings.over));
        Ok(save(&of_branches(&found, &title, settings.harmonics), folder)?)
    });
    let result = BranchesOutput::new(&scene, &fixed, &settings, found);
    let saved = match &arguments.out {
        Some(folder) => write_folder(&result, folder),
        None => Ok(()),
    };
    #[cfg(feature = "charts")]
    let saved = saved.and(drawn.unwrap_or(Ok(())));
    // What was computed is shown also where it cannot be saved.
    let shown = match arguments.format {
        TableFormat::Json => output::json(out, &result),
        TableFormat::Csv => result.write_csv(out),
        TableFormat::Text => result.text(&fixed, out),
    };
    saved.and(shown)
}

/// The error for a set or a motion that cannot be computed; over a key, its values may be the cause.
fn not_computed(error: SweepError, path: &Path, settings: &BranchSettings) -> CommandError {
    match (error, settings.over) {
        (store @ SweepError::Store(_), _) => store.into(),
        (e, BranchParameter::Key(key)) => {
            let ([from, to], start) = (settings.range, settings.start);
            let remedy = match key.enters_statics() {
                true => {
                    "a softer support gives way further under the load: take stiffer values, or a smaller torque"
                }
                false => "take values nearer to that of the scene",
            };
            let words = format!("from {from:?} to {to:?}, begun at {start:?}: {e}; {remedy}");
            refused("--over", format!("{} {words}", key.path()))
        }
        (SweepError::Fe(e), _) => unfit(path, e.to_string()),
        (other, _) => other.into(),
    }
}

/// Table and everything of finished branches.
fn write_folder(result: &BranchesOutput, folder: &Path) -> Result<(), CommandError> {
    let (mut table, mut all) = (Vec::new(), Vec::new());
    result.write_csv(&mut table)?;
    output::json(&mut all, result)?;
    for (name, bytes) in RESULTS.iter().zip([table, all]) {
        let path = folder.join(name);
        write_whole(&path, &bytes).map_err(|source| CommandError::File {
            what: "cannot write",
            path,
            source,
        })?;
    }
    Ok(())
}

/// The option that gives the range of a parameter.
fn option(over: BranchParameter) -> &'static str {
    match over {
        BranchParameter::Speed => "--speeds-rpm",
        BranchParameter::Torque => "--torques-nm",
        BranchParameter::Damping => "--damping-factors",
        BranchParameter::Key(_) => "--from",
    }
}

/// Range and start, checked before anything is computed; options that belong to another parameter are refused.
fn settings(arguments: &Branches) -> Result<BranchSettings, CommandError> {
    let over = arguments.over;
    let name = over.argument();
    let ranges = [
        (BranchParameter::Speed, arguments.speeds_rpm),
        (BranchParameter::Torque, arguments.torques_nm),
        (BranchParameter::Damping, arguments.damping_factors),
    ];
    let other = ranges.iter().find(|(own, range)| *own != over && range.is_some());
    if let Some((other, _)) = other {
        let reason = format!("the range for --over {}; this is --over {name}", other.argument());
        return Err(refused(option(*other), reason));
    }
    let is_key = matches!(over, BranchParameter::Key(_));
    for (argument, value) in [("--from", arguments.from), ("--to", arguments.to)] {
        if value.is_some() != is_key {
            let reason = match is_key {
                true => format!("missing: --over {name} needs --from and --to"),
                false => format!("a value for --over KEY; this is --over {name}"),
            };
            return Err(refused(argument, reason));
        }
    }
    if over == BranchParameter::Speed && arguments.rpm.is_some() {
        let reason =
            "one speed, for --over torque, damping and KEY; this is --over speed".to_owned();
        return Err(refused("--rpm", reason));
    }
    if over == BranchParameter::Damping && arguments.damping_factor != 1.0 {
        let reason = "one factor; --over damping takes its factors from --damping-factors";
        return Err(refused("--damping-factor", reason.to_owned()));
    }
    let of_key = arguments.from.zip(arguments.to).map(|(from, to)| [from, to]);
    let given = ranges.iter().find(|(own, _)| *own == over).map_or(of_key, |(_, range)| *range);
    let Some([from, to]) = given else {
        let reason = format!("missing: --over {name} needs its range as FROM:TO");
        return Err(refused(option(over), reason));
    };
    let is_factor = |x: &f64| (DAMPING_FACTORS[0]..=DAMPING_FACTORS[1]).contains(x);
    if over == BranchParameter::Damping && ![from, to].iter().all(is_factor) {
        let reason = format!("{from:?} to {to:?}: allowed are factors from 1e-6 to 100");
        return Err(refused(option(over), reason));
    }
    let most_points = arguments.max_points as usize;
    let whole =
        BranchSettings { start: to, most_points, ..BranchSettings::along(over, [from, to]) };
    whole.check().map_err(|e| refused(option(over), e.to_string()))?;
    let own = BranchSettings { start: arguments.start.unwrap_or(to), ..whole };
    own.check().map_err(|e| refused("--start", e.to_string()))?;
    Ok(own)
}

/// Speed, torque and driven member; over torque, the torque under which the model is set up.
fn case(
    arguments: &Branches,
    scene: &Scene,
    settings: &BranchSettings,
    err: &mut dyn Write,
) -> Result<LoadCase, CommandError> {
    let path = &arguments.scene;
    let verb = Verb::Branches(match arguments.model {
        Model::Lumped => Fidelity::QuasiStatic,
        Model::FeContact => scene.dynamics.fidelity,
    });
    let over_torque = settings.over == BranchParameter::Torque;
    let gives_damping = match settings.over {
        BranchParameter::Key(key) => scene.is_damped_by(key.path()),
        _ => false,
    };
    let is_given = |a: &str| match a {
        "--sun-torque-nm" => over_torque || arguments.sun_torque_nm.is_some(),
        "--model lumped" => arguments.model == Model::Lumped,
        _ => gives_damping,
    };
    needs::require(path, scene, verb, is_given)?;
    let [low, high] = settings.range;
    if over_torque {
        loads::torque_range("--torques-nm", [low, high], scene, err)?;
    }
    let torque_nm = match arguments.sun_torque_nm {
        Some(t) if over_torque && !(t.is_finite() && t * low > 0.0) => {
            let reason = format!(
                "{t:?}: allowed is a finite torque of the sign of --torques-nm, under which the model is set up"
            );
            return Err(refused("--sun-torque-nm", reason));
        }
        None if over_torque => loads::sun_torque(Some(0.5 * (low + high)), path, scene, err)?,
        given => loads::sun_torque(given, path, scene, err)?,
    };
    let missing = || unfit(path, "[operation] is absent: it says which member is driven");
    let case = LoadCase::of_scene(scene).map_err(|_| missing())?.with_sun_torque(torque_nm);
    match arguments.rpm {
        Some(rpm) if gearset::is_speed(rpm) => Ok(case.at_speed(rpm)),
        Some(rpm) => {
            Err(refused("--rpm", format!("{rpm:?}: allowed are speeds from 0.001 to 1e7 rpm")))
        }
        None if settings.over != BranchParameter::Speed && case.speed_rpm == 0.0 => {
            Err(refused("--rpm", "missing: the scene's operating speed is 0".to_owned()))
        }
        None => Ok(case.at_speed(case.speed_rpm.abs())),
    }
}
