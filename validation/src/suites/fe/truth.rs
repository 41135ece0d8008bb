//! The fidelities over speed against bodies with every degree of freedom, whose steady states are kept.

use fe_contact::statics::Imperfections;
use gearset::Body;
use scene::Fidelity;

use super::sweeps::under;
use crate::error::ValidationError;
use crate::own_truth::{FullSweep, FullSweepPoint};
use crate::suites::{Checks, Lab};
use crate::worst::worst;
use experiments::sweep::{
    Chain, Coordinate, FeModel, Memory, Part, Plan, Response, SteadySettings, SteadyState, Sweep,
    run, top_of_three,
};

/// Steps per cycle of the kept results, at which harmonics are compared; and those of the cheapest fidelity
/// within the limits of the peak (`kept/ladder.toml`).
const STEPS: u32 = 140;
const FINE: u32 = 280;

/// What is measured of a fidelity, percent.
struct Differences {
    /// Speed and height of the rotational peak, against full bodies without the error of the time step.
    peak: [f64; 2],
    /// Harmonics of motion and of mesh forces at equal steps.
    harmonics: [f64; 2],
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let kept = &lab.reference.full_sweep;
    let fidelities = [
        ("quasi_static", "quasi-static", Fidelity::QuasiStatic, STEPS),
        ("quasi_static_280", "quasi-static", Fidelity::QuasiStatic, FINE),
        ("modal_2", "two modes a body", Fidelity::Modal(2), STEPS),
        ("modal_10", "ten modes a body", Fidelity::Modal(10), STEPS),
    ];
    let mut checks = Vec::new();
    for (id, words, fidelity, steps) in fidelities {
        let mut own = None;
        if lab.runs(&format!("truth.height.{id}"))? {
            own = Some(swept(lab, fidelity, steps)?);
        }
        checks.extend(judged(lab, (id, words, steps), kept, own.as_ref())?);
        if let Some(own) = own.filter(|_| id == "quasi_static") {
            let mut shifted = kept.clone();
            shifted.point.iter_mut().for_each(|p| p.sun_rotation_rad[1] *= 0.9);
            let spoilt = judged(lab, (id, words, steps), &shifted, Some(&own))?;
            checks.push(lab.reference.control("truth.control.record_shifted", &spoilt)?);
        }
    }
    lab.gears.drop_unused();
    Ok(checks)
}

/// One fidelity, if it was run, against what is kept of full bodies.
fn judged(
    lab: &Lab<'_>,
    (id, name, steps): (&str, &str, u32),
    kept: &FullSweep,
    own: Option<&Sweep>,
) -> Checks {
    let source = format!("{}; remade by {}", kept.source, kept.command);
    let found = own.map(|own| differences(kept, own)).transpose()?;
    let peak = |word: &str| {
        format!(
            "four planets, {name} at {steps} steps: {word} of the sun's rotational peak (l = 2) against full without the error of steps"
        )
    };
    let harmonics = |of: &str| {
        format!(
            "four planets, {name}: {of}, harmonics 1 to 5 at five speeds against full, both at {STEPS} steps, largest difference over the largest harmonic"
        )
    };
    let list = [
        (format!("truth.frequency.{id}"), peak("place"), found.as_ref().map(|d| d.peak[0])),
        (format!("truth.height.{id}"), peak("height"), found.as_ref().map(|d| d.peak[1])),
        (
            format!("truth.harmonics.{id}.motion"),
            harmonics("motion of sun and planet"),
            found.as_ref().map(|d| d.harmonics[0]),
        ),
        (
            format!("truth.harmonics.{id}.force"),
            harmonics("mesh forces"),
            found.as_ref().map(|d| d.harmonics[1]),
        ),
    ];
    // Harmonics are compared at equal steps.
    let compared = if steps == STEPS { &list[..] } else { &list[..2] };
    let mut checks = Vec::new();
    for (id, title, off) in compared {
        checks.push(lab.about(id, title)?.source(&source).at_most_if_run(*off));
    }
    Ok(checks)
}

