//! What shooting says of the cycle that would follow its last one, against marching it.

use dynamics::CarriedChange;
use experiments::sweep::{
    FeModel, MeshLawModel, Record, Steady, SteadyMethod, SteadySettings, SweepModel, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::Along;
use scene::{Fidelity, LoadCase};

use super::sets::{fe, march_cycle, scene};

/// Of translations and of rotations.
#[derive(Default)]
struct Change {
    /// Largest change.
    largest: f64,
    /// Largest peak-to-peak value.
    size: f64,
    /// Largest displacement, by which changes are rounded.
    from_zero: f64,
    /// Sum of squared changes, and of squared deviations from the mean.
    squares: [f64; 2],
}

/// Changes from the start of one record to another, which may be shorter.
fn changes(of: &Record, to: &Record) -> [Change; 2] {
    let mut kinds: [Change; 2] = Default::default();
    for channel in 0..of.displacements() {
        let kind = &mut kinds[usize::from(channel % 3 == 2)];
        let (before, after) = (of.channel(channel), to.channel(channel));
        let own = &before[..after.len()];
        let (low, high) =
            (own.iter().copied().reduce(f64::min), own.iter().copied().reduce(f64::max));
        kind.size = kind.size.max(high.unwrap() - low.unwrap());
        kind.from_zero = kind.from_zero.max(-low.unwrap()).max(high.unwrap());
        let mean = after.iter().sum::<f64>() / after.len() as f64;
        for (a, b) in before.iter().zip(&after) {
            kind.largest = kind.largest.max((a - b).abs());
            kind.squares[0] += (a - b).powi(2);
            kind.squares[1] += (b - mean).powi(2);
        }
    }
    kinds
}

/// A motion found by shooting.
struct Found {
    of: Steady,
    /// Its residual over that of the part of the cycle which follows, marched.
    ratio: f64,
    /// What rounding of displacements may leave of that change.
    rounding: f64,
    /// Its energy between harmonics over that of the last cycle and the next, marched; only where that is a whole
    /// cycle.
    between: f64,
    /// Kinematic rest marched from there on, m.
    rest: Option<f64>,
}

/// A motion found by shooting to a tolerance, over one of some equal `parts` of the cycle.
fn found(model: &dyn SweepModel, parts: usize, tolerance: f64) -> Found {
    let steps = model.steps_per_cycle();
    let settings = SteadySettings { tolerance, between_cycles: 1, ..SteadySettings::default() };
    let mut set = model.turning(&model.case().at_speed(1450.0), 0).unwrap();
    set.rest().unwrap();
    let own = set.derivative().unwrap().symmetry().unwrap();
    assert_eq!(own.map_or(1, |own| own.parts), parts);
    let (shape, first) = (model.shape(), model.first_planet_rad());
    let of = steady(set.as_mut(), shape, first, steps, &settings).unwrap();
    assert_eq!(of.method, SteadyMethod::Shooting, "{:?}", of.why_marched);
    let mut next = Record::new(shape);
    next.march(set.as_mut(), first, steps / parts).unwrap();
    let kinds = changes(&of.record, &next);
    let largest = kinds.iter().fold(0.0f64, |a, kind| a.max(kind.largest / kind.size));
    // Every step rounds displacements.
    let rounding = |kind: &Change| steps as f64 * f64::EPSILON * kind.from_zero / kind.size;
    let rounding = kinds.iter().fold(0.0f64, |a, kind| a.max(rounding(kind)));
    // With a and b the samples of two cycles, (a − b)/2 makes the lines between harmonics, (a + b)/2 all others.
    let share = |kind: &Change| 0.25 * kind.squares[0] / kind.squares[1];
    let between = kinds.iter().fold(0.0f64, |a, kind| a.max(share(kind)));
    // Back to the start of a cycle.
    next.march(set.as_mut(), first, steps - steps / parts).unwrap();
    let marching = SteadySettings { method: SteadyMethod::Marching, ..settings };
    let followed = steady(set.as_mut(), shape, first, steps, &marching).unwrap();
    let (ratio, between) = (of.residual / largest, of.between.unwrap() / between);
    Found { of, ratio, rounding, between, rest: followed.rest.map(|rest| rest.largest) }
}

/// The change of the next cycle, carried by the derivative over the last one, is what marching on finds: it is of first
/// order, so that it is off by a share of the order of itself. Kinematic rest, computed after the last cycle from what
/// was kept of it, is that of the cycles marched.
#[test]
#[ignore = "long: .ci/full runs it"]
fn the_change_of_the_next_cycle_is_that_marched() {
    for (name, parts, torque) in [("oh58_4p", 2, 1130.0), ("oh58_3p", 1, 500.0)] {
        let quasi_static = scene(name, Fidelity::QuasiStatic, 56);
        let bodies = Bodies::new(&quasi_static).unwrap();
        let modal = scene(name, Fidelity::Modal(4), 56);
        let modal_bodies = Bodies::new(&modal).unwrap();
        let case = LoadCase::of_scene(&quasi_static).unwrap().with_sun_torque(torque);
        let law = MeshLawModel::new(&quasi_static, &bodies, case).unwrap();
        let all: [(&dyn SweepModel, usize); 4] = [
            (&fe(&quasi_static, &bodies, torque), parts),
            (&fe(&modal, &modal_bodies, torque), 1),
            (&law, parts),
            (&law.lumped(), parts),
        ];
        for (model, parts) in all {
            let name = format!("{name}, {}", model.name());
            for tolerance in [1e-2, 1e-4, 1e-6] {
                let Found { of, ratio, rounding, between, rest } = found(model, parts, tolerance);
                println!(
                    "{name}: {:e} times 1 + {:e}, rounding {rounding:e}",
                    of.residual,
                    ratio - 1.0
                );
                assert!(of.residual > 0.0 && of.residual <= tolerance);
                let allowed = 10.0 * of.residual + rounding / of.residual;
                assert!((ratio - 1.0).abs() < allowed, "{name}, {tolerance:e}: {ratio}");
                if parts == 1 {
                    assert!((between - 1.0).abs() < 1e-2, "{name}, {tolerance:e}: {between}");
                }
                let rests = of.rest.map(|rest| rest.largest).zip(rest);
                assert_eq!(rests.is_some(), model.name() != "mesh-law" && model.name() != "lumped");
                let off = rests.map_or(0.0, |(a, b)| a / b - 1.0);
                assert!(off.abs() < of.residual.sqrt(), "{name}, {tolerance:e}: {off:e}");
            }
        }
    }
}

/// A change that is carried along leaves the derivative as it is, bit by bit; it begins as it was given, grows in
/// proportion to it, and is refused with another number of coordinates.
#[test]
fn a_change_is_carried_beside_the_derivative() {
    let scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    let fe = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
    for model in [&fe as &dyn SweepModel, &law, &law.lumped()] {
        let mut set = model.turning(&model.case().at_speed(1450.0), 0).unwrap();
        set.rest().unwrap();
        let steps = model.steps_per_cycle();
        march_cycle(set.as_mut(), steps);
        let own = set.derivative().unwrap();
        let alone = own.of_cycle(Along::Motion).unwrap();
        let start: Vec<f64> = (0..own.coordinates().len()).map(|i| (i as f64).sin()).collect();
        let mut carried = |factor: f64| {
            let start: Vec<f64> = start.iter().map(|x| factor * x).collect();
            let mut heard: Vec<Vec<f64>> = Vec::new();
            let hear = &mut |x: &[f64]| heard.push(x.to_vec());
            let own = set.derivative().unwrap();
            let beside = own.of_cycle_with(CarriedChange { start: &start, hear }).unwrap();
            assert_eq!(beside, alone, "{}", model.name());
            assert_eq!(heard.len(), steps, "{}", model.name());
            assert_eq!(heard[0], start[..heard[0].len()], "{}", model.name());
            heard.concat()
        };
        let (once, thrice) = (carried(1.0), carried(-3.0));
        let size = once.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let off = once.iter().zip(&thrice).fold(0.0f64, |a, (x, y)| a.max((3.0 * x + y).abs()));
        assert!(off < 1e-12 * size, "{}: {off:e} of {size:e}", model.name());
        let hear = &mut |_: &[f64]| ();
        let short = CarriedChange { start: &start[1..], hear };
        assert!(set.derivative().unwrap().of_cycle_with(short).is_err(), "{}", model.name());
    }
}
