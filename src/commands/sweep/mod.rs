//! `sweep scene`: steady states over speed.

mod auto;
mod folder;
mod remarks;
mod report;
mod result;
mod table;

pub(crate) use result::SweepOutput;

use std::io::Write;
use std::path::Path;

use experiments::sweep::{
    Direction, Kept, Memory, Plan, PlanError, PointStore, SteadyMethod, SteadySettings, Sweep,
    SweepError, SweepModel, even_speeds, run as run_plan,
};
use scene::{LoadCase, Scene, Verb};

use super::turning;
use crate::arguments::{Format, Sweep as SweepArguments};
use crate::error::{Result, refused, unfit};
use crate::folder::{Claim, KeptFiles, Manifest, PLAN, write_results};
use crate::inputs::needs::{self, not_ring_pair};
use crate::inputs::{Run, Working, bodies, loads, progress, read_scene, scene_text};
use crate::output;
use folder::PEAKS;

/// Half-width of the refinement about a peak, as a share of its speed.
const SPAN: f64 = 0.04;

/// Peaks that are refined, where time is estimated.
const USUAL_PEAKS: usize = 8;

/// Peaks at least this many times as high as the curve to either side are refined.
const PROMINENT: f64 = 1.25;

/// Runs the sweep: results to `out`; beside a table on `out`, which has no place for them, speeds that could
/// not be computed go to `err`. Whether every speed could be computed.
pub(super) fn run(
    arguments: &SweepArguments,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<bool> {
    let path = &arguments.scene;
    let scene = read_scene(path, err)?;
    let task = Task::new(arguments, &scene, err)?;
    if let Some(response) = auto::response(&scene) {
        return auto::run(&task, &scene, response, out, err);
    }
    // Bodies and tables take minutes: a folder that cannot be used is refused before.
    let _claim = task.claim()?;
    needs::warn(
        &scene,
        Some(Verb::Sweep(scene.dynamics.fidelity)),
        arguments.figures.as_deref(),
        err,
    )?;
    let working = Working::new("meshing the bodies and laying out tables");
    let bodies = bodies(path, &scene, arguments.large)?;
    let model = turning::model(arguments.model, &scene, &bodies, task.case)?;
    let model = model.as_ref();
    drop(working);
    let mut sweep = task.march(model, &task.plan, PLAN)?;
    if arguments.refine > 0 {
        let steady = task.plan.steady.clone();
        let around = sweep.around_peaks(PROMINENT, SPAN, arguments.refine as usize, steady);
        if !around.chains.is_empty() {
            let more = task.march(model, &around, PEAKS)?;
            sweep.extend(more);
        }
    }
    let result = SweepOutput::new(&scene, task.case.sun_torque_nm, &task.plan.steady, &sweep);
    let saved = match &arguments.out {
        Some(folder) => write_folder(&result, &task.text, folder),
        None => Ok(()),
    };
    #[cfg(feature = "charts")]
    let saved = saved.and(match &arguments.figures {
        Some(folder) => draw(&scene, &bodies, task.case, &sweep, folder),
        None => Ok(()),
    });
    // What was computed is shown also where it cannot be saved.
    let shown = output::show(arguments.format, &result, out);
    let said = match arguments.format {
        Format::Csv => result.write_failed(err),
        _ => Ok(()),
    };
    saved.and(shown).and(said).map(|()| result.failed.is_empty())
}

/// Table and sidecar of a finished sweep.
fn write_folder(result: &SweepOutput, scene_text: &str, folder: &Path) -> Result<()> {
    let mut table = Vec::new();
    output::Report::csv(result, &mut table)?;
    write_results(folder, [("sweep.csv", table)])?;
    #[cfg(feature = "parquet")]
    write_results(folder, [("sweep.parquet", result.parquet()?)])?;
    write_results(folder, [("sweep.json", result.sidecar(scene_text)?)])
}

#[cfg(feature = "charts")]
pub(super) fn draw(
    scene: &Scene,
    bodies: &fe_contact::statics::Bodies,
    case: LoadCase,
    sweep: &Sweep,
    folder: &Path,
) -> Result<()> {
    use crate::figures::{SweepContext, of_sweep, save};
    use scene::Fidelity;
    let mut linear = scene.clone();
    if matches!(scene.dynamics.fidelity, Fidelity::Full | Fidelity::MeshLaw) {
        // These have no linearisation of small order: the figure shows the quasi-static frequencies instead.
        linear.dynamics.fidelity = Fidelity::QuasiStatic;
    }
    let found = experiments::sweep::naturals(&linear, bodies, case)?;
    let natural: Vec<_> = found.iter().map(|n| (n.frequency_hz, n.mode_type)).collect();
    let context = SweepContext { scene, torque_nm: case.sun_torque_nm, natural: &natural };
    Ok(save(&of_sweep(sweep, &context), folder)?)
}

/// A sweep as requested.
struct Task<'a> {
    arguments: &'a SweepArguments,
    /// The scene file.
    text: String,
    /// Torque and driven member; speeds are the plan's.
    case: LoadCase,
    plan: Plan,
    /// Name of the fidelity or model, as the model itself gives it.
    fidelity: String,
}

