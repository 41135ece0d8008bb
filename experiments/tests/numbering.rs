//! The same set with its planets counted from another one moves in the same way, whatever its meshes follow.

use crate::shipped;
use gearset::Body;

use std::f64::consts::TAU;

use experiments::sweep::{
    Coordinate, FeModel, MeshLawModel, Part, SteadySettings, SteadyState, SweepModel, SweepPoint,
    steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};

/// Planet positions in assembly steps, of which a turn has Z_s + Z_r = 126. Mesh phases of the unloaded set differ by
/// multiples of 1/14 cycle.
const OPPOSED: [i64; 4] = [0, -31, 63, 32];

/// No two planets carry the same load.
const UNEQUAL: [i64; 4] = [0, 29, 62, 97];

const TURN: i64 = 126;

/// The set with its planets counted from planet `first`, which stands on the x axis.
fn scene(positions: [i64; 4], steps_per_cycle: u32, first: usize) -> Scene {
    let mut scene = shipped::scene("oh58_4p", steps_per_cycle, 1.0);
    scene.fe_contact.flank_elements = 6;
    scene.dynamics.fidelity = Fidelity::QuasiStatic;
    let steps: Vec<i64> =
        (0..4).map(|n| (positions[(first + n) % 4] - positions[first]).rem_euclid(TURN)).collect();
    scene.planets.psi_rad = steps.iter().map(|s| TAU * *s as f64 / TURN as f64).collect();
    scene.planets.steps = Some(steps);
    scene
}

fn point(model: &dyn SweepModel, rpm: f64) -> SteadyState {
    let case = model.case().at_speed(rpm);
    let mut set = model.turning(&case, 0).unwrap();
    set.rest().unwrap();
    let (steps, settings) = (model.steps_per_cycle(), SteadySettings::default());
    let found = steady(set.as_mut(), model.shape(), model.first_planet_rad(), steps, &settings);
    SweepPoint::new(case, &found.unwrap(), &settings, 0).unwrap().state
}

/// Largest difference of amplitudes (harmonics 0 to 5) between the set counted from planet 0 and from planet `first`,
/// over the channel's largest amplitude but the mean.
fn off(one: &SteadyState, other: &SteadyState, first: usize) -> f64 {
    let mut pairs = vec![(Part::SUN, Part::SUN, Coordinate::Rotation)];
    for n in 0..4 {
        let was = (first + n) % 4;
        pairs.push((
            Part::Body(Body::Planet(was)),
            Part::Body(Body::Planet(n)),
            Coordinate::Rotation,
        ));
        pairs.push((
            Part::Body(Body::Planet(was)),
            Part::Body(Body::Planet(n)),
            Coordinate::Tangential,
        ));
        pairs.push((Part::SunMesh(was), Part::SunMesh(n), Coordinate::Force));
        pairs.push((Part::RingMesh(was), Part::RingMesh(n), Coordinate::Force));
    }
    let of = |(was, is, coordinate): (Part, Part, Coordinate)| {
        let both = |h| (one.amplitude(was, coordinate, h), other.amplitude(is, coordinate, h));
        let largest = (1..=5).map(|h| both(h).0).fold(0.0, f64::max);
        assert!(largest > 0.0);
        (0..=5).map(|h| (both(h).0 - both(h).1).abs() / largest).fold(0.0, f64::max)
    };
    pairs.into_iter().map(of).fold(0.0, f64::max)
}

/// Compares the set counted from planet 0 with those counted from others: quasi-static, on the mesh law, and lumped.
fn compare(positions: [i64; 4], steps: u32, others: &[usize], most: f64) {
    let points = |first: usize| -> Vec<(String, SteadyState)> {
        let scene = scene(positions, steps, first);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(1130.0);
        let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
        let contact = FeModel::new(&scene, &bodies, Imperfections::default(), case);
        let lumped = law.lumped();
        let models: [&dyn SweepModel; 3] = [&contact, &law, &lumped];
        models.into_iter().map(|m| (m.name(), point(m, 1400.0))).collect()
    };
    let from_0 = points(0);
    for first in others {
        for ((name, one), (_, other)) in from_0.iter().zip(&points(*first)) {
            let off = off(one, other, *first);
            println!("{positions:?} from planet {first}, {name}: {off:.1e}");
            assert!(off < most, "{positions:?} from planet {first}, {name}: {off:e}");
        }
    }
}

/// 140 steps sample every mesh at the same phases from whichever planet positions are counted: 1e-6 of each channel's
/// largest amplitude.
#[test]
fn the_motion_of_opposed_pairs_does_not_depend_on_which_planet_is_counted_first() {
    compare(OPPOSED, 140, &[1], 1e-6);
}

/// Loaded phases differ from planet to planet, so that time steps lie elsewhere in the mesh cycle if counted from
/// another planet. That makes 1.3e-3 (quasi-static) to 2.3e-3 (lumped) with 140 steps, a sixteenth of which is allowed
/// with 560.
#[test]
#[ignore = "long: .ci/full runs it"]
fn the_motion_of_unequal_planets_does_not_depend_on_which_is_counted_first() {
    compare(UNEQUAL, 560, &[1], 8e-5);
}
