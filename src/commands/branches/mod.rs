//! `branches &scene`: periodic motions over speed, torque, damping or a number of the scene, stable or not.

mod result;

pub(crate) use result::BranchesOutput;

use std::io::Write;
use std::path::Path;

use experiments::branches::{
    BranchError, BranchParameter, BranchSettings, BranchStore, Search, branches_kept, finished,
};
use experiments::sweep::{
    KeyedModel, Memory, SteadySettings, SweepError, SweepModel, steps_needed,
};
use scene::{LoadCase, Scene, Verb};
use serde::Serialize;

use super::turning;
use crate::arguments::{Branches, DAMPING_FACTORS, Model};
use crate::error::{CommandError, Result, refused, unfit};
use crate::folder::{Claim, KeptFiles, Manifest, PLAN, RunKind, write_results};
use crate::inputs::{Run, Working, bodies, loads, needs, read_scene, scene_text};
use crate::output::{self, Report};
use result::Fixed;

/// Branches, kept by finished steps.
static BRANCHES: RunKind = RunKind {
    run: "branches",
    format: 1,
    key: "branches",
    settings: &[
        ("/branches/over", "--over"),
        ("/branches/range", "a range"),
        ("/branches/start", "--start"),
        ("/speed_rpm", "--rpm"),
        ("/damping_factor", "--damping-factor"),
        ("/branches/most_points", "--max-points"),
        ("/branches/harmonics", "harmonics up to"),
        ("/branches/longest_step", "steps of at most"),
        ("/search/switch", "--switch"),
    ],
    contents: |_| String::new(),
    results: &["branches.csv", "branches.json"],
    others: &[],
    parts: "steps",
    lock: "branches.lock",
};

/// What the steps in a folder are computed from, beside scene, model and torque.
#[derive(Serialize)]
struct Kept<'s> {
    /// Speed of the input member, rpm; over speed, that of the scene.
    speed_rpm: f64,
    /// Factor on every damping of the scene.
    damping_factor: f64,
    /// Parameter, range, first point and steps.
    branches: &'s BranchSettings,
    /// Which branches are looked for beside the first one.
    search: Search,
}

