//! Steady states by shooting against marching, on all fidelities that have a derivative.

use experiments::sweep::{
    Coordinate, FeModel, MeshLawModel, SteadyMethod, SteadySettings, SweepModel, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use gearset::PathDirection;
use scene::{Fidelity, LoadCase};

use super::sets::{backward, fe, scene};

/// Largest difference between the records of shooting and of marching from rest, relative to the peak-to-peak
/// vibration; also the cycles that each took, and the largest multiplier.
fn compare(model: &dyn SweepModel, rpm: f64, most_cycles: usize) -> (f64, [usize; 2], f64) {
    let shooting = SteadySettings { between_cycles: 0, most_cycles, ..SteadySettings::default() };
    let marching =
        SteadySettings { method: SteadyMethod::Marching, tolerance: 1e-11, ..shooting.clone() };
    let find = |settings: &SteadySettings| {
        let mut set = model.turning(&model.case().at_speed(rpm), 0).unwrap();
        set.rest().unwrap();
        let steps = model.steps_per_cycle();
        steady(set.as_mut(), model.shape(), model.first_planet_rad(), steps, settings).unwrap()
    };
    let shot = find(&shooting);
    assert_eq!(shot.method, SteadyMethod::Shooting, "{rpm} rpm: {:?}", shot.why_marched);
    assert!(shot.residual <= shooting.tolerance);
    let marched = find(&marching);
    let largest = shot.multipliers.first().map_or(0.0, |m| m.size());
    (shot.record.change_from(&marched.record), [shot.cycles, marched.cycles], largest)
}

/// 1e-6 of the response, on and off resonance, with corner contact (each mesh passes it twice a cycle).
#[test]
fn shooting_and_marching_agree_on_quasi_static_bodies() {
    for (name, torque) in [("oh58_4p", 1130.0), ("oh58_3p", 500.0)] {
        let scene = scene(name, Fidelity::QuasiStatic, 56);
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, torque);
        for k in 0..8 {
            let rpm = 300.0 + 310.0 * f64::from(k);
            let (off, cycles, largest) = compare(&model, rpm, 2000);
            assert!(off < 1e-6, "{name}, {rpm} rpm: {off:e}, {cycles:?}");
            assert!(largest < 1.0 && 2 * cycles[0] < cycles[1], "{rpm}: {largest} {cycles:?}");
        }
    }
}

/// Modes of the gears stand in frames that turn by a tooth in each cycle.
#[test]
#[ignore = "long: .ci/full runs it"]
fn shooting_and_marching_agree_on_modal_bodies() {
    let scene = scene("oh58_4p", Fidelity::Modal(6), 56);
    for (scene, speeds) in
        [(backward(scene.clone()), vec![1430.0]), (scene, vec![900.0, 1430.0, 2200.0])]
    {
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, 1130.0);
        for rpm in speeds {
            let (off, cycles, largest) = compare(&model, rpm, 2000);
            assert!(off < 1e-6, "{rpm} rpm: {off:e}, {cycles:?}");
            assert!(largest < 1.0);
        }
    }
}

/// Meshes that run backward, symmetric sets (after a half and after a fifth of the cycle) and tabulated forces
/// included.
#[test]
fn shooting_and_marching_agree_where_meshes_run_backward() {
    for (name, torque, steps) in [("oh58_4p", 1130.0, 56), ("five_planets", 500.0, 60)] {
        let scene = backward(scene(name, Fidelity::QuasiStatic, steps));
        let bodies = Bodies::new(&scene).unwrap();
        let contact = fe(&scene, &bodies, torque);
        let law = MeshLawModel::new(&scene, &bodies, contact.case()).unwrap();
        assert_eq!(contact.case().direction(), PathDirection::Backward);
        for model in [&contact as &dyn SweepModel, &law, &law.lumped()] {
            for rpm in [610.0, 1540.0] {
                let mut set = model.turning(&model.case().at_speed(rpm), 0).unwrap();
                let own = set.derivative().unwrap().symmetry().unwrap();
                assert!(own.is_some(), "{name}, {}", model.name());
                let (off, cycles, largest) = compare(model, rpm, 2000);
                assert!(off < 1e-6, "{name}, {} {rpm} rpm: {off:e}, {cycles:?}", model.name());
                assert!(largest < 1.0 && 2 * cycles[0] < cycles[1]);
            }
        }
    }
}