impl<'a> Task<'a> {
    fn new(arguments: &'a SweepArguments, scene: &Scene, err: &mut dyn Write) -> Result<Self> {
        let path = &arguments.scene;
        not_ring_pair(path, scene)?;
        if scene.geometry.is_none() {
            return Err(unfit(path, "[geometry] is absent: teeth are needed to touch"));
        }
        let torque_nm = loads::sun_torque(arguments.sun_torque_nm, path, scene, err)?;
        let missing =
            || unfit(path, "[operation] is absent: it says which member's speed is swept");
        let case = LoadCase::of_scene(scene).map_err(|_| missing())?.with_sun_torque(torque_nm);
        let verb = Verb::Sweep(turning::fidelity(arguments.model, scene));
        let is_given = |a: &str| a == "--sun-torque-nm" && arguments.sun_torque_nm.is_some();
        needs::require(path, scene, verb, is_given)?;
        let [from, to, step] = arguments.speeds_rpm;
        let refuse = |argument| move |e: PlanError| refused(argument, e);
        let speeds = even_speeds(from, to, step).map_err(refuse("--speeds-rpm"))?;
        let steady = SteadySettings {
            method: arguments.method,
            tolerance: arguments.tolerance,
            most_cycles: arguments.most_cycles as usize,
            harmonics: arguments.harmonics as usize,
            between_cycles: arguments.between_cycles as usize,
            whole_cycles: arguments.whole_cycles,
            keeps_steps: false,
        };
        if steady.whole_cycles && steady.method == SteadyMethod::Marching {
            let reason = "is of --method shooting: marching passes through every step of a mesh cycle anyway: leave it out";
            return Err(refused("--whole-cycles", reason));
        }
        // The number of steps is among the settings that are chosen for an amplitude.
        if auto::response(scene).is_none() {
            let steps = scene.dynamics.steps_per_cycle as usize;
            steady.check(steps).map_err(refuse("--harmonics"))?;
            needs::caution(&steady, steps, err)?;
        }
        let directions: &[Direction] = match arguments.both_ways {
            true => &[Direction::Up, Direction::Down],
            false => &[Direction::Up],
        };
        let plan = Plan::new(&speeds, directions, steady).map_err(refuse("--speeds-rpm"))?;
        let plan = plan.with_random_starts(arguments.random_starts);
        if auto::response(scene).is_none() {
            let dial = ["motions", "--speeds-rpm, --both-ways, --refine"];
            let each = directions.len() * speeds.len() + USUAL_PEAKS * arguments.refine as usize;
            let run = Run::motions(scene, arguments.model, &plan.steady, dial, each);
            let run = run.with_random_starts(arguments.random_starts as usize);
            run.admit(path, arguments.large, err)?;
        }
        let text = scene_text(path)?;
        let fidelity = turning::name(arguments.model, scene);
        Ok(Self { arguments, text, case, plan, fidelity })
    }

    /// What a folder of a plan's points says that they were computed from.
    fn manifest(&self, plan: &Plan) -> Result<Manifest> {
        folder::manifest((&self.text, &self.fidelity, self.case.sun_torque_nm), plan)
    }

    /// The folder of `--out` for this process alone; `None` without that argument.
    fn claim(&self) -> Result<Option<Claim>> {
        let Some(folder) = &self.arguments.out else { return Ok(None) };
        folder::claim(folder, &self.manifest(&self.plan)?, self.arguments.refine).map(Some)
    }

    /// Runs one plan and stores its points if a folder is given.
    fn march(&self, model: &dyn SweepModel, plan: &Plan, manifest: &str) -> Result<Sweep> {
        let template = "{bar:32} {pos}/{len} {msg}, {elapsed}, {eta} to go";
        let bar = progress(template, Some(plan.points() as u64), "speeds");
        let store: Box<dyn PointStore> = match &self.arguments.out {
            Some(folder) => Box::new(KeptFiles::open(folder, manifest, &self.manifest(plan)?)?),
            None => Box::new(Memory),
        };
        let done = |_: &Kept| bar.inc(1);
        let found = run_plan(model, plan, store.as_ref(), &done);
        drop(bar);
        found.map_err(|e| match e {
            SweepError::Fe(e) => unfit(&self.arguments.scene, e),
            other => other.into(),
        })
    }
}
