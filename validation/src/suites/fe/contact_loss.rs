//! Statements on planetary gears whose teeth part, of another paper about other gear sets: judged here on OH-58 with
//! three planets in phase, under light torque and little damping.

use experiments::branches::{Branch, BranchPoint, BranchSettings, Branches, branches};
use experiments::sweep::{Coordinate, DampedModel, FeModel, MeshLawModel, Part, SweepModel};
use fe_contact::statics::{Bodies, Imperfections};
use scene::Scene;

use super::sweeps::under;
use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::{Checks, Lab};

const SOURCE: &str = "Ambarisha & Parker (2007), J. Sound Vib. 302, 577-595: statements of the abstract, on other gear sets";

/// Torque on the sun and share of the scene's damping at which the resonance of harmonic 1 jumps.
const JUMP: (f64, f64) = (50.0, 0.2);

/// Speeds about that resonance: the lumped set has it some 400 rpm higher, as its frequencies are higher.
fn jump_rpm(name: &str) -> [f64; 2] {
    if name == "lumped" { [3290.0, 3400.0] } else { [2790.0, 2960.0] }
}

/// The same at which periods double, and the speeds.
const DOUBLING: ((f64, f64), [f64; 2]) = ((100.0, 0.1), [4140.0, 4310.0]);

/// Translation of the sun over its rotation at the base circle below which it is suppressed.
const SUPPRESSED: f64 = 1e-6;

const JUMPS: &str =
    "a resonance at which teeth part has two stable motions at one speed, one of which parts teeth";
const PHASING: &str =
    "planet phasing suppresses the sun's translation in stable motions in which teeth part";
const DOUBLINGS: &str = "periods double near a harmonic's resonance at which teeth part";
const NO_PHASING: &str =
    "planet phasing no longer suppresses the sun's translation where the period has doubled";

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let is_run = lab.runs("contact_loss.jumps.fe_contact")?;
    let found = |name: &str, load, range| -> Result<Option<Branches>, ValidationError> {
        is_run.then(|| followed(lab, name, load, range)).transpose()
    };
    let mut checks = Vec::new();
    for name in ["fe_contact", "lumped"] {
        checks.extend(of_jump(lab, name, found(name, JUMP, jump_rpm(name))?.as_ref())?);
    }
    let (load, range) = DOUBLING;
    checks.extend(of_doubling(lab, found("lumped", load, range)?.as_ref())?);
    // With the damping of the scene teeth stay together, and nothing jumps.
    if let Some(damped) = found("lumped", (JUMP.0, 1.0), jump_rpm("lumped"))? {
        let spoilt = of_jump(lab, "lumped", Some(&damped))?;
        checks.push(lab.reference.control("contact_loss.control.damped", &spoilt)?);
    }
    Ok(checks)
}

/// A published statement: 1 if it holds.
fn stated(
    reference: &Reference,
    id: &str,
    words: &str,
    holds: Option<bool>,
) -> Result<Check, ValidationError> {
    let title = format!("{words} (1: holds)");
    let about = reference.about(id, &title)?.source(SOURCE);
    Ok(about.equal_if_run(1.0, holds.map(|holds| f64::from(u8::from(holds)))))
}

/// The branches of a model over a range of speeds (rpm) at a torque (N m) and a share of the scene's damping.
fn followed(
    lab: &Lab<'_>,
    name: &str,
    (torque, damping): (f64, f64),
    range: [f64; 2],
) -> Result<Branches, ValidationError> {
    let scene: &Scene = &lab.three;
    let bodies = lab.gears.of(scene)?;
    let case = under(scene, torque)?;
    let settings = BranchSettings { start: range[1], ..BranchSettings::over(range) };
    let along =
        |model: &dyn SweepModel| branches(&DampedModel { model, factor: damping }, &settings);
    let bodies: &Bodies = &bodies;
    Ok(match name {
        "lumped" => along(&MeshLawModel::new(scene, bodies, case)?.lumped())?,
        _ => along(&FeModel::new(scene, bodies, Imperfections::default(), case))?,
    })
}

/// Stable motions of a branch in which teeth part.
fn parting(branch: &Branch) -> impl Iterator<Item = &BranchPoint> {
    branch.points.iter().filter(|p| p.is_stable && p.contact_loss > 0.0)
}

fn of_jump(lab: &Lab<'_>, name: &str, found: Option<&Branches>) -> Checks {
    let radius = sun_radius(lab)?;
    let (mut jumps, mut suppressed) = (None, None);
    if let Some(own) = found {
        let points: Vec<&BranchPoint> =
            own.branches.first().into_iter().flat_map(parting).collect();
        let within =
            |[low, high]: &[f64; 2]| points.iter().any(|p| (*low..=*high).contains(&p.parameter));
        jumps = Some(own.coexisting().iter().any(within));
        let is_suppressed = points.iter().all(|p| translation(p, radius) < SUPPRESSED);
        suppressed = Some(is_suppressed && !points.is_empty());
    }
    let of = |statement: &str| format!("contact_loss.{statement}.{name}");
    Ok(vec![
        stated(lab.reference, &of("jumps"), JUMPS, jumps)?,
        stated(lab.reference, &of("phasing"), PHASING, suppressed)?,
    ])
}

fn of_doubling(lab: &Lab<'_>, found: Option<&Branches>) -> Checks {
    let radius = sun_radius(lab)?;
    let doubled = |own: &Branches, is: &dyn Fn(&BranchPoint) -> bool| {
        let mut twice = own.branches.iter().filter(|b| b.repeats_after == 2).flat_map(parting);
        twice.any(is)
    };
    let any = found.map(|own| doubled(own, &|_| true));
    let translates = found.map(|own| doubled(own, &|p| translation(p, radius) > SUPPRESSED));
    Ok(vec![
        stated(lab.reference, "contact_loss.period_doubling.lumped", DOUBLINGS, any)?,
        stated(lab.reference, "contact_loss.no_phasing_in_doubled.lumped", NO_PHASING, translates)?,
    ])
}

fn sun_radius(lab: &Lab<'_>) -> Result<f64, ValidationError> {
    let sun = lab.bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    Ok(sun.base_radius)
}

/// Largest amplitude of the sun's translation over that of its rotation at the base circle, harmonics 1 to 5.
fn translation(point: &BranchPoint, base_radius: f64) -> f64 {
    let largest = |coordinate| {
        (1..=5).map(|l| point.state.amplitude(Part::SUN, coordinate, l)).fold(0.0, f64::max)
    };
    let moved = largest(Coordinate::Radial).max(largest(Coordinate::Tangential));
    moved / (base_radius * largest(Coordinate::Rotation))
}
