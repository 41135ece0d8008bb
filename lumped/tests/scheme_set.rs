//! The lumped set stepped by every scheme: the set of average acceleration step for step, the others by their order
//! against harmonic balance, which has no step.

use std::path::Path;
use std::sync::Arc;

use dynamics::benchmark_subjects::Scheme;
use dynamics::harmonic_balance::BalanceOptions;
use gearset::{Axis, Body, Facing, MeshLaw, MeshLawPlan, MeshStart, PairSprings, Phasing};
use lumped::{BalancedSet, LAW_STEPS_A_STEP, LumpedError, SchemeSet, TimeVarying};
use scene::Scene;

/// OH-58 with four planets, its meshes undamped.
fn scene() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/oh58_4p.toml");
    let mut scene = Scene::from_file(&path).unwrap();
    scene.damping.mass_proportional_per_s = 600.0;
    scene.damping.stiffness_proportional_s = 0.0;
    scene
}

fn law(scene: &Scene, steps: usize) -> Arc<MeshLaw> {
    let geometry = scene.tooth_geometry().unwrap();
    let starts = MeshStart::of_set(&Phasing::new(&geometry, &scene.planets).unwrap());
    let plan = MeshLawPlan::new(&starts, steps).unwrap();
    let pair = PairSprings { stiffness: 2.2e8, contact_ratio: 1.62, gap_at_tenth: 4e-6 };
    let curve = |phase| pair.curve(phase, 120e-6, 240).unwrap();
    let curves = plan.curves.iter().map(|key| curve(key.phase)).collect();
    plan.law(curves).unwrap().into()
}

/// Rotation of the sun (m at the base radius) in every step of a cycle after `cycles` from rest.
fn marched(scene: &Scene, scheme: Scheme, frequency: f64, steps: usize, torque: f64) -> Vec<f64> {
    let law = law(scene, LAW_STEPS_A_STEP * steps);
    let sense = Facing::CounterClockwise;
    let mut set = SchemeSet::new(scene, sense, law, frequency, torque, scheme).unwrap();
    (0..60 * steps).for_each(|_| set.step().unwrap());
    let one = |_| {
        let rotation = set.displacements().0[2][2];
        set.step().unwrap();
        rotation
    };
    (0..steps).map(one).collect()
}

/// Average acceleration is the rule of `TimeVarying`: the same motion from rest, with contact kept and lost.
#[test]
fn average_acceleration_is_that_of_the_program() {
    let scene = scene();
    for (torque, frequency) in [(1413.0, 565.714), (60.0, 1900.0)] {
        let steps = 70;
        let sense = Facing::CounterClockwise;
        let mut own = TimeVarying::new(&scene, sense, law(&scene, steps), frequency).unwrap();
        own.rest(torque).unwrap();
        let fine = law(&scene, LAW_STEPS_A_STEP * steps);
        for scheme in [Scheme::AverageAcceleration, Scheme::ContactStabilised] {
            let mut own = own.clone();
            let law = Arc::clone(&fine);
            let mut set = SchemeSet::new(&scene, sense, law, frequency, torque, scheme).unwrap();
            let (mut off, mut size) = (0.0f64, 0.0f64);
            let start = own.displacements().0[2][2];
            for _ in 0..3 * steps {
                own.step().unwrap();
                set.step().unwrap();
                let (a, b) = (own.displacements().0[2][2], set.displacements().0[2][2]);
                off = off.max((a - b).abs());
                size = size.max((a - start).abs());
            }
            // Forces are iterated to 1e-12 of their size, of which the vibration is a part.
            assert!(
                size > 0.0 && off < 1e-6 * size,
                "{} {torque}: {off:e} {size:e}",
                scheme.label()
            );
        }
    }
}

/// Every scheme converges to the motion of harmonic balance with second order, which leaves 1e-4 in its highest
/// harmonics: half an order at errors of a few times that.
#[test]
fn every_scheme_converges_to_harmonic_balance_with_its_order() {
    let (scene, frequency, torque) = (scene(), 565.714, 1413.0);
    let set = BalancedSet::new(
        &scene,
        Facing::CounterClockwise,
        Arc::unwrap_or_clone(law(&scene, 1120)),
        torque,
    );
    let set = set.unwrap();
    let sun = set.coordinates().of(Body::Sun, Axis::Rotation).unwrap();
    let options = BalanceOptions { tail: 1e-4, ..BalanceOptions::default() };
    let found = set.solve(frequency, None, &options).unwrap();
    let radius = scene.lumped.as_ref().unwrap().radius_m.sun.unwrap();
    let amplitude = |l: usize| found.coordinates[sun].lines[l].norm() / radius;
    let measured = |samples: &[f64], l: usize| {
        let n = samples.len() as f64;
        let at = |k: usize| std::f64::consts::TAU * (l * k) as f64 / n;
        let sum = |of: fn(f64) -> f64| -> f64 {
            samples.iter().enumerate().map(|(k, x)| x * of(at(k))).sum()
        };
        2.0 / n * sum(f64::cos).hypot(sum(f64::sin))
    };
    let schemes = Scheme::ALL.into_iter().filter(|scheme| {
        // The rule of average acceleration where there are no obstacles.
        !matches!(scheme, Scheme::ContactStabilised | Scheme::MoreauJean { .. })
    });
    for scheme in schemes {
        let off = [560, 1120].map(|steps| {
            let samples = marched(&scene, scheme, frequency, steps, torque);
            (measured(&samples, 2) / amplitude(2) - 1.0).abs()
        });
        let order = (off[0] / off[1]).log2();
        println!("{}: {off:?}, order {order:.2}", scheme.label());
        assert!(off[0] < 2e-3 && (order - 2.0).abs() < 0.5, "{}: {off:?} {order}", scheme.label());
    }
}

/// What cannot be stepped is refused in words.
#[test]
fn damped_meshes_and_odd_laws_are_refused() {
    let (mut scene, sense, scheme) = (scene(), Facing::CounterClockwise, Scheme::Bathe);
    let odd = law(&scene, 71);
    let error = SchemeSet::new(&scene, sense, odd, 500.0, 1413.0, scheme).unwrap_err();
    assert!(matches!(error, LumpedError::LawSteps(71)), "{error}");
    // Highest frequency of some 13 kHz, 16 steps in a cycle of 500 Hz.
    let (coarse, scheme) = (law(&scene, 32), Scheme::CentralDifference);
    let error = SchemeSet::new(&scene, sense, coarse, 500.0, 1413.0, scheme).unwrap_err();
    assert!(error.to_string().contains("unstable"), "{error}");
    scene.damping.stiffness_proportional_s = 1e-6;
    let error = SchemeSet::new(&scene, sense, law(&scene, 70), 500.0, 1413.0, scheme).unwrap_err();
    assert!(error.to_string().contains("damping.stiffness_proportional_s"), "{error}");
}
