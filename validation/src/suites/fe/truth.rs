//! The quasi-static rung over speed against bodies with every degree of freedom, whose steady states are
//! kept.

use fe_contact::statics::{Bodies, Imperfections};
use gearset::Rung;

use super::Lab;
use super::sweeps::hz_per_rpm;
use crate::check::{Check, ReferenceKind};
use crate::error::ValidationError;
use crate::own_truth::FullSweepPoint;
use crate::sweep::{
    Chain, Coordinate, FeModel, Memory, Part, Plan, Response, SteadySettings, SweepPoint, run,
    top_of_three,
};

/// Steps a cycle of the rung that is judged.
const STEPS: u32 = 140;

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let kept = &lab.reference.full_sweep;
    let mut scene = lab.four.clone();
    scene.fe_contact.flank_elements = kept.flank_elements;
    scene.dynamics.steps_per_cycle = STEPS;
    scene.dynamics.rung = Rung::QuasiStatic;
    let bodies = Bodies::new(&scene)?;
    // Points of a sweep come by speed.
    let mut truth: Vec<&FullSweepPoint> = kept.of_steps(STEPS).collect();
    truth.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
    let speeds_rpm: Vec<f64> = truth.iter().map(|p| p.speed_rpm).collect();
    let steady = SteadySettings { tolerance: 1e-7, between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan { steady, chains: vec![Chain { name: "truth".into(), speeds_rpm }] };
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), kept.torque_nm);
    let found = run(&model, &plan, hz_per_rpm(&scene)?, &Memory, &|_| ())?;
    let points = found.points();
    let source = format!("{}; remade by {}", kept.source, kept.command);
    let (kind, mut checks) = (ReferenceKind::OwnRegression, Vec::new());

    // The peak of the sun's rotation in l = 2, the truth without the error of steps.
    let near = |p: &&&SweepPoint| kept.of_steps(280).any(|q| q.speed_rpm == p.speed_rpm);
    let incomplete = || ValidationError::Incomplete("peak between three speeds");
    let full = kept.rotational_peak().ok_or_else(incomplete)?;
    let rotation = |p: &SweepPoint| Response::Rotation(Part::Sun).amplitude(p, 2);
    let own = top_of_three(points.iter().filter(near).map(|p| (p.speed_rpm, rotation(p))));
    let own = own.ok_or_else(incomplete)?;
    let percent = |own: f64, full: f64| 100.0 * (own / full - 1.0);
    let titles = [
        ("frequency", "place", percent(own.0, full.speed_rpm)),
        ("height", "height", percent(own.1, full.height_rad)),
    ];
    for (what, word, off) in titles {
        let title = format!(
            "four planets, quasi-static at {STEPS} steps: {word} of the sun's rotational peak (l = 2) against full without the error of steps"
        );
        let id = format!("truth.{what}.quasi_static");
        checks.push(lab.number(&id, &title, kind, &source, "%", 0.0, off)?);
    }

    // Every harmonic at every speed, at equal steps: what the bodies' inertia does.
    let mut worst = [0.0f64; 2];
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
            worst[0] = worst[0].max(off(&motion(response), full));
        }
        for (part, full) in [
            (Part::SunMesh(0), &full.sun_mesh_0_force_n),
            (Part::RingMesh(0), &full.ring_mesh_0_force_n),
        ] {
            worst[1] = worst[1].max(off(&force(part), full));
        }
    }
    for (what, of, worst) in
        [("motion", "motion of sun and planet", worst[0]), ("force", "mesh forces", worst[1])]
    {
        let title = format!(
            "four planets, quasi-static: {of}, harmonics 1 to 5 at {} speeds against full, both at {STEPS} steps, largest difference over the largest harmonic",
            points.len()
        );
        let id = format!("truth.harmonics.quasi_static.{what}");
        checks.push(lab.number(&id, &title, kind, &source, "%", 0.0, worst)?);
    }
    Ok(checks)
}
