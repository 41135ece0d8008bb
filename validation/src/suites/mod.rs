//! The checks, suite by suite. Suites that can be asked of anybody's model take it, its scenes and the
//! reference data; suites about the numerics of our own models take the [`Lab`].

mod claims;
pub(crate) mod explained;
pub(crate) mod fe;
mod lab;
mod lin_parker;
pub(crate) mod lumped_model;
pub(crate) mod mode_lists;
pub(crate) mod pair_stiffness;
pub(crate) mod rules;
pub(crate) mod statements;
mod structure;
mod table1;
pub(crate) mod tables;

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

use experiments::{MeshStiffnessModel, ModalModel, StaticModel, SteadyStateModel, TorquePeakModel};
use scene::Scene;

use crate::Profile;
use crate::catalogue::{PublishedScene, scene};
use crate::check::Check;
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::progress::{Listener, told};
use crate::reference::Reference;
use crate::selection::Selection;
use crate::verdict::NotAsked;

pub(crate) use lab::Lab;

/// Checks of one suite.
pub(crate) type Checks = Result<Vec<Check>, ValidationError>;

/// Natural modes of some scenes held against reference data.
pub(crate) type OfModes = fn(&dyn ModalModel, &[Scene], &Reference) -> Checks;

/// Mesh cycles at rest held against reference data.
pub(crate) type OfMeshCycle = fn(&dyn StaticModel, &[Scene], &Reference) -> Checks;

/// A mesh cycle that is asked for.
pub(crate) struct AskedCycle {
    /// A scene or a variant of it.
    pub(crate) set: Scene,
    /// Torque on the sun, N m.
    pub(crate) sun_torque_nm: f64,
    /// Number of positions.
    pub(crate) positions: usize,
}

/// Mesh cycles that are asked of a scene.
pub(crate) type CyclesOf = fn(&Scene) -> Vec<AskedCycle>;

/// Steady states, with natural modes where the model has them, held against reference data.
pub(crate) type OfSteadyStates =
    fn(&dyn SteadyStateModel, Option<&dyn ModalModel>, &[Scene], &Reference) -> Checks;

/// Mesh stiffness over the mesh cycle held against reference data.
pub(crate) type OfMeshStiffness = fn(&dyn MeshStiffnessModel, &Scene, &Reference) -> Checks;