/// A fidelity at the speeds of the kept points, on the same flanks, cells and tables.
fn swept(lab: &Lab<'_>, fidelity: Fidelity, steps: u32) -> Result<Sweep, ValidationError> {
    let kept = &lab.reference.full_sweep;
    let mut scene = lab.four.clone();
    scene.fe_contact.flank_elements = kept.flank_elements;
    scene.fe_contact.cell_layout = kept.cell_layout;
    scene.dynamics.steps_per_cycle = steps;
    scene.dynamics.fidelity = fidelity;
    let bodies = lab.gears.of(&scene)?;
    let truth = by_speed(kept);
    let speeds_rpm: Vec<f64> = truth.iter().map(|p| p.speed_rpm).collect();
    let steady = SteadySettings { tolerance: 1e-7, between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan {
        steady,
        chains: vec![Chain { name: "truth".into(), speeds_rpm, random_start: None }],
    };
    let model =
        FeModel::new(&scene, &bodies, Imperfections::default(), under(&scene, kept.torque_nm)?);
    let model = model.with_tables(kept.table_size);
    Ok(run(&model, &plan, &Memory, &|_| ())?.complete()?)
}

/// Kept points by speed, as a sweep returns its own.
fn by_speed(kept: &FullSweep) -> Vec<&FullSweepPoint> {
    let mut truth: Vec<&FullSweepPoint> = kept.of_steps(STEPS).collect();
    truth.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
    truth
}

/// A fidelity against full bodies.
fn differences(kept: &FullSweep, own: &Sweep) -> Result<Differences, ValidationError> {
    let (points, truth) = (own.states(), by_speed(kept));
    if points.len() != truth.len() {
        return Err(ValidationError::Incomplete("point at every speed that is kept"));
    }
    // The peak of the sun's rotation in l = 2.
    let near = |p: &&&SteadyState| kept.is_about_the_peak(p.case.speed_rpm);
    let incomplete = || ValidationError::Incomplete("peak between three speeds");
    let full = kept.rotational_peak().ok_or_else(incomplete)?;
    let rotation = |p: &SteadyState| Response::Rotation(Part::SUN).amplitude(p, 2);
    let own = top_of_three(points.iter().filter(near).map(|p| (p.case.speed_rpm, rotation(p))));
    let own = own.ok_or_else(incomplete)?;
    let percent = |own: f64, full: f64| 100.0 * (own / full - 1.0);

    // Every harmonic at every speed, at equal steps: the effect of the inertia of elastic displacement.
    let mut harmonics = [Vec::new(), Vec::new()];
    for (point, full) in points.iter().zip(&truth) {
        let motion = |response: Response| move |l: usize| response.amplitude(point, l);
        let force = |part: Part| move |l: usize| point.amplitude(part, Coordinate::Force, l);
        let off = |own: &dyn Fn(usize) -> f64, full: &[f64; 5]| {
            let each = (1..).zip(full).map(|(l, full)| own(l) - full);
            100.0 * worst(each) / worst(full.iter().copied())
        };
        for (response, full) in [
            (Response::Rotation(Part::SUN), &full.sun_rotation_rad),
            (Response::Translation(Part::SUN), &full.sun_translation_m),
            (Response::Rotation(Part::Body(Body::Planet(0))), &full.planet_0_rotation_rad),
            (Response::Translation(Part::Body(Body::Planet(0))), &full.planet_0_translation_m),
        ] {
            harmonics[0].push(off(&motion(response), full));
        }
        for (part, full) in [
            (Part::SunMesh(0), &full.sun_mesh_0_force_n),
            (Part::RingMesh(0), &full.ring_mesh_0_force_n),
        ] {
            harmonics[1].push(off(&force(part), full));
        }
    }
    let peak = [percent(own.0, full.speed_rpm), percent(own.1, full.height_rad)];
    Ok(Differences { peak, harmonics: harmonics.map(worst) })
}