/// Tabulated mesh forces on three sets and a pair of gears, and the lumped models of the sets.
#[test]
fn shooting_and_marching_agree_where_meshes_follow_a_law() {
    for (name, torque, speeds) in [
        ("oh58_4p", 1130.0, [400.0, 800.0, 1200.0, 1600.0, 2000.0, 2400.0].as_slice()),
        ("oh58_3p", 500.0, &[450.0, 1150.0, 1650.0, 2350.0]),
        ("five_planets", 800.0, &[450.0, 1150.0, 1650.0, 2350.0]),
        ("pair_50_50", 150.0, &[900.0, 1400.0, 1900.0, 3300.0]),
    ] {
        let scene = scene(name, Fidelity::MeshLaw, 56);
        let bodies = Bodies::new(&scene).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(torque);
        let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
        let lumped = scene.lumped.is_some().then(|| law.lumped());
        for model in std::iter::once(&law).chain(&lumped) {
            for rpm in speeds {
                let (off, cycles, largest) = compare(model, *rpm, 4000);
                assert!(off < 1e-6, "{name}, {}, {rpm} rpm: {off:e}, {cycles:?}", model.name());
                assert!(largest < 1.0);
            }
        }
    }
}

/// Light load and a fifth of the damping, near resonances of the second and third harmonic: meshes part for 5 to
/// 21 % of the cycle.
#[test]
fn shooting_and_marching_agree_where_teeth_part() {
    let mut scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
    scene.damping.mass_proportional_per_s *= 0.2;
    scene.damping.stiffness_proportional_s *= 0.2;
    scene.damping.bearing_s *= 0.2;
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(40.0);
    // Tables for eight times the usual mesh force: resonance multiplies a light load.
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), case).with_tables(3);
    let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    for rpm in [3050.0, 3300.0, 3350.0] {
        let (off, cycles, largest) = compare(&model, rpm, 4000);
        assert!(off < 1e-6, "{rpm} rpm: {off:e}, {cycles:?}");
        assert!(largest < 1.0 && 10 * cycles[0] < cycles[1], "{rpm}: {cycles:?}");
        let mut set = model.turning(&model.case().at_speed(rpm), 0).unwrap();
        set.rest().unwrap();
        let found = steady(set.as_mut(), 4, 0.0, model.steps_per_cycle(), &settings).unwrap();
        let apart = |mesh: usize| found.record.mesh_force(mesh).iter().any(|f| *f <= 0.0);
        assert!((0..8).any(apart), "{rpm}");
    }
}

/// A kept harmonic of a shot sweep point is that of a marched one.
#[test]
fn harmonics_of_points_agree() {
    use experiments::sweep::{Direction, Memory, Part, Plan, run};
    let scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
    let bodies = Bodies::new(&scene).unwrap();
    let model = fe(&scene, &bodies, 1130.0);
    let of = |method: SteadyMethod| {
        let settings = SteadySettings { method, ..SteadySettings::default() };
        let plan = Plan::new(&[1400.0, 1450.0], &[Direction::Up], settings).unwrap();
        run(&model, &plan, &Memory, &|_| ()).unwrap()
    };
    let (shot, marched) = (of(SteadyMethod::Shooting), of(SteadyMethod::Marching));
    for (a, b) in shot.points().iter().zip(marched.points()) {
        let [of_shot, of_marched] = [a, &b].map(|p| p.largest_multiplier().unwrap());
        assert!(of_shot < 1.0 && (of_shot - of_marched).abs() < 1e-6, "{of_shot} {of_marched}");
        assert!(a.between.unwrap() < 1e-15, "{:?}", a.between);
        for harmonic in 1..=5 {
            let of = |p: &&experiments::sweep::SweepPoint| {
                p.state.amplitude(Part::SUN, Coordinate::Rotation, harmonic)
            };
            assert!((of(a) - of(&b)).abs() < 1e-13, "{harmonic}");
        }
    }
    assert!(shot.coexisting_rpm().is_empty());
}