/// Follows the branch: results to `out`, warnings to `err`.
pub(super) fn run(arguments: &Branches, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    let path = &arguments.scene;
    let mut scene = read_scene(path, err)?;
    let settings = settings(arguments)?;
    needs::not_ring_pair(path, &scene)?;
    let case = case(arguments, &scene, &settings, err)?;
    let steps = scene.dynamics.steps_per_cycle as usize;
    let harmonics = SteadySettings { harmonics: settings.harmonics, ..SteadySettings::default() };
    harmonics.check(steps).map_err(|e| unfit(path, e))?;
    let points = settings.points().min(2 * settings.most_points);
    let run = Run::motions(&scene, arguments.model, &harmonics, ["points", "--max-points"], points)
        .followed();
    let run = match settings.over {
        BranchParameter::Key(key) if key.enters_statics() => run.with_tables_of_each_motion(),
        _ => run,
    };
    run.admit(path, arguments.large, err)?;
    needs::caution(&harmonics, steps, err)?;
    needs::warn(
        &scene,
        Some(Verb::Branches(scene.dynamics.fidelity)),
        arguments.figures.as_deref(),
        err,
    )?;
    let fixed = Fixed { case, damping_factor: arguments.damping_factor };
    let search = Search { switch: arguments.switch };
    let fidelity = turning::name(arguments.model, &scene);
    // Bodies and tables take minutes: a folder that cannot be used is refused before.
    let text = scene_text(path)?;
    if let BranchParameter::Key(key) = settings.over {
        for (argument, value) in ["--from", "--to"].into_iter().zip(settings.range) {
            KeyedModel::check(&text, key, value).map_err(|e| refused(argument, e))?;
        }
    }
    let mut kept = None;
    if let Some(folder) = &arguments.out {
        let (speed_rpm, damping_factor) = (case.speed_rpm, fixed.damping_factor);
        let parts = Kept { speed_rpm, damping_factor, branches: &settings, search };
        let subject = (text.as_str(), fidelity.as_str(), case.sun_torque_nm);
        let manifest = Manifest::new(&BRANCHES, subject, &parts)?;
        // The claim is held as long as the store is used.
        let claim = Claim::of(folder, &manifest, |_| Ok(()))?;
        kept = Some((claim, KeptFiles::open(folder, PLAN, &manifest)?));
    }
    let store: &dyn BranchStore = kept.as_ref().map_or(&Memory, |(_, steps)| steps);
    scene.damping = scene.damping.times(arguments.damping_factor);
    let found = match finished(store)? {
        Some(found) => found,
        None => {
            let working = Working::new("meshing the bodies and laying out tables");
            let bodies = bodies(path, &scene, arguments.large)?;
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
                BranchError::NoDerivative(_) => unfit(path, e),
                BranchError::NoStart { .. } => refused("--start", e),
                BranchError::NoEffect { .. } => refused("--over", e),
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
    let shown = output::show(arguments.format, &result, out);
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
        (SweepError::Fe(e), _) => unfit(path, e),
        (other, _) => other.into(),
    }
}

/// Table and everything of finished branches.
fn write_folder(result: &BranchesOutput, folder: &Path) -> Result<()> {
    let (mut table, mut all) = (Vec::new(), Vec::new());
    result.csv(&mut table)?;
    output::json(&mut all, result)?;
    write_results(folder, BRANCHES.results.iter().copied().zip([table, all]))
}

/// Range and start, checked before anything is computed; options that belong to another parameter are refused.
fn settings(arguments: &Branches) -> Result<BranchSettings> {
    let over = arguments.over;
    let name = over.argument();
    let ranges = [
        (BranchParameter::Speed, "--speeds-rpm", arguments.speeds_rpm),
        (BranchParameter::Torque, "--torques-nm", arguments.torques_nm),
        (BranchParameter::Damping, "--damping-factors", arguments.damping_factors),
    ];
    let other = ranges.iter().find(|(own, _, range)| *own != over && range.is_some());
    if let Some((other, option, _)) = other {
        let reason = format!("the range for --over {}; this is --over {name}", other.argument());
        return Err(refused(option, reason));
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
        let reason = "one speed, for --over torque, damping and KEY; this is --over speed";
        return Err(refused("--rpm", reason));
    }
    if over == BranchParameter::Damping && arguments.damping_factor != 1.0 {
        let reason = "one factor; --over damping takes its factors from --damping-factors";
        return Err(refused("--damping-factor", reason));
    }
    let of_key = arguments.from.zip(arguments.to).map(|(from, to)| [from, to]);
    let of_option = ranges.into_iter().find(|(own, ..)| *own == over);
    let (option, given) =
        of_option.map_or(("--from", of_key), |(_, option, range)| (option, range));
    let Some([from, to]) = given else {
        let reason = format!("missing: --over {name} needs its range as FROM:TO");
        return Err(refused(option, reason));
    };
    if over == BranchParameter::Damping && ![from, to].iter().all(|x| DAMPING_FACTORS.contains(x)) {
        let reason = format!("{from:?} to {to:?}: allowed are factors from 1e-6 to 100");
        return Err(refused(option, reason));
    }
    let most_points = arguments.max_points as usize;
    let whole =
        BranchSettings { start: to, most_points, ..BranchSettings::along(over, [from, to]) };
    whole.check().map_err(|e| refused(option, e))?;
    let own = BranchSettings { start: arguments.start.unwrap_or(to), ..whole };
    own.check().map_err(|e| refused("--start", e))?;
    Ok(own)
}

/// Speed, torque and driven member; over torque, the torque under which the model is set up.
fn case(
    arguments: &Branches,
    scene: &Scene,
    settings: &BranchSettings,
    err: &mut dyn Write,
) -> Result<LoadCase> {
    let path = &arguments.scene;
    let verb = Verb::Branches(turning::fidelity(arguments.model, scene));
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
        Some(rpm) if scene::is_speed(rpm) => Ok(case.at_speed(rpm)),
        Some(rpm) => {
            Err(refused("--rpm", format!("{rpm:?}: allowed are speeds from 0.001 to 1e7 rpm")))
        }
        None if settings.over != BranchParameter::Speed && case.speed_rpm == 0.0 => {
            Err(refused("--rpm", "missing: the scene's operating speed is 0"))
        }
        None => Ok(case.at_speed(case.speed_rpm.abs())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(branches: &BranchSettings) -> Kept<'_> {
        let search = Search { switch: false };
        Kept { speed_rpm: 150.0, damping_factor: 1.0, branches, search }
    }

    #[test]
    fn what_differs_is_named() {
        let settings = BranchSettings::over([100.0, 200.0]);
        let scene = "a = 1\nb = 2\n";
        let made = |parts: &Kept<'_>, model: &str, torque| {
            Manifest::new(&BRANCHES, (scene, model, torque), parts).unwrap()
        };
        let usual = parts(&settings);
        let wanted = made(&usual, "lumped", 50.0);
        let difference = |found: &Manifest| wanted.difference(&found.text).unwrap_or_default();
        assert_eq!(difference(&made(&usual, "lumped", 50.0)), "");
        let over = BranchParameter::Torque;
        for (branches, words) in [
            (BranchSettings { over, ..settings.clone() }, "--over torque, not speed"),
            (BranchSettings { start: 120.0, ..settings.clone() }, "--start 120, not 150"),
            (
                BranchSettings { range: [100.0, 250.0], ..settings.clone() },
                "a range 100:250, not 100:200",
            ),
            (BranchSettings { most_points: 7, ..settings.clone() }, "--max-points 7, not 500"),
        ] {
            let reason = difference(&made(&parts(&branches), "lumped", 50.0));
            assert!(reason.contains(words), "{words}: {reason}");
        }
        for (kept, words) in [
            (Kept { speed_rpm: 5.0, ..parts(&settings) }, "--rpm 5, not 150"),
            (Kept { damping_factor: 2.0, ..parts(&settings) }, "--damping-factor 2, not 1"),
            (Kept { search: Search { switch: true }, ..parts(&settings) }, "--switch yes, not no"),
        ] {
            let reason = difference(&made(&kept, "lumped", 50.0));
            assert!(reason.contains(words), "{words}: {reason}");
        }
        assert!(difference(&made(&usual, "mesh-law", 50.0)).contains("mesh-law, not lumped"));
        assert!(difference(&made(&usual, "lumped", 5.0)).contains("--sun-torque-nm 5, not 50"));
        let sweep = wanted.difference("{\"format\": 4, \"plan\": {}}").unwrap();
        assert!(sweep.contains("not of branches"), "{sweep}");
    }
}