/// Resonant peaks over torque, or the modes and steady states of which they are peaks, held against reference data;
/// what of a scene is lacking is added to the list.
pub(crate) type OfTorquePeaks =
    fn(&Models<'_>, PublishedScene, &Reference, &mut Vec<NotAsked>) -> Checks;

/// What a suite asks, with the scenes it asks about.
#[derive(Clone, Copy)]
pub(crate) enum Question {
    /// Natural modes.
    Modes(&'static [PublishedScene], OfModes),
    /// Mesh cycles at rest, and which of them.
    MeshCycle(&'static [PublishedScene], OfMeshCycle, CyclesOf),
    /// Steady states.
    SteadyStates(&'static [PublishedScene], OfSteadyStates),
    /// Mesh stiffness at a torque on the sun, N m, and at so many positions.
    MeshStiffness(&'static [PublishedScene; 1], OfMeshStiffness, (f64, usize)),
    /// Resonant peaks over torque, or steady states.
    TorquePeaks(&'static [PublishedScene; 1], OfTorquePeaks),
}

/// A suite that can be asked of anybody's model.
#[derive(Clone, Copy)]
pub(crate) struct Askable {
    /// Name in the registry.
    pub(crate) suite: &'static str,
    /// What is asked.
    pub(crate) question: Question,
    /// What a table needs beside the scenes: torques, positions, variants of the scenes.
    pub(crate) needs: &'static str,
}

use PublishedScene as P;
use Question::{MeshCycle, MeshStiffness, Modes, SteadyStates, TorquePeaks};

const fn ask(suite: &'static str, question: Question, needs: &'static str) -> Askable {
    Askable { suite, question, needs }
}

/// Frequencies with types.
const TYPES: &str = "frequency and type of every mode";

/// Speeds of a sweep that has peaks of four harmonics.
const SPEEDS: &str = "steady states at 1130 N·m, 450 to 2500 rpm, 2 % apart, 10 rpm about peaks; types in modes.csv for the peaks";

/// Stiffness of both meshes.
const STIFFNESS: &str = "sun_mesh_0 and ring_mesh_0 at 1130 N·m, 28 positions";

/// Peaks over torque.
const PEAKS: &str = "resonant peaks of sun and planet_0 at 565, 1130, 1695 and 2260 N·m";

/// Suites that can be asked of anybody's model.
pub(crate) const ASKABLE: [Askable; 22] = [
    ask("table2.lumped", Modes(&[P::Oh58ThreePlanetsAsPublished], tables::lumped), TYPES),
    ask("table3.lumped", Modes(&[P::Oh58FourPlanetsAsPublished], tables::lumped), TYPES),
    ask(
        "table2.geometry_consistent",
        Modes(&[P::Oh58ThreePlanets], tables::geometry_consistent),
        TYPES,
    ),
    ask(
        "table3.geometry_consistent",
        Modes(&[P::Oh58FourPlanets], tables::geometry_consistent),
        TYPES,
    ),
    ask(
        "table3.explained",
        Modes(&[P::Oh58FourPlanets], explained::checks),
        "modes of variants of the scene, which a model in code gives",
    ),
    ask(
        "claims",
        Modes(&[P::Oh58ThreePlanetsAsPublished, P::Oh58FourPlanetsAsPublished], claims::checks),
        TYPES,
    ),
    ask("lin_parker_1999", Modes(&[P::LinParkerThreePlanets], lin_parker::checks), TYPES),
    ask("lin_parker_1999", Modes(&[P::LinParkerFourPlanets], lin_parker::checks), TYPES),
    ask(
        "structure",
        Modes(&[P::LinParkerThreePlanets], structure::checks),
        "modes of random sets, which a model in code gives",
    ),
    ask(
        "fe.stiffness",
        MeshStiffness(&[P::Oh58ThreePlanets], fe::stiffness::asked, fe::stiffness::LOAD),
        STIFFNESS,
    ),
    ask(
        "fe.iso_6336",
        MeshStiffness(&[P::Oh58ThreePlanets], fe::iso6336::asked, fe::stiffness::LOAD),
        STIFFNESS,
    ),
    ask(
        "fe.sets",
        MeshCycle(&[P::Oh58ThreePlanets], fe::sets::asked, fe::sets::cycles),
        "the mesh cycle at 1413 N·m, 28 positions",
    ),
    ask(
        "fe.sets",
        MeshCycle(&[P::Oh58FourPlanets], fe::sets::asked, fe::sets::cycles),
        "mesh cycles of 28 positions at 1413 N·m, of oh58_4p_mirrored at −1413 N·m and of oh58_4p_renumbered at 1413 N·m",
    ),
    ask(
        "fe.fig12",
        MeshCycle(&[P::Oh58FourPlanets], fe::fig12::asked, fe::fig12::cycles),
        "mesh cycles of 140 positions at 113, 226, … 1356 N·m",
    ),
    ask("table2.fe_contact", Modes(&[P::Oh58ThreePlanets], fe::modal::printed), TYPES),
    ask("table3.fe_contact", Modes(&[P::Oh58FourPlanets], fe::modal::printed), TYPES),
    ask("sweep", SteadyStates(&[P::Oh58FourPlanets], fe::sweeps::asked), SPEEDS),
    ask("sweep", SteadyStates(&[P::Oh58ThreePlanets], fe::sweeps::asked), SPEEDS),
    ask(
        "sweep",
        SteadyStates(&[P::FivePlanets], fe::sweeps::asked),
        "steady states at the torque of the scene, 450 to 2500 rpm, 10 rpm apart",
    ),
    ask(
        "torque",
        TorquePeaks(&[P::Oh58FourPlanets], fe::torque_peaks::asked),
        "resonant peaks of sun and planet_0 at 565, 1130, 1695 and 2260 N·m; or modes.csv and steady_states.csv about \
         the first peaks at these torques",
    ),
    ask(
        "torque",
        TorquePeaks(&[P::Oh58FourPlanetsPublishedStiffness], fe::torque_peaks::asked),
        PEAKS,
    ),
    ask("torque", TorquePeaks(&[P::Oh58SecondSystem], fe::torque_peaks::asked), PEAKS),
];

impl Question {
    /// The scenes that it asks about.
    pub(crate) fn scenes(&self) -> &'static [PublishedScene] {
        match self {
            Modes(scenes, _) | MeshCycle(scenes, ..) | SteadyStates(scenes, _) => scenes,
            MeshStiffness(scenes, ..) | TorquePeaks(scenes, _) => *scenes,
        }
    }
}

/// Tables that a suite asks of which one of these checks is.
pub(crate) fn asked_tables(checks: &[Check]) -> Vec<&'static str> {
    let is_asked = |askable: &Askable| {
        let is_of = |check: &Check| {
            check.id.strip_prefix(askable.suite).is_some_and(|rest| rest.starts_with('.'))
        };
        checks.iter().any(is_of)
    };
    let mut tables: Vec<&'static str> =
        ASKABLE.iter().filter(|askable| is_asked(askable)).map(Askable::table).collect();
    for (suite, table) in [
        ("lumped_model.", "modes.csv"),
        ("rules.", "rules.csv"),
        ("pair_stiffness.", "mesh_stiffness.csv"),
    ] {
        if checks.iter().any(|check| check.id.starts_with(suite)) {
            tables.push(table);
        }
    }
    tables
}

impl Askable {
    /// The table whose rows answer.
    fn table(&self) -> &'static str {
        match self.question {
            Modes(..) => "modes.csv",
            MeshCycle(..) => "mesh_cycle.csv",
            SteadyStates(..) => "steady_states.csv",
            MeshStiffness(..) => "mesh_stiffness.csv",
            TorquePeaks(..) => "torque_peaks.csv",
        }
    }

    /// The table that it needs, of which scenes, and what of them.
    fn needs(&self) -> String {
        let table = self.table();
        let ids: Vec<&str> = self.question.scenes().iter().map(|scene| scene.id()).collect();
        format!("{table} of {}: {}", ids.join(" and "), self.needs)
    }
}

/// A suite as it is run on our own models: names of the suites it makes the checks of, and how.
type Own = (&'static [&'static str], fn(&Lab<'_>) -> Checks);

/// All suites in the order of the report.
const OWN: [Own; 34] = [
    (&["table2.lumped", "table3.lumped"], own_lumped_tables),
    (&["table2.geometry_consistent", "table3.geometry_consistent"], own_geometry),
    (&["table3.explained"], |lab| own_modes(lab, "table3.explained", explained::controls)),
    (&["claims"], |lab| own_modes(lab, "claims", claims::controls)),
    (&["lin_parker_1999"], |lab| own_modes(lab, "lin_parker_1999", lin_parker::controls)),
    (&["table1"], table1::checks),
    (&["rules"], rules::checks),
    (&["structure"], own_structure),
    (&["lumped_model"], lumped_model::checks),
    (&["fe.hertz"], fe::hertz::checks),
    (&["fe.convergence"], fe::convergence::checks),
    (&["fe.resolved"], fe::resolved::checks),
    (&["fe.calculix"], fe::calculix::checks),
    (&["fe.bodies"], fe::bodies::checks),
    (&["fe.stiffness"], fe::stiffness::checks),
    (&["fe.iso_6336"], fe::iso6336::checks),
    (&["pair_stiffness"], pair_stiffness::checks),
    (&["fe.sets"], fe::sets::checks),
    (&["fe.kinematics.turned"], fe::kinematics::turned::checks),
    (&["fe.kinematics.work"], fe::kinematics::work::checks),
    (&["fe.kinematics.bearings"], fe::kinematics::bearings::checks),
    (&["fe.kinematics.potential"], fe::kinematics::potential::checks),
    (&["fe.kinematics.exact"], fe::kinematics::exact::checks),
    (&["fe.kinematics.peaks"], fe::kinematics::peaks::checks),
    (&["fe.fig12"], fe::fig12::checks),
    (&["table2.fe_contact", "table3.fe_contact"], fe::modal::tables),
    (&["fe.modal"], fe::modal::checks),
    (&["fe.stepping"], fe::stepping::checks),
    (&["fe.fidelity"], fe::fidelity::checks),
    (&["lumped_from_fe"], fe::lumped_from_fe::checks),
    (&["sweep"], fe::sweeps::checks),
    (&["truth"], fe::truth::checks),
    (&["torque"], fe::torque::checks),
    (&["contact_loss"], fe::contact_loss::checks),
];

/// All scenes and the question of a suite that can be asked of anybody's model.
fn modes_question(suite: &str) -> Result<(Vec<Scene>, OfModes), ValidationError> {
    let (mut all, mut question) = (Vec::new(), None);
    for askable in ASKABLE {
        if let (true, Modes(scenes, run)) = (askable.suite == suite, askable.question) {
            all.extend(scenes_of(scenes)?);
            question = Some(run);
        }
    }
    let missing = ValidationError::Incomplete("suite of that name that asks for natural modes");
    Ok((all, question.ok_or(missing)?))
}

/// Scenes of the catalogue.
pub(crate) fn scenes_of(which: &[PublishedScene]) -> Result<Vec<Scene>, ValidationError> {
    Ok(which.iter().map(|p| scene(*p)).collect::<Result<Vec<Scene>, _>>()?)
}

/// A suite asked of the lumped model, and its controls.
fn own_modes(lab: &Lab<'_>, suite: &str, controls: OfModes) -> Checks {
    let (scenes, run) = modes_question(suite)?;
    let mut checks = run(&lab.lumped, &scenes, lab.reference)?;
    checks.extend(controls(&lab.lumped, &scenes, lab.reference)?);
    Ok(checks)
}

fn own_lumped_tables(lab: &Lab<'_>) -> Checks {
    let mut checks = own_modes(lab, "table2.lumped", tables::lumped_controls)?;
    checks.extend(own_modes(lab, "table3.lumped", tables::lumped_controls)?);
    let (scenes, _) = modes_question("table3.lumped")?;
    checks.extend(tables::sign_control(&scenes, lab.reference)?);
    Ok(checks)
}

fn own_geometry(lab: &Lab<'_>) -> Checks {
    let mut checks = own_modes(lab, "table2.geometry_consistent", tables::geometry_controls)?;
    checks.extend(own_modes(lab, "table3.geometry_consistent", tables::geometry_controls)?);
    Ok(checks)
}

fn own_structure(lab: &Lab<'_>) -> Checks {
    let mut checks = own_modes(lab, "structure", structure::controls)?;
    let (scenes, _) = modes_question("structure")?;
    checks.extend(structure::mirror(&scenes, lab.reference)?);
    Ok(checks)
}

/// Runs every suite of which checks are asked for on our own models, in the order of the report; `progress`
/// is told when each starts and ends.
pub(crate) fn all(
    reference: &Reference,
    profile: Profile,
    only: &Selection,
    progress: Listener<'_>,
) -> Checks {
    let suites: Vec<Own> =
        OWN.into_iter().filter(|(names, _)| names.iter().any(|n| only.concerns(n))).collect();
    if suites.is_empty() {
        return Ok(Vec::new());
    }
    let lab = Lab::new(reference, profile)?;
    let run = |(names, suite): Own| {
        told(names, progress, || {
            let mut found = suite(&lab)?;
            found.retain(|check| only.holds(&check.id));
            Ok(found)
        })
    };
    let found = side_by_side(&suites, run).into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(found.into_iter().flatten().collect())
}

/// What each suite found, in their order, from as many suites at a time as rayon has threads.
///
/// Threads beside rayon's: one of these that waits for a part of its suite would begin another suite meanwhile. Where
/// rayon has one thread, the suites follow one another on the caller's.
fn side_by_side(suites: &[Own], run: impl Fn(Own) -> Checks + Sync) -> Vec<Checks> {
    let count = rayon::current_num_threads().min(suites.len());
    if count == 1 {
        return suites.iter().map(|suite| run(*suite)).collect();
    }
    let next = AtomicUsize::new(0);
    let worker = || {
        let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        let mine = taken.map_while(|k| Some((k, *suites.get(k)?)));
        mine.map(|(k, suite)| (k, run(suite))).collect::<Vec<_>>()
    };
    let mut found: Vec<_> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..count).map(|_| scope.spawn(worker)).collect();
        let joined = workers.into_iter().map(|w| w.join().unwrap_or_else(|e| resume_unwind(e)));
        joined.flatten().collect()
    });
    found.sort_by_key(|(k, _)| *k);
    found.into_iter().map(|(_, checks)| checks).collect()
}

/// Every suite whose question a foreign model answers, and what the others lack.
pub(crate) fn foreign(
    reference: &Reference,
    models: &Models<'_>,
    only: &Selection,
) -> Result<(Vec<Check>, Vec<NotAsked>), ValidationError> {
    let (mut checks, mut not_asked) = (Vec::new(), Vec::new());
    for askable in ASKABLE.into_iter().filter(|askable| only.concerns(askable.suite)) {
        let answer = match (askable.question, models) {
            (Modes(which, run), Models { modal: Some(model), .. }) => {
                Some(run(*model, &scenes_of(which)?, reference))
            }
            (MeshCycle(which, run, _), Models { at_rest: Some(model), .. }) => {
                Some(run(*model, &scenes_of(which)?, reference))
            }
            (SteadyStates(which, run), Models { in_time: Some(model), modal, .. }) => {
                Some(run(*model, *modal, &scenes_of(which)?, reference))
            }
            (MeshStiffness([which], run, _), Models { stiffness: Some(model), .. }) => {
                Some(run(*model, &scene(*which)?, reference))
            }
            (TorquePeaks([which], run), _) => Some(run(models, *which, reference, &mut not_asked)),
            _ => None,
        };
        match answer {
            Some(Ok(found)) if !found.is_empty() => checks.extend(found),
            Some(Err(error)) if !error.is_not_recorded() => return Err(error),
            _ => {
                let suite = askable.suite.to_owned();
                not_asked.push(NotAsked { suite, lacks: askable.needs() });
            }
        }
    }
    checks.retain(|check: &Check| only.holds(&check.id));
    Ok((checks, not_asked))
}

/// Says of suites that need types of modes which row has none; `untyped` are ids of scenes with the line of that row.
pub(crate) fn explain_untyped(not_asked: &mut [NotAsked], untyped: &[(&str, u64)]) {
    for askable in ASKABLE {
        let Modes(scenes, _) = askable.question else { continue };
        let row = untyped.iter().find(|(id, _)| scenes.iter().any(|scene| scene.id() == *id));
        let Some((id, line)) = row else { continue };
        for entry in not_asked.iter_mut().filter(|entry| entry.lacks == askable.needs()) {
            entry.lacks += &format!("; modes.csv:{line} has no `mode_type` of {id}");
        }
    }
}

/// A foreign model, by the questions that it answers.
#[derive(Clone, Copy, Default)]
pub struct Models<'m> {
    /// What kind of model they are; if it is not given, the references of every kind judge it.
    pub kind: Option<ModelKind>,
    /// Natural modes.
    pub modal: Option<&'m dyn ModalModel>,
    /// A mesh cycle at rest.
    pub at_rest: Option<&'m dyn StaticModel>,
    /// Steady states.
    pub in_time: Option<&'m dyn SteadyStateModel>,
    /// Mesh stiffness over a mesh cycle.
    pub stiffness: Option<&'m dyn MeshStiffnessModel>,
    /// Resonant peaks over torque.
    pub peaks: Option<&'m dyn TorquePeakModel>,
}

impl Models<'_> {
    /// Whether no question is answered.
    pub(crate) fn is_empty(&self) -> bool {
        self.modal.is_none()
            && self.at_rest.is_none()
            && self.in_time.is_none()
            && self.stiffness.is_none()
            && self.peaks.is_none()
    }
}
