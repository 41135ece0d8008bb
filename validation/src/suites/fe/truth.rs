//! Fidelities of the ladder over speed against bodies with every degree of freedom, whose steady states are
//! kept.

use fe_contact::statics::{Bodies, Imperfections};
use gearset::Fidelity;

use super::Lab;
use super::sweeps::under;
use crate::Profile;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::own_truth::{FullSweep, FullSweepPoint};
use experiments::sweep::{
    Chain, Coordinate, FeModel, Memory, Part, Plan, Response, SteadySettings, SteadyState, run,
    top_of_three,
};

/// Steps a cycle of the truth, with which harmonics are compared; and those of the cheapest fidelity within the
/// limits of the peak (`kept/ladder.toml`).
const STEPS: u32 = 140;
const FINE: u32 = 280;

/// What is measured of a fidelity, percent.
struct Differences {
    /// Place and height of the rotational peak, full bodies without the error of steps.
    peak: [f64; 2],
    /// Harmonics of motion and of mesh forces at equal steps.
    harmonics: [f64; 2],
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let kept = &lab.reference.full_sweep;
    let source = format!("{}; remade by {}", kept.source, kept.command);
    let speeds = kept.of_steps(STEPS).count();
    let fidelities = [
        ("quasi_static", "quasi-static", Fidelity::QuasiStatic, STEPS),
        ("quasi_static_280", "quasi-static", Fidelity::QuasiStatic, FINE),
        ("modal_2", "two modes a body", Fidelity::Modal(2), STEPS),
        ("modal_10", "ten modes a body", Fidelity::Modal(10), STEPS),
    ];
    let mut checks = Vec::new();
    for (id, name, fidelity, steps) in fidelities {
        let is_run = fidelity == Fidelity::QuasiStatic || lab.profile == Profile::Full;
        let found = if is_run { Some(differences(lab, kept, fidelity, steps)?) } else { None };
        let peak = |word: &str| {
            format!(
                "four planets, {name} at {steps} steps: {word} of the sun's rotational peak (l = 2) against full without the error of steps"
            )
        };
        let harmonics = |of: &str| {
            format!(
                "four planets, {name}: {of}, harmonics 1 to 5 at {speeds} speeds against full, both at {STEPS} steps, largest difference over the largest harmonic"
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
        let judged = if steps == STEPS { &list[..] } else { &list[..2] };
        for (id, title, off) in judged {
            let kind = ReferenceKind::OwnRegression;
            let subject = Subject { id, title, kind, source: &source, unit: "%" };
            let tolerance = lab.reference.tolerance(id, 0.0)?;
            checks.push(match off {
                Some(off) => Check::number(subject, 0.0, *off, tolerance),
                None => Check::not_run(subject, 0.0, tolerance),
            });
        }
    }
    Ok(checks)
}

/// A fidelity against full bodies, both on the same flanks and tables.
fn differences(
    lab: &Lab<'_>,
    kept: &FullSweep,
    fidelity: Fidelity,
    steps: u32,
) -> Result<Differences, ValidationError> {
    let mut scene = lab.four.clone();
    scene.fe_contact.flank_elements = kept.flank_elements;
    scene.dynamics.steps_per_cycle = steps;
    scene.dynamics.fidelity = fidelity;
    let bodies = Bodies::new(&scene)?;
    // Points of a sweep come by speed.
    let mut truth: Vec<&FullSweepPoint> = kept.of_steps(STEPS).collect();
    truth.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
    let speeds_rpm: Vec<f64> = truth.iter().map(|p| p.speed_rpm).collect();
    let steady = SteadySettings { tolerance: 1e-7, between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan { steady, chains: vec![Chain { name: "truth".into(), speeds_rpm }] };
    let model =
        FeModel::new(&scene, &bodies, Imperfections::default(), under(&scene, kept.torque_nm)?);
    let model = model.with_tables(kept.table_size);
    let found = run(&model, &plan, &Memory, &|_| ())?;
    let points = found.states();

    // The peak of the sun's rotation in l = 2.
    let near = |p: &&&SteadyState| kept.is_about_the_peak(p.case.speed_rpm);
    let incomplete = || ValidationError::Incomplete("peak between three speeds");
    let full = kept.rotational_peak().ok_or_else(incomplete)?;
    let rotation = |p: &SteadyState| Response::Rotation(Part::Sun).amplitude(p, 2);
    let own = top_of_three(points.iter().filter(near).map(|p| (p.case.speed_rpm, rotation(p))));
    let own = own.ok_or_else(incomplete)?;
    let percent = |own: f64, full: f64| 100.0 * (own / full - 1.0);

    // Every harmonic at every speed, at equal steps: what the bodies' inertia does.
    let mut harmonics = [0.0f64; 2];
    for (point, full) in points.iter().zip(&truth) {
        let motion = |response: Response| move |l: usize| response.amplitude(point, l);
        let force = |part: Part| move |l: usize| point.amplitude(part, Coordinate::Force, l);
        let off = |own: &dyn Fn(usize) -> f64, full: &[f64; 5]| {
            let largest = full.iter().fold(0.0f64, |a, x| a.max(*x));
            let each = (1..).zip(full).map(|(l, full)| (own(l) - full).abs());
            100.0 * each.fold(0.0f64, f64::max) / largest
        };
        for (response, full) in [
            (Response::Rotation(Part::Sun), &full.sun_rotation_rad),
            (Response::Translation(Part::Sun), &full.sun_translation_m),
            (Response::Rotation(Part::Planet(0)), &full.planet_0_rotation_rad),
            (Response::Translation(Part::Planet(0)), &full.planet_0_translation_m),
        ] {
            harmonics[0] = harmonics[0].max(off(&motion(response), full));
        }
        for (part, full) in [
            (Part::SunMesh(0), &full.sun_mesh_0_force_n),
            (Part::RingMesh(0), &full.ring_mesh_0_force_n),
        ] {
            harmonics[1] = harmonics[1].max(off(&force(part), full));
        }
    }
    let peak = [percent(own.0, full.speed_rpm), percent(own.1, full.height_rad)];
    Ok(Differences { peak, harmonics })
}
