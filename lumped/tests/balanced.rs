//! Steady motions of the lumped set by harmonic balance against marching extrapolated in the step.

use std::f64::consts::TAU;
use std::path::Path;

use dynamics::harmonic_balance::{BalanceError, BalanceOptions, FourierSeries};
use gearset::{Axis, Body, Facing, MeshLaw, MeshLawPlan, MeshStart, PairSprings, Phasing};
use lumped::{BalancedSet, LumpedError, TimeVarying};
use scene::Scene;

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    let mut scene = Scene::from_file(&path).unwrap();
    scene.damping.mass_proportional_per_s = 600.0;
    scene
}

fn law(scene: &Scene, steps: usize) -> MeshLaw {
    let geometry = scene.tooth_geometry().unwrap();
    let starts = MeshStart::of_set(&Phasing::new(&geometry, &scene.planets).unwrap());
    let plan = MeshLawPlan::new(&starts, steps).unwrap();
    let pair = PairSprings { stiffness: 2.2e8, contact_ratio: 1.62, gap_at_tenth: 4e-6 };
    let curve = |phase| pair.curve(phase, 120e-6, 240).unwrap();
    let curves = plan.curves.iter().map(|key| curve(key.phase)).collect();
    plan.law(curves).unwrap()
}

/// Rotation of the sun at 70 steps of a cycle after `cycles` from rest, m.
fn marched(scene: &Scene, torque: f64, frequency: f64, steps: usize, cycles: usize) -> Vec<f64> {
    let law = law(scene, steps);
    let mut set = TimeVarying::new(scene, Facing::CounterClockwise, law, frequency).unwrap();
    set.rest(torque).unwrap();
    (0..cycles * steps).for_each(|_| set.step().unwrap());
    let sun = set.coordinates().of(Body::Sun, Axis::Rotation).unwrap();
    let mut out = Vec::new();
    for step in 0..steps {
        if step % (steps / 70) == 0 {
            out.push(set.motion().x[sun]);
        }
        set.step().unwrap();
    }
    out
}

/// Largest difference over the largest vibration.
fn off(found: &FourierSeries, samples: &[f64]) -> f64 {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let size = samples.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
    let at = |(s, x): (usize, &f64)| (found.value(TAU * s as f64 / n) - x).abs() / size;
    samples.iter().enumerate().map(at).fold(0.0, f64::max)
}

/// 0.1 % of the vibration, with contact kept and lost. Stiffness changes at once where a pair of teeth enters or
///   leaves:
/// what sampling folds back falls with the number of samples.
#[test]
fn steady_motions_are_those_of_marching_extrapolated_in_the_step() {
    for (name, torque, frequency, loses_contact) in [
        ("oh58_4p.toml", 1413.0, 565.714, false),
        ("oh58_3p.toml", 1413.0, 1900.0, false),
        ("oh58_4p.toml", 60.0, 1900.0, true),
    ] {
        let scene = scene(name);
        let [coarse, fine] = [560, 1120].map(|s| marched(&scene, torque, frequency, s, 150));
        let both = coarse.iter().zip(&fine);
        let exact: Vec<f64> = both.map(|(c, f)| (4.0 * f - c) / 3.0).collect();
        let run = |steps: usize, tail: f64| {
            let law = law(&scene, steps);
            let set = BalancedSet::new(&scene, Facing::CounterClockwise, law, torque).unwrap();
            let sun = set.coordinates().of(Body::Sun, Axis::Rotation).unwrap();
            let options = BalanceOptions { tail, ..BalanceOptions::default() };
            let found = set.solve(frequency, None, &options).unwrap();
            let least = found.deflections.iter().map(|d| d.extremes(280)[0]);
            assert_eq!(least.fold(f64::INFINITY, f64::min) < 0.0, loses_contact, "{name}");
            assert!(found.residual < 1e-9);
            let difference = off(&found.coordinates[sun], &exact);
            println!(
                "{name} {torque} N m {frequency} Hz, {steps} samples: {} harmonics, {} iterations, off {difference:e}",
                found.harmonics, found.iterations
            );
            difference
        };
        let (few, many) = (run(280, 1e-2), run(560, 1e-4));
        assert!(many < 1e-3 && many < 0.75 * few, "{name}: {few:e} {many:e}");
    }
}

/// With mesh damping, whose force follows the lag of the law, and at a frequency that the law has too few steps for.
#[test]
fn mesh_damping_takes_part_and_coarse_laws_are_refused() {
    let mut scene = scene("oh58_3p.toml");
    scene.damping.stiffness_proportional_s = 3e-6;
    let (torque, frequency) = (1413.0, 1900.0);
    let [coarse, fine] = [560, 1120].map(|s| marched(&scene, torque, frequency, s, 150));
    let both = coarse.iter().zip(&fine);
    let exact: Vec<f64> = both.map(|(c, f)| (4.0 * f - c) / 3.0).collect();
    let solve = |scene: &Scene, steps: usize| {
        let law = law(scene, steps);
        let set = BalancedSet::new(scene, Facing::CounterClockwise, law, torque).unwrap();
        let sun = set.coordinates().of(Body::Sun, Axis::Rotation).unwrap();
        let options = BalanceOptions { tail: 1e-4, ..BalanceOptions::default() };
        Ok::<_, LumpedError>(set.solve(frequency, None, &options)?.coordinates[sun].clone())
    };
    let with = off(&solve(&scene, 560).unwrap(), &exact);
    scene.damping.stiffness_proportional_s = 0.0;
    let without = off(&solve(&scene, 560).unwrap(), &exact);
    println!("with mesh damping off {with:e}, without {without:e}");
    assert!(with < 1e-3 && without > 1e-2, "{with:e} {without:e}");
    let error = solve(&scene, 70).unwrap_err();
    assert!(matches!(error, LumpedError::Balance(BalanceError::Tail { .. })), "{error}");
}
